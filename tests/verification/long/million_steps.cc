#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/background_run.h"
#include "support/run_directory.h"

// A million steps of two small bars that hit each other and then fly apart, vibrating: linear and
// angular momentum stay to 1e-10, and the memory is that of a tenth of the steps.

namespace million_steps
{
  using namespace akmon::test;

  struct LongRun
  {
    double momentum, angular_momentum; ///< largest change over sum m |v_0|, and over that times L
    long memory;                       ///< kB
  };


  LongRun
  run_bars(const std::string &solver, const double n_steps)
  {
    constexpr double step = 0.7274e-6, scale = 2 * 7.337e-3 * 202.2, length = 10.;

    const ScratchDirectory scratch;
    BackgroundRun run(arguments_for(shipped("two_bars"),
                                    scratch.path + "/run",
                                    {"Contact solver/Type=" + solver,
                                     "Bodies/left/Box/Cells=2, 1, 1",
                                     "Bodies/right/Box/Cells=2, 1, 1",
                                     "Bodies/left/Velocity=202.2, 1, 2",
                                     "Output/Fields interval=0",
                                     "Output/History steps=10000",
                                     "Checkpoint/Steps=50000",
                                     "Time/End=" + akmon::shortest_text(n_steps * step)}),
                      scratch.path + "/output");
    EXPECT_EQ(run.wait(), 0) << file_content(scratch.path + "/output");
    const Table history(scratch.path + "/run/history.csv");
    EXPECT_GE(history.n_rows(), std::size_t(n_steps / 10000));
    EXPECT_GT(history["impact_dissipation"].back(), 0.); // they have met
    LongRun result{0., 0., run.largest_memory()};
    for (const char axis : {'x', 'y', 'z'})
      for (std::size_t i = 0; i < history.n_rows(); ++i)
        {
          const auto change = [&](const std::string &quantity) {
            const auto &column = history[quantity + axis];
            return std::abs(column[i] - column[0]) / scale;
          };
          result.momentum         = std::max(result.momentum, change("momentum_"));
          result.angular_momentum = std::max(result.angular_momentum,
                                             change("angular_momentum_") / length);
        }
    return result;
  }


  class MillionSteps : public testing::TestWithParam<std::string>
  {
  };


  TEST_P(MillionSteps, keep_momentum_and_memory)
  {
    constexpr long most = 1024; // kB

    const LongRun tenth = run_bars(GetParam(), 1e5), whole = run_bars(GetParam(), 1e6);
    long growth = whole.memory - tenth.memory;
    // What of libraries' files is in memory differs by some megabytes where other programs need
    // it. What is lost in every step would be lost again.
    for (unsigned int again = 0; again < 2 && growth > most; ++again)
      growth = std::min(growth,
                        run_bars(GetParam(), 1e6).memory - run_bars(GetParam(), 1e5).memory);
    RecordProperty("momentum", akmon::shortest_text(whole.momentum));
    RecordProperty("angular_momentum", akmon::shortest_text(whole.angular_momentum));
    RecordProperty("memory_growth_kB", int(growth));
    EXPECT_LE(whole.momentum, 1e-10);
    EXPECT_LE(whole.angular_momentum, 1e-10);
    EXPECT_LE(growth, most);
  }


  INSTANTIATE_TEST_SUITE_P(Solvers,
                           MillionSteps,
                           testing::Values("decoupled", "coupled"),
                           [](const auto &info) { return info.param; });
} // namespace million_steps
