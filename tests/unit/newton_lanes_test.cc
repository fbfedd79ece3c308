#include <akmon/contact/coupled/newton_lanes.h>
#include <akmon/contact/coupled/semismooth_newton.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "support/random_contact.h"
#include "support/report.h"

// Small contact problems side by side in SIMD lanes: against Signorini's and Coulomb's conditions,
// and each for itself whatever is beside it.

namespace newton_lanes_test
{
  using namespace akmon;
  using namespace akmon::test;

  constexpr double tolerance = 1e-12;


  // A random problem as NewtonLanes takes it.
  struct Posed
  {
    Posed(const unsigned int n,
          const unsigned int n_repeated,
          const unsigned int seed,
          const bool with_friction)
      : problem(n, n_repeated, seed)
      , data{problem.b,
             with_friction ? coefficients(n, seed) : std::vector<double>(n, 0.),
             std::vector<double>(n, 1.),
             norm_bound(problem.S),
             1e-7,
             tolerance,
             tolerance,
             1000,
             false}
      , A(matrix_of(problem))
      , t(n)
    {
    }

    NewtonLanes::Problem
    lane()
    {
      return {&A, &data, &t};
    }

    RandomContact problem;
    FrictionalProblem data;
    Eigen::MatrixXd A;
    std::vector<Vector> t;
  };


  // Of sizes, repeated pairs and friction of all kinds.
  std::vector<Posed>
  many_problems()
  {
    std::vector<Posed> posed;
    for (unsigned int seed = 1; seed <= 40; ++seed)
      for (const bool with_friction : {false, true})
        for (const auto &[n, n_repeated] : {std::make_pair(1U, 0U),
                                            std::make_pair(2U, 1U),
                                            std::make_pair(3U, 0U),
                                            std::make_pair(5U, 2U),
                                            std::make_pair(9U, 0U),
                                            std::make_pair(NewtonLanes::most_pairs, 4U)})
          posed.emplace_back(n, n_repeated, seed, with_friction);
    return posed;
  }


  TEST(NewtonLanes, solves_nearly_all_problems)
  {
    auto posed = many_problems();
    NewtonLanes lanes;
    unsigned int n_solved = 0;
    for (std::size_t first = 0; first < posed.size(); first += n_lanes)
      {
        std::vector<NewtonLanes::Problem> problems;
        for (std::size_t i = first; i < std::min<std::size_t>(first + n_lanes, posed.size()); ++i)
          problems.push_back(posed[i].lane());
        lanes.solve(problems);
        for (std::size_t i = 0; i < problems.size(); ++i)
          {
            const Posed &of_lane = posed[first + i];
            if (!problems[i].is_solved) // and left as it was
              EXPECT_EQ(of_lane.t, std::vector<Vector>(of_lane.t.size()));
            else
              {
                ++n_solved;
                EXPECT_LE(problems[i].residual, tolerance);
                expect_conditions(of_lane.problem, of_lane.data.friction, of_lane.t, first + i);
              }
          }
      }
    report("problems", posed.size());
    report("solved in lanes", n_solved);
    EXPECT_GE(n_solved, 0.8 * posed.size());
  }


  TEST(NewtonLanes, solves_each_for_itself)
  {
    auto together = many_problems(), alone = together;
    NewtonLanes lanes;
    for (std::size_t first = 0; first + n_lanes <= together.size(); first += n_lanes)
      {
        std::vector<NewtonLanes::Problem> problems;
        for (std::size_t i = 0; i < n_lanes; ++i)
          problems.push_back(together[first + i].lane());
        lanes.solve(problems);
        for (std::size_t i = 0; i < n_lanes; ++i)
          {
            std::vector<NewtonLanes::Problem> one = {alone[first + i].lane()};
            lanes.solve(one);
            EXPECT_EQ(problems[i].is_solved, one[0].is_solved);
            EXPECT_EQ(problems[i].n_applications, one[0].n_applications);
            EXPECT_EQ(together[first + i].t, alone[first + i].t) << first + i;
          }
      }
  }


  // Of the same step, from the last solution: one step, as close.
  TEST(NewtonLanes, starts_from_a_reference)
  {
    Posed posed(6, 2, 11, true);
    NewtonLanes lanes;
    std::vector<NewtonLanes::Problem> problems = {posed.lane()};
    lanes.solve(problems);
    ASSERT_TRUE(problems[0].is_solved);
    posed.data.start_is_reference = true;
    for (auto &b : posed.data.b)
      b[0] -= 1e-6;
    posed.problem.b = posed.data.b;
    problems        = {posed.lane()};
    lanes.solve(problems);
    ASSERT_TRUE(problems[0].is_solved);
    expect_conditions(posed.problem, posed.data.friction, posed.t, 0);
    EXPECT_LE(problems[0].n_applications, 8U);
  }


  TEST(NewtonLanes, leaves_what_it_does_not_solve)
  {
    Posed beside(4, 0, 4, true), posed(4, 0, 5, true);
    posed.data.b[2][0] = std::numeric_limits<double>::quiet_NaN();
    const auto start   = std::vector<Vector>(4, Vector({1., 0.1, 0.}));
    posed.t            = start;
    NewtonLanes lanes;
    std::vector<NewtonLanes::Problem> problems = {beside.lane(), posed.lane()};
    lanes.solve(problems);
    EXPECT_TRUE(problems[0].is_solved);
    EXPECT_FALSE(problems[1].is_solved);
    EXPECT_EQ(posed.t, start);
  }


  TEST(NewtonLanes, has_nothing_to_do_for_nothing)
  {
    NewtonLanes lanes;
    std::vector<NewtonLanes::Problem> problems;
    lanes.solve(problems);
    EXPECT_TRUE(problems.empty());
  }
} // namespace newton_lanes_test
