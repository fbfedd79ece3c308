#include <akmon/contact/coupled/coupled_solver.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include "support/coupled_boxes.h"
#include "support/report.h"

// CoupledSolver alone, for the pairs of two small boxes whose meshes do not match, from any start:
// increments that do not depend on the start, nor do forces although constraints repeat each other.

namespace coupled_solver_test
{
  using namespace akmon;
  using namespace akmon::test;
  using namespace akmon::test::coupled_boxes;

  // Increments of the contact nodes that a set of pairs makes for given starts of its forces.
  struct Alone
  {
    Alone(const unsigned int n, const unsigned int m)
      : boxes(n, m, 0.4, true)
    {
      mobility.reinit(boxes.discretization, boxes.conditions, boxes.nodes);
      std::mt19937 random(11);
      std::normal_distribution<double> normal;
      boxes.nodes.make(dx_free);
      for (unsigned int i = 0; i < boxes.nodes.size(); ++i)
        {
          const bool left = boxes.discretization.body_of_node[boxes.nodes.local_node(i)] == 0;
          dx_free.set(i,
                      Vector({(left ? 0.03 : 0.) + 0.002 * normal(random),
                              (left ? 0.005 : 0.) + 0.002 * normal(random),
                              0.002 * normal(random)}));
        }
      boxes.contact.search(boxes.state);
    }

    std::vector<Vector>
    solve(const double start, const unsigned int seed, std::vector<ContactPair> &pairs)
    {
      std::mt19937 random(seed);
      std::uniform_real_distribution<double> uniform;
      pairs = boxes.contact.get_pairs();
      for (auto &pair : pairs)
        {
          pair.target_gap   = pair.gap;
          pair.levered      = false; // levers of open gaps have their own test
          pair.normal_force = start * uniform(random);
        }
      CoupledSolver solver(boxes.solver, boxes.nodes, mobility);
      solver.begin_step(pairs, dx_free, std::vector<double>(pairs.size(), mu), mass_factor);
      EXPECT_EQ(solver.has_friction(), mu > 0.);
      solver.solve();
      EXPECT_TRUE(solver.converged());
      EXPECT_LE(solver.residual(), boxes.solver.tolerance);
      iterations = solver.iterations();

      std::vector<Vector> force(boxes.nodes.size()), dx(boxes.nodes.size());
      for (const auto &pair : pairs)
        for (unsigned int k = 0; k < pair.n_nodes; ++k)
          force[pair.nodes[k]] += pair.at_node(k, pair.force());
      for (unsigned int i = 0; i < dx.size(); ++i)
        dx[i] = dx_free[i] +
                force[i] / (boxes.discretization.mass[boxes.nodes.local_node(i)] * mass_factor);
      return dx;
    }

    static constexpr double mass_factor = 100.;
    Boxes boxes;
    Mobility mobility;
    ContactNodes::Field dx_free;
    double mu               = 0.;
    unsigned int iterations = 0;
  };


  double
  largest_difference(const std::vector<Vector> &a, const std::vector<Vector> &b)
  {
    double result = 0.;
    for (std::size_t i = 0; i < a.size(); ++i)
      result = std::max(result, (a[i] - b[i]).norm());
    return result;
  }


  class UniqueIncrement : public testing::TestWithParam<std::pair<unsigned int, unsigned int>>
  {
  };


  TEST_P(UniqueIncrement, and_forces_from_any_start)
  {
    const auto [n, m] = GetParam();
    Alone alone(n, m);
    std::vector<ContactPair> pairs, others;
    const auto expected   = alone.solve(0., 1, pairs);
    const auto iterations = alone.iterations;
    double forces = 0., largest = 0., increments = 0.;
    for (unsigned int seed = 2; seed <= 6; ++seed)
      {
        increments = std::max(increments,
                              largest_difference(alone.solve(10., seed, others), expected));
        for (std::size_t i = 0; i < pairs.size(); ++i)
          {
            largest = std::max(largest, pairs[i].normal_force);
            forces  = std::max(forces, std::abs(pairs[i].normal_force - others[i].normal_force));
          }
      }
    report("iterations from zero", iterations);
    report("difference of increments", increments);
    report("difference of forces over the largest", forces / largest);
    EXPECT_LE(increments, 1e-9);
    EXPECT_LE(forces, 1e-6 * largest);
  }


  // Where constraints repeat each other normal forces are not unique, and with them friction
  // limits: increments of what slips are not either. What sticks is.
  TEST_P(UniqueIncrement, with_friction_that_holds)
  {
    const auto [n, m] = GetParam();
    Alone alone(n, m);
    alone.mu = 20.;
    std::vector<ContactPair> pairs, others;
    const auto expected = alone.solve(0., 1, pairs);
    double increments   = 0.;
    for (unsigned int seed = 2; seed <= 6; ++seed)
      increments = std::max(increments,
                            largest_difference(alone.solve(10., seed, others), expected));
    report("iterations", alone.iterations);
    report("difference of increments over the approach", increments / 0.03);
    EXPECT_LE(increments, 1e-9);
  }


  TEST_P(UniqueIncrement, keeps_to_the_friction_limits)
  {
    const auto [n, m] = GetParam();
    Alone alone(n, m);
    alone.mu = 0.4;
    std::vector<ContactPair> pairs;
    alone.solve(0., 1, pairs);
    report("iterations", alone.iterations);
    for (const auto &pair : pairs)
      EXPECT_LE(pair.tangential_force.norm(), 0.4 * pair.normal_force * (1. + 1e-12));
  }


  INSTANTIATE_TEST_SUITE_P(Meshes,
                           UniqueIncrement,
                           testing::Values(std::make_pair(2u, 3u),
                                           std::make_pair(4u, 3u),
                                           std::make_pair(5u, 4u)));


  TEST(CoupledSolver, WarmStartFromTheSolutionCostsLittle)
  {
    Alone alone(4, 3);
    std::vector<ContactPair> pairs;
    alone.solve(0., 1, pairs);
    CoupledSolver solver(alone.boxes.solver, alone.boxes.nodes, alone.mobility);
    solver.begin_step(pairs,
                      alone.dx_free,
                      std::vector<double>(pairs.size(), 0.),
                      Alone::mass_factor);
    solver.solve();
    EXPECT_LE(solver.iterations(), 4u);
  }


  TEST(CoupledSolver, LeavesOpenPairsAlone)
  {
    Alone alone(3, 2);
    auto pairs = alone.boxes.contact.get_pairs();
    for (auto &pair : pairs)
      {
        pair.target_gap   = 1.; // far away
        pair.normal_force = 3.;
      }
    CoupledSolver solver(alone.boxes.solver, alone.boxes.nodes, alone.mobility);
    solver.begin_step(pairs,
                      alone.dx_free,
                      std::vector<double>(pairs.size(), 0.4),
                      Alone::mass_factor);
    solver.solve();
    EXPECT_EQ(solver.iterations(), 0u);
    for (const auto &pair : pairs)
      EXPECT_EQ(pair.normal_force, 0.);
  }
} // namespace coupled_solver_test
