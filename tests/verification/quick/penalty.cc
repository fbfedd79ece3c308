#include <akmon/parameters.h>

#include <gtest/gtest.h>

#include <cmath>

#include "support/kept_run.h"
#include "support/report.h"
#include "support/run_directory.h"

// Penalty contact: the stiffness is the one documented, the time step follows it, and what it costs
// is reported.

namespace penalty
{
  using namespace akmon::test;

  constexpr double v0 = 202.2, force = 29998.604, K = 1.0e7, scale = 0.1, depth = 0.5;


  std::vector<std::string>
  bars(const std::string &left, const std::string &right, const std::string &pass)
  {
    return {"Contact solver/Type=penalty",
            "Contact/interface/Pass=" + pass,
            "Bodies/left/Box/Cells=" + left,
            "Bodies/right/Box/Cells=" + right};
  }


  // One cell across: each of the four nodes carries a quarter of the force on the spring
  // k = f_s K A^2/V; the bars lean against each other at that depth. They come there with the time
  // constant rho c A/(2 . 4 k), 9.3e-6 with a single pass, from 4.9e-5 on.
  TEST(PenaltyBars, penetrate_by_force_over_stiffness)
  {
    for (const double passes : {1., 2.})
      {
        const Table history = run_case(shipped("two_bars"),
                                       bars("20, 1, 1",
                                            "20, 1, 1",
                                            passes == 1. ? "single" : "symmetric"));
        const auto rows     = history.rows_between(1.1e-4, 1.4e-4);
        double mean_depth = 0., mean_force = 0., error = 0.;
        for (const std::size_t i : rows)
          {
            mean_depth += history["max_penetration"][i] / rows.size();
            mean_force -= history["interface.force_x"][i] / rows.size();
          }
        for (const double of_row : history["energy_error"])
          error = std::max(error, std::abs(of_row));
        const double expected = force / (4. * passes * scale * K / depth);
        report("penetration over that expected", mean_depth / expected);
        report("force over rho c v A", mean_force / force);
        report("energy error", error);
        EXPECT_NEAR(mean_depth, expected, 0.002 * expected);
        EXPECT_NEAR(mean_force, force, 0.002 * force);
        EXPECT_LE(error, 1e-3);
        EXPECT_LE(change_of_momentum(history), 1e-12 * 7.337e-3 * v0);
        EXPECT_EQ(history["impact_dissipation"].back(), 0.);
        EXPECT_GT(history["contact_energy"][rows[0]], 0.);
        EXPECT_EQ(history["contact_energy"].back(), 0.);
      }
  }


  // Springs stiffer than the cells: stable with the step they ask for, and not with the given one.
  // Nodes that strike such springs at a step near their critical one gain energy: a quarter of it.
  TEST(PenaltyBars, cut_the_step_as_far_as_they_must)
  {
    auto overrides = bars("20, 3, 3", "20, 4, 4", "symmetric");
    overrides.push_back("Contact solver/Penalty scale=100");
    overrides.push_back("Time/Safety factor=0.25");
    const Table history = run_case(shipped("two_bars"), overrides);
    double least        = history["dt"][0];
    for (const double dt : history["dt"])
      least = std::min(least, dt);
    report("step over that of the cells", least / 0.7274e-6);
    report("energy error", largest_of(history["energy_error"]));
    EXPECT_LT(least, 0.5 * 0.7274e-6);
    EXPECT_EQ(history["dt"][0], 0.7274e-6); // before they meet
    for (const double error : history["energy_error"])
      EXPECT_LE(std::abs(error), 5e-3);

    overrides.push_back("Time/Allow unstable step=true");
    EXPECT_THROW(run_case(shipped("two_bars"), overrides), akmon::RunError);
  }


  // A block on the ground sinks in until the springs of its ten nodes carry it; then it slides to
  // rest where Coulomb's law has it.
  TEST(PenaltyBlock, slides_to_rest)
  {
    const Table history = run_case(shipped("sliding_block"), {"Contact solver/Type=penalty"});
    report("distance", history["top.displacement_x"].back());
    report("energy error", largest_of(history["energy_error"]));
    EXPECT_NEAR(history["top.displacement_x"].back(), 25. / (2. * 0.3 * 9.81), 0.01);
    // K = 4e9/3, A = 1/4, depth 1/2
    const double sag = 1000. * 0.5 * 9.81 / (10. * scale * 4e9 / 3. * 0.25 / 0.5);
    EXPECT_LE(largest_of(history["max_penetration"]), 8. * sag);
    EXPECT_GE(largest_of(history["max_penetration"]), sag);
    for (const double error : history["energy_error"])
      EXPECT_LE(std::abs(error), 1e-3);
  }


  TEST(PenaltyBars, on_three_ranks_are_those_on_one)
  {
    const auto overrides = bars("20, 3, 3", "20, 4, 4", "symmetric");
    const Table one      = run_case(shipped("two_bars"), overrides),
                three    = run_case_on_ranks(shipped("two_bars"), 3, overrides);
    for (const char *const column : {"time", "max_penetration", "left_face.displacement_x"})
      EXPECT_EQ(one[column], three[column]) << column;
    for (std::size_t i = 0; i < one.n_rows(); ++i)
      EXPECT_NEAR(one["interface.force_x"][i], three["interface.force_x"][i], 1e-12 * force);
  }


  // Deep penetration is a warning, not the end.
  TEST(PenaltyBars, warn_of_soft_springs)
  {
    auto overrides = bars("20, 1, 1", "20, 1, 1", "single");
    overrides.push_back("Contact solver/Penalty scale=0.005");
    const ScratchDirectory scratch;
    overrides.push_back("Output/Penetration bound=0.02");
    const auto result = run_program(arguments_for(shipped("two_bars"), scratch.path, overrides));
    EXPECT_EQ(result.status, 0) << result.output;
    EXPECT_NE(result.output.find("penalty contact lets surfaces penetrate"), std::string::npos)
      << result.output;
  }
} // namespace penalty
