#include <gtest/gtest.h>

#include "support/run_directory.h"

// A run that must not go on says so in one line, leaves its last state to look at, and fails.

namespace stops
{
  using namespace akmon::test;

  void
  expect_stop(const std::string &file,
              const std::vector<std::string> &overrides,
              const std::string &reason,
              const int status)
  {
    const ScratchDirectory scratch;
    auto without_fields = overrides;
    without_fields.emplace_back("Output/Fields interval=0");
    const auto result = run_program(arguments_for(file, scratch.path, without_fields));
    EXPECT_EQ(result.status, status);
    EXPECT_NE(result.output.find("akmon: error: "), std::string::npos) << result.output;
    EXPECT_NE(result.output.find(reason), std::string::npos) << result.output;
    EXPECT_NE(result.output.find("step "), std::string::npos);
    // The initial state and the one at which it stopped.
    EXPECT_TRUE(std::filesystem::exists(scratch.path + "/fields_00000.vtu"));
    EXPECT_TRUE(std::filesystem::exists(scratch.path + "/fields_00001.vtu"));
    EXPECT_EQ(summary_value(scratch.path, "completed"), "false");
    EXPECT_EQ(summary_value(scratch.path, "exit_status"), std::to_string(status));

    // A checkpoint to look at, which no run goes on from.
    const std::string fault = scratch.path + "/checkpoint_fault.h5";
    ASSERT_TRUE(std::filesystem::exists(fault));
    const auto restart = run_program({"--restart", fault});
    EXPECT_EQ(restart.status, 1);
    EXPECT_NE(restart.output.find("could not go on"), std::string::npos) << restart.output;
  }


  void
  expect_stop(const std::vector<std::string> &overrides,
              const std::string &reason,
              const int status)
  {
    expect_stop(shipped("two_bars"), overrides, reason, status);
  }


  TEST(Run, stops_on_an_energy_error_beyond_the_bound)
  {
    expect_stop({"Output/Energy error bound=1e-9"}, "fastest is body '", 4);
  }


  // Without history rows the energies are looked at all the same.
  TEST(Run, stops_on_an_energy_error_without_history)
  {
    expect_stop({"Output/Energy error bound=1e-9", "Output/History steps=0"}, "energy error", 4);
  }


  TEST(Run, stops_on_hourglass_energy_beyond_the_bound)
  {
    // At its default bound, 0.1, the run reaches its end with 0.0093.
    expect_stop(shipped("taylor_bar_one_point"),
                {"Output/Hourglass energy bound=0.005",
                 "Bodies/bar/Cylinder/Cells across=4",
                 "Bodies/bar/Cylinder/Cells radial=2",
                 "Bodies/bar/Cylinder/Cells axial=24"},
                "hourglass energy",
                4);
  }


  TEST(Run, stops_on_inverted_cells)
  {
    expect_stop({"Time/Step=4e-6",
                 "Time/Allow unstable step=true",
                 "Output/Energy error bound=1e300"},
                "of body 'left' is inverted, near (",
                2);
  }


  // A pressure without a value makes forces and then places without one.
  TEST(Run, stops_on_what_is_not_a_number)
  {
    const ScratchDirectory scratch;
    const std::string file = scratch.path + "/case.prm";
    write_file(file,
               file_content(shipped("two_bars")) +
                 "subsection Loads\nset Names = odd\nsubsection odd\nset Surfaces = right:x+\n"
                 "set Function = sqrt(1e-5 - t)\nend\nend\n");
    expect_stop(file,
                {"Output/Energy error bound=1e300"},
                "the energy is not a number; fastest is body 'right'",
                3);
  }


  TEST(Run, stops_when_the_step_collapses)
  {
    expect_stop(shipped("taylor_bar_quarter"),
                {"Time/Smallest step=0.95", "Bodies/bar/Cylinder/Cells axial=12"},
                "below [Time] Smallest step, by cell ",
                5);
  }


  TEST(Run, stops_when_contact_is_lost)
  {
    // Decoupled, unlike meshes: nodes go in by 1e-9 of a cell.
    expect_stop({"Output/Penetration bound=1e-10", "Bodies/left/Box/Cells=20, 3, 3"},
                "contact is lost: a penetration of ",
                6);
  }


  // Cells that would make the step collapse are taken out, and the run reaches its end with its
  // energy in balance; from a checkpoint too.
  TEST(Run, erodes_cells)
  {
    const ScratchDirectory scratch;
    const auto result = run_program(arguments_for(shipped("taylor_bar_quarter"),
                                                  scratch.path,
                                                  {"Time/End=8e-5",
                                                   "Time/Smallest step=0.95",
                                                   "Checkpoint/Interval=3.5e-5",
                                                   "Bodies/bar/Failing cells=erode",
                                                   "Bodies/bar/Cylinder/Cells axial=12"}));
    EXPECT_EQ(result.status, 0) << result.output;
    EXPECT_NE(result.output.find("cells eroded so far"), std::string::npos) << result.output;
    EXPECT_GT(std::stoul(summary_value(scratch.path, "eroded_cells")), 0u);
    const std::string hash = summary_value(scratch.path, "state_hash");
    const auto again       = run_program({"--restart", scratch.path});
    EXPECT_EQ(again.status, 0) << again.output;
    EXPECT_EQ(summary_value(scratch.path, "state_hash"), hash);
  }


  TEST(Run, refuses_a_step_above_the_critical_one)
  {
    const ScratchDirectory scratch;
    const auto refused = run_program(
      arguments_for(shipped("two_bars"), scratch.path, {"Time/Step=4e-6"}));
    EXPECT_EQ(refused.status, 1);
    EXPECT_NE(refused.output.find("[Time] Step = 4e-06: it is above the critical step"),
              std::string::npos)
      << refused.output;
    const auto forced = run_program(
      arguments_for(shipped("two_bars"),
                    scratch.path,
                    {"Time/Step=4e-6", "Time/Allow unstable step=true"}));
    EXPECT_NE(forced.output.find("Warning: the time step is above the critical step"),
              std::string::npos)
      << forced.output;
  }
} // namespace stops
