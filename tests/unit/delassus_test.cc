#include <akmon/contact/contact.h>
#include <akmon/contact/coupled/delassus.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "support/report.h"

// The Delassus operator of two boxes on each other: its symmetry and its diagonal, and the bound of
// its norm that the solver of the coupled contact problem is given.

namespace delassus_test
{
  using namespace akmon;
  using namespace akmon::test;

  using Vector = dealii::Tensor<1, 3>;


  Body
  box(const std::string &name, const double z, const std::array<unsigned int, 3> &cells)
  {
    BoxShape shape;
    shape.size  = Vector({1., 1., 1.});
    shape.cells = cells;
    Body body;
    body.name       = name;
    body.mesh.shape = shape;
    body.position   = Vector({0., 0., z});
    body.rotation   = dealii::unit_symmetric_tensor<3>();
    body.material   = "stuff";
    return body;
  }


  struct Boxes
  {
    Boxes(const unsigned int n, const unsigned int m, const std::vector<PrescribedMotion> &motions)
      : motions(motions)
      , discretization({box("lower", -0.5, {{n, n, 1}}), box("upper", 0.5, {{m, m, 1}})},
                       {material()},
                       MPI_COMM_SELF)
      , conditions(discretization, this->motions)
      , nodes(discretization, surface_nodes())
    {
      mobility.reinit(discretization, conditions, nodes);
      // Contact refers to what it is given.
      const ContactSolver solver; // as by default: coupled
      const std::vector<SurfaceContact> contacts = {touching()};
      std::vector<RigidBody> no_obstacles;
      Contact contact(discretization, solver, contacts, no_obstacles, conditions);
      contact.search(NodalState(discretization));
      pairs = contact.get_pairs();
      delassus.reinit(pairs, mobility, mass_factor);
    }

    std::vector<ClosingPair>
    closing_pairs() const
    {
      std::vector<ClosingPair> result;
      for (const ContactPair &pair : pairs)
        {
          ClosingPair closing{};
          closing.pair = &pair;
          for (unsigned int k = 0; k < pair.n_nodes; ++k)
            {
              closing.ids[k]      = nodes.id_or_common(pair.nodes[k]);
              closing.mobility[k] = mobility[pair.nodes[k]];
            }
          result.push_back(closing);
        }
      return result;
    }

    static SurfaceContact
    touching()
    {
      SurfaceContact contact;
      contact.name          = "touch";
      contact.slaves        = {"upper:z-"};
      contact.masters       = {"lower:z+"};
      contact.rim_tolerance = 0.01;
      return contact;
    }

    static Material
    material()
    {
      Material material;
      material.name    = "stuff";
      material.density = 2.;
      material.law     = Hypoelastic{Elasticity::from_young(1., 0.3)};
      return material;
    }

    std::vector<unsigned int>
    surface_nodes() const
    {
      std::set<dealii::types::boundary_id> ids;
      ids.merge(discretization.boundary_ids("", "", "upper:z-"));
      ids.merge(discretization.boundary_ids("", "", "lower:z+"));
      std::set<unsigned int> nodes;
      for (const auto &face : discretization.faces_on(ids))
        nodes.insert(face.nodes.begin(), face.nodes.end());
      return {nodes.begin(), nodes.end()};
    }

    static constexpr double mass_factor = 37.;
    const std::vector<PrescribedMotion> motions;
    Discretization discretization;
    EssentialConditions conditions;
    ContactNodes nodes;
    Mobility mobility;
    Delassus delassus;
    std::vector<ContactPair> pairs;
  };


  double
  dot(const std::vector<Vector> &a, const std::vector<Vector> &b)
  {
    double sum = 0.;
    for (std::size_t i = 0; i < a.size(); ++i)
      sum += a[i] * b[i];
    return sum;
  }


  // Rayleigh's quotient after many power steps: the largest eigenvalue, from below.
  double
  power_iteration(Delassus &delassus, std::vector<Vector> t)
  {
    std::vector<Vector> y(t.size());
    double quotient = 0.;
    for (unsigned int k = 0; k < 500; ++k)
      {
        delassus.apply(t, y);
        quotient          = dot(t, y) / dot(t, t);
        const double size = std::sqrt(dot(y, y));
        for (std::size_t i = 0; i < t.size(); ++i)
          t[i] = y[i] / size;
      }
    return quotient;
  }


  class DelassusOfBoxes : public testing::TestWithParam<std::pair<unsigned int, unsigned int>>
  {
  protected:
    void
    check(Boxes &boxes)
    {
      const std::size_t n = boxes.pairs.size();
      std::mt19937 random(5);
      std::normal_distribution<double> normal;
      std::vector<Vector> a(n), b(n), Aa(n), Ab(n);
      for (std::size_t i = 0; i < n; ++i)
        for (unsigned int d = 0; d < 3; ++d)
          {
            a[i][d] = normal(random);
            b[i][d] = normal(random);
          }
      auto &delassus = boxes.delassus;
      delassus.apply(a, Aa);
      delassus.apply(b, Ab);
      EXPECT_NEAR(dot(a, Ab), dot(b, Aa), 1e-12 * std::sqrt(dot(Aa, Aa) * dot(b, b)));
      EXPECT_GE(dot(a, Aa), 0.);
      // A unit diagonal along normals, the first rows of the frames.
      for (std::size_t i = 0; i < n; ++i)
        {
          std::vector<Vector> unit(n), column(n);
          unit[i][0] = 1.;
          delassus.apply(unit, column);
          EXPECT_NEAR(column[i][0], 1., 1e-14);
        }

      const double bound = delassus.norm_bound(), largest = power_iteration(delassus, a);
      report("bound over norm", bound / largest);
      EXPECT_GE(bound, largest * (1. - 1e-12));
      EXPECT_LE(bound, 4. * largest);

      const auto closing = boxes.closing_pairs();
      ClosingPairs members;
      for (const ClosingPair &pair : closing)
        members.push_back(&pair);
      delassus.assemble(members, Boxes::mass_factor);
      EXPECT_EQ(delassus.matrix().rows(), 3 * static_cast<int>(n));
      EXPECT_LE((delassus.matrix() - delassus.matrix().transpose()).norm(), 1e-13 * largest);
      std::vector<Vector> by_matrix(n);
      delassus.apply(a, by_matrix);
      for (std::size_t i = 0; i < n; ++i)
        EXPECT_LE((by_matrix[i] - Aa[i]).norm(), 1e-13 * std::sqrt(dot(Aa, Aa)));
    }
  };


  TEST_P(DelassusOfBoxes, is_symmetric_with_unit_diagonal_and_bounded)
  {
    const auto [n, m] = GetParam();
    Boxes boxes(n, m, {});
    EXPECT_EQ(boxes.pairs.size(), (n + 1) * (n + 1) + (m + 1) * (m + 1));
    check(boxes);
  }


  TEST_P(DelassusOfBoxes, is_bounded_with_prescribed_motion_too)
  {
    PrescribedMotion guide;
    guide.name        = "guide";
    guide.type        = PrescribedMotion::Type::symmetry;
    guide.surfaces    = {"lower:x-", "upper:x-", "lower:y+"};
    const auto [n, m] = GetParam();
    Boxes boxes(n, m, {guide});
    check(boxes);
  }


  INSTANTIATE_TEST_SUITE_P(Meshes,
                           DelassusOfBoxes,
                           testing::Values(std::make_pair(1u, 1u),
                                           std::make_pair(2u, 3u),
                                           std::make_pair(4u, 3u),
                                           std::make_pair(5u, 2u)));
} // namespace delassus_test
