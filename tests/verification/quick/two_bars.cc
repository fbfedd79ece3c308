#include <gtest/gtest.h>

#include <cmath>

#include "support/run_case.h"

// Two identical elastic bars, AIAA 2003-1599 section 9.1; exact 1D solution: impact at g/v0,
// release 2 L sqrt(rho/E) later, interface at rest in between under the force rho c v0 A.

namespace two_bars
{
  using namespace akmon::test;

  constexpr double v0 = 202.2, force = 29998.604, t_impact = 4.945598e-5, t_release = 1.4836335e-4;
  constexpr double dt = 0.7274e-6, mass_of_bar = 7.337e-4 * 10.;


  class TwoBars : public testing::TestWithParam<const char *>
  {
  };


  double
  largest(const std::vector<double> &values, const std::vector<std::size_t> &rows)
  {
    double result = 0.;
    for (const std::size_t i : rows)
      result = std::max(result, std::abs(values[i]));
    return result;
  }


  TEST_P(TwoBars, match_the_exact_solution)
  {
    const Table history = run_case(shipped("two_bars"),
                                   {std::string("Contact/interface/Gap model=") + GetParam()});
    const auto &time = history["time"], &pairs = history["active_pairs"];

    for (const double penetration : history["max_penetration_rel"])
      EXPECT_LE(penetration, 1e-12);
    for (const double error : history["energy_error"])
      EXPECT_LE(std::abs(error), 1e-3);
    for (const char *const axis : {"x", "y", "z"})
      for (const double momentum : history[std::string("momentum_") + axis])
        EXPECT_LE(std::abs(momentum), 1e-12 * mass_of_bar * v0);

    std::size_t first = 0, last = 0;
    for (std::size_t i = 0; i < time.size(); ++i)
      if (pairs[i] > 0.)
        {
          first = first == 0 ? i : first;
          last  = i;
        }
    EXPECT_NEAR(time[first], t_impact, dt);
    EXPECT_NEAR(time[last], t_release, 3. * dt);

    // The first force acts a step before the gap closes, and the central velocity is the mean of
    // two increments: two levels later both lie in contact.
    EXPECT_LE(largest(history["left_face.velocity_x"],
                      history.rows_between(time[first + 2], t_release - dt)),
              1e-6 * v0);
    for (const std::size_t i : history.rows_between(6e-5, 1.35e-4))
      EXPECT_EQ(pairs[i], 25.);
    double mean     = 0.;
    const auto rows = history.rows_between(6e-5, 1.35e-4);
    for (const std::size_t i : rows)
      mean -= history["interface.force_x"][i] / rows.size();
    EXPECT_NEAR(mean, force, 0.01 * force);
  }


  INSTANTIATE_TEST_SUITE_P(GapModels,
                           TwoBars,
                           testing::Values("point to segment", "point to point"));
} // namespace two_bars
