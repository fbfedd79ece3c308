#include <akmon/contact/bonds/bond_law.h>
#include <akmon/contact/bonds/bond_points.h>

#include <gtest/gtest.h>

#include <cmath>
#include <map>

// The strength of a bond, and the points that stand for a bonded area.

namespace bond_test
{
  using namespace akmon;
  using dealii::Tensor;

  const Tensor<1, 3> normal({0., 0., 1.});


  TEST(BondLaw, normal_and_shear_stress_interact)
  {
    const BondLaw law{40., 30., 1.};
    EXPECT_DOUBLE_EQ(law.utilization(Tensor<1, 3>({0., 0., 40.}), normal), 1.);
    EXPECT_DOUBLE_EQ(law.utilization(Tensor<1, 3>({0., -30., 0.}), normal), 1.);
    EXPECT_DOUBLE_EQ(law.utilization(Tensor<1, 3>({18., 0., 32.}), normal), 1.); // .6^2 + .8^2
    EXPECT_DOUBLE_EQ(law.utilization(Tensor<1, 3>({0., 0., -1e9}), normal), 0.);
    EXPECT_FALSE(BondLaw().breaks());
    EXPECT_EQ(BondLaw().utilization(Tensor<1, 3>({1e9, 0., 1e9}), normal), 0.);
  }


  TEST(BondLaw, limit_lies_on_the_remaining_strength)
  {
    const BondLaw law{40., 30., 1.};
    const Tensor<1, 3> torn({50., 10., 70.}), pressed({50., 10., -70.});
    for (const double r : {1., 0.3})
      {
        EXPECT_NEAR(law.utilization(law.limit(torn, normal, r), normal), r, 1e-14);
        EXPECT_NEAR(law.utilization(law.limit(pressed, normal, r), normal), r, 1e-14);
        EXPECT_EQ(law.limit(pressed, normal, r)[2], -70.);
      }
  }


  // Opened in one direction the traction falls linearly to nothing at 2 G/N: w = N d (1 - d N/(4
  // G)).
  TEST(BondLaw, softens_linearly)
  {
    const BondLaw law{40., 30., 3.};
    const double end = 2. * law.fracture_energy / law.normal_strength;
    for (const double part : {0., 0.25, 0.5, 0.9})
      {
        const double d = part * end,
                     w = law.normal_strength * d *
                         (1. - d * law.normal_strength / (4. * law.fracture_energy));
        EXPECT_NEAR(law.remaining(w), 1. - part, 1e-14);
      }
    EXPECT_EQ(law.remaining(3.1), 0.);
  }


  // A plane surface of n x m faces with corners at these places; looks up or down.
  std::vector<TiedFace>
  surface(const double x0,
          const double x1,
          const double y0,
          const double y1,
          const unsigned int n,
          const unsigned int m,
          const bool up,
          const unsigned int first_node)
  {
    std::vector<TiedFace> faces;
    for (unsigned int j = 0; j < m; ++j)
      for (unsigned int i = 0; i < n; ++i)
        {
          TiedFace face;
          for (unsigned int k = 0; k < 4; ++k)
            {
              const unsigned int corner = up ? k : 3 - k;
              const unsigned int a = i + (corner == 1 || corner == 2), b = j + (corner >= 2);
              face.nodes[k]   = first_node + b * (n + 1) + a;
              face.corners[k] = Tensor<1, 3>(
                {x0 + (x1 - x0) * a / n, y0 + (y1 - y0) * b / m, 0.1 * (x0 + (x1 - x0) * a / n)});
            }
          faces.push_back(face);
        }
    return faces;
  }


  // Surfaces that overlap in part, on a slope.
  TEST(BondPoints, have_the_area_and_hold_linear_fields)
  {
    const auto slaves  = surface(0., 3., 0., 2., 5, 3, false, 0);
    const auto masters = surface(1.3, 4., 0.2, 2.5, 4, 7, true, 100);
    const auto points  = bond_points(slaves, masters, 0.05);
    double area        = 0.;
    std::map<dealii::types::global_dof_index, Tensor<1, 3>> places;
    for (const auto &faces : {slaves, masters})
      for (const auto &face : faces)
        for (unsigned int k = 0; k < 4; ++k)
          places[face.nodes[k]] = face.corners[k];
    for (const auto &point : points)
      {
        area += point.area;
        double sum = 0.;
        Tensor<1, 3> moment;
        for (const auto &[node, weight] : point.row)
          {
            sum += weight;
            moment += weight * places.at(node);
          }
        EXPECT_NEAR(sum, 0., 1e-14);
        EXPECT_NEAR(moment.norm(), 0., 1e-13);
      }
    EXPECT_NEAR(area, 1.7 * 1.8 * std::sqrt(1.01), 1e-13);
  }


  // Constant tractions arrive at the master as its shape functions integrate them.
  TEST(BondPoints, transfer_constant_tractions_exactly)
  {
    const auto slaves  = surface(0., 1., 0., 1., 3, 4, false, 0);
    const auto masters = surface(0., 1., 0., 1., 5, 2, true, 100);
    std::map<dealii::types::global_dof_index, double> force;
    for (const auto &point : bond_points(slaves, masters, 0.05))
      for (const auto &[node, weight] : point.row)
        force[node] += point.area * weight;
    std::map<dealii::types::global_dof_index, double> expected;
    for (const double sign : {1., -1.})
      for (const auto &face : sign > 0. ? slaves : masters)
        for (const auto node : face.nodes)
          expected[node] += sign * 0.25 * area_vector(face.corners).norm();
    ASSERT_EQ(force.size(), expected.size());
    for (const auto &[node, value] : expected)
      EXPECT_NEAR(force[node], value, 1e-14) << node;
  }


  TEST(BondPoints, stop_at_the_bond_distance)
  {
    const auto slaves = surface(0., 1., 0., 1., 2, 2, false, 0);
    auto masters      = surface(0., 1., 0., 1., 3, 3, true, 100);
    for (auto &face : masters)
      for (auto &corner : face.corners)
        corner[2] -= 0.03;
    EXPECT_TRUE(bond_points(slaves, masters, 0.05).empty());
    EXPECT_EQ(bond_points(slaves, masters, 0.07).size(), 9u);
  }
} // namespace bond_test
