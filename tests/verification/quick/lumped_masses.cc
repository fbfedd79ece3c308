#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <string>

#include "support/cell_body.h"
#include "support/run_case.h"

// Lumped masses of bricks, distorted cells and cylinders: integrals of the shape functions, and all
// of the mass.

namespace lumped_masses
{
  using namespace akmon;
  using namespace akmon::test;

  // Volume by the divergence theorem: under a bilinear face it is the mean of both splits into
  // triangles.
  double
  volume_within(const Discretization &discretization)
  {
    const auto under = [](const Vector &a, const Vector &b, const Vector &c) {
      return a * cross_product_3d(b, c) / 6.;
    };
    double sum = 0.;
    for (const auto &face : discretization.faces_on(discretization.boundary_ids("", "", "cell")))
      {
        std::array<Vector, 4> p;
        for (unsigned int k = 0; k < 4; ++k)
          p[k] = at_node(discretization.reference, face.nodes[k]);
        sum += 0.5 * (under(p[0], p[1], p[2]) + under(p[0], p[2], p[3]) + under(p[0], p[1], p[3]) +
                      under(p[1], p[2], p[3]));
      }
    return sum;
  }


  double
  total_mass(const Discretization &discretization)
  {
    double sum = 0.;
    for (const double m : discretization.mass)
      {
        EXPECT_GT(m, 0.);
        sum += m;
      }
    return sum;
  }


  TEST(LumpedMass, OfABrickIsAnEighthEach)
  {
    const Discretization brick({body_of(box(Vector({1., .8, .6})), CellIntegration::full)},
                               {elastic(7800.)},
                               MPI_COMM_SELF);
    ASSERT_EQ(brick.mass.size(), 8u);
    for (const double m : brick.mass)
      EXPECT_NEAR(m, 7800. * .48 / 8., 1e-12 * 468.);
  }


  TEST(LumpedMass, OfADistortedCellIsTheIntegralOfTheShapeFunctions)
  {
    const ScratchDirectory scratch;
    const std::string file             = scratch.path + "/cell.vtk";
    const std::array<Vector, 8> corner = {{Vector({0., 0., 0.}),
                                           Vector({1.2, .1, -.1}),
                                           Vector({1., 1.3, .2}),
                                           Vector({-.1, .9, 0.}),
                                           Vector({.1, -.2, 1.}),
                                           Vector({.9, .1, 1.2}),
                                           Vector({1.1, .8, .9}),
                                           Vector({.2, 1.1, 1.3})}};
    std::ofstream out(file);
    out << "# vtk DataFile Version 3.0\ncell\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 double\n";
    for (const auto &p : corner)
      out << p << "\n";
    out << "\nCELLS 1 9\n8 0 1 2 3 4 5 6 7\n\nCELL_TYPES 1\n12\n";
    out.close();
    FileShape shape;
    shape.name  = file;
    shape.scale = 1.;
    const Discretization cell({body_of(shape, CellIntegration::full)},
                              {elastic(3.)},
                              MPI_COMM_SELF);

    EXPECT_NEAR(total_mass(cell), 3. * volume_within(cell), 1e-13);
    // m_a = rho int N_a J over [0,1]^3, cubic in each coordinate: Simpson's rule is exact.
    std::array<Vector, 8> p;
    for (unsigned int v = 0; v < 8; ++v)
      p[v] = at_node(cell.reference, cell.cells[0].nodes[v]);
    std::array<double, 8> expected{};
    const std::array<double, 3> at = {{0., .5, 1.}}, weight = {{1. / 6., 4. / 6., 1. / 6.}};
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        for (unsigned int k = 0; k < 3; ++k)
          {
            const double xi[3] = {at[i], at[j], at[k]};
            dealii::Tensor<2, 3> J;
            std::array<double, 8> N;
            for (unsigned int v = 0; v < 8; ++v)
              {
                double f[3], s[3];
                for (unsigned int d = 0; d < 3; ++d)
                  {
                    f[d] = (v >> d) & 1 ? xi[d] : 1. - xi[d];
                    s[d] = (v >> d) & 1 ? 1. : -1.;
                  }
                N[v] = f[0] * f[1] * f[2];
                for (unsigned int c = 0; c < 3; ++c)
                  {
                    J[c][0] += p[v][c] * s[0] * f[1] * f[2];
                    J[c][1] += p[v][c] * f[0] * s[1] * f[2];
                    J[c][2] += p[v][c] * f[0] * f[1] * s[2];
                  }
              }
            for (unsigned int v = 0; v < 8; ++v)
              expected[v] += 3. * weight[i] * weight[j] * weight[k] * N[v] * determinant(J);
          }
    for (unsigned int v = 0; v < 8; ++v)
      EXPECT_NEAR(cell.mass[cell.cells[0].nodes[v]], expected[v], 1e-14);
  }


  TEST(LumpedMass, OfACylinderIsDensityTimesTheVolumeOfItsMesh)
  {
    CylinderShape shape;
    shape.radius        = .2;
    shape.length        = .8;
    shape.cells_across  = 3;
    shape.cells_radial  = 2;
    shape.cells_axial   = 4;
    shape.sector        = Sector::full;
    shape.axial_grading = 3.;
    const Discretization cylinder({body_of(shape, CellIntegration::full)},
                                  {elastic(7800.)},
                                  MPI_COMM_SELF);
    const double mass = 7800. * volume_within(cylinder);
    EXPECT_NEAR(total_mass(cylinder), mass, 1e-13 * mass);
    // Somewhat less than the round cylinder.
    EXPECT_LT(mass, 7800. * pi * .04 * .8);
    EXPECT_GT(mass, .9 * 7800. * pi * .04 * .8);
  }
} // namespace lumped_masses
