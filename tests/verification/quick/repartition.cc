#include <gtest/gtest.h>

#include "support/run_directory.h"

// Cells that are shared out anew change nothing but who computes them.

namespace repartition
{
  using namespace akmon::test;

  class Repartition : public testing::TestWithParam<const char *>
  {
  protected:
    // Bars with unlike meshes on three ranks; returns what the run printed.
    std::string
    run_bars(const std::string &directory, const std::string &bound) const
    {
      const auto result = run_program(arguments_for(shipped("two_bars"),
                                                    directory,
                                                    {"Time/End=1.2e-4",
                                                     "Checkpoint/Steps=50",
                                                     "Bodies/left/Box/Cells=20, 3, 3",
                                                     "Contact/interface/Pass=" +
                                                       std::string(coupled() ? "symmetric" :
                                                                               "single"),
                                                     "Contact solver/Type=" +
                                                       std::string(GetParam()),
                                                     "Parallel/Repartition above=" + bound}),
                                      3);
      EXPECT_EQ(result.status, 0) << result.output;
      return result.output;
    }

    bool
    coupled() const
    {
      return GetParam() == std::string("coupled");
    }
  };


  TEST_P(Repartition, keeps_all_bits_of_the_state)
  {
    const ScratchDirectory scratch;
    const std::string fixed = scratch.path + "/fixed", moved = scratch.path + "/moved";
    EXPECT_EQ(run_bars(fixed, "1e9").find("shared out anew"), std::string::npos);
    EXPECT_EQ(summary_value(fixed, "repartitions"), "0");
    EXPECT_NE(run_bars(moved, "1").find("shared out anew"), std::string::npos);
    EXPECT_GE(std::stoi(summary_value(moved, "repartitions")), 2);

    EXPECT_EQ(summary_value(moved, "state_hash"), summary_value(fixed, "state_hash"));
    EXPECT_EQ(summary_value(moved, "steps"), summary_value(fixed, "steps"));
    EXPECT_EQ(checkpoints_in(moved), checkpoints_in(fixed));
    EXPECT_EQ(field_files_in(moved), field_files_in(fixed));
    EXPECT_EQ(series_in(moved), series_in(fixed));
    const Table a(moved + "/history.csv"), b(fixed + "/history.csv");
    ASSERT_EQ(a["time"], b["time"]);
    for (const char *const of_motion : {"left_face.velocity_x", "left_middle.stress_xx"})
      EXPECT_EQ(a[of_motion], b[of_motion]);
    for (const char *const sum : {"kinetic_energy", "strain_energy", "impact_dissipation"})
      for (std::size_t i = 0; i < b.n_rows(); ++i)
        EXPECT_NEAR(a[sum][i], b[sum][i], 1e-12 * b["kinetic_energy"][0]) << sum;

    // Whose cells are whose has changed: a field of the last state tells.
    EXPECT_NE(file_content(moved + "/" + field_files_in(moved).back()),
              file_content(fixed + "/" + field_files_in(fixed).back()));
  }


  INSTANTIATE_TEST_SUITE_P(Bars,
                           Repartition,
                           testing::Values("decoupled", "coupled"),
                           [](const auto &info) { return std::string(info.param); });
} // namespace repartition
