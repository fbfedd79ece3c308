#include <gtest/gtest.h>

#include <cmath>

#include "support/run_directory.h"

// A run that goes on from a checkpoint ends as the one that was never stopped: the same bits on the
// same ranks, and rows and field files without gap or double. On another number of ranks the motion
// has the same bits with the decoupled solver.

namespace restart
{
  using namespace akmon::test;

  namespace fs = std::filesystem;

  struct RestartedCase
  {
    std::string name;
    std::vector<std::string> overrides;
    unsigned int n_ranks;
  };


  void
  PrintTo(const RestartedCase &restarted, std::ostream *out)
  {
    *out << restarted.name << " on " << restarted.n_ranks;
  }


  const std::vector<std::string> bars = {"Time/End=1.2e-4",
                                         "Checkpoint/Steps=40",
                                         "Output/History steps=3"};


  // Runs a case to its end; its last two checkpoints remain.
  void
  run_reference(const RestartedCase &reference, const std::string &directory)
  {
    const auto result = run_program(arguments_for(shipped(reference.name),
                                                  directory,
                                                  reference.overrides),
                                    reference.n_ranks);
    ASSERT_EQ(result.status, 0) << result.output;
    ASSERT_EQ(checkpoints_in(directory).size(), 2u);
  }


  class Restart : public testing::TestWithParam<RestartedCase>
  {
  };


  TEST_P(Restart, goes_on_with_the_same_bits)
  {
    const ScratchDirectory scratch;
    const std::string reference = scratch.path + "/reference";
    run_reference(GetParam(), reference);

    // From the older checkpoint, so that the newer one must go, and be written again.
    const std::string again = scratch.path + "/again";
    fs::copy(reference, again);
    const auto checkpoints = checkpoints_in(again);
    const auto result      = run_program({"--restart", again + "/" + checkpoints[0]},
                                    GetParam().n_ranks);
    EXPECT_EQ(result.status, 0) << result.output;
    expect_same_run(again, reference);
    EXPECT_EQ(checkpoints_in(again), checkpoints);
    EXPECT_EQ(file_content(again + "/" + checkpoints[1]),
              file_content(reference + "/" + checkpoints[1]));
  }


  INSTANTIATE_TEST_SUITE_P(
    Shipped,
    Restart,
    testing::Values(
      RestartedCase{"two_bars", bars, 1},
      RestartedCase{"two_bars", bars, 2},
      // Steps that follow the deformation, plastic flow, a rigid wall.
      RestartedCase{"taylor_bar_quarter",
                    {"Time/End=4e-6",
                     "Bodies/bar/Cylinder/Cells axial=12",
                     "Checkpoint/Interval=1e-6"},
                    1},
      // The estimate of the assembled frequency, on scaled masses.
      RestartedCase{"taylor_bar_quarter",
                    {"Time/End=4e-6",
                     "Time/Critical step=assembled",
                     "Time/Mass scaling step=1e-7",
                     "Bodies/bar/Cylinder/Cells axial=12",
                     "Checkpoint/Interval=1e-6"},
                    1},
      // Coupled friction that sticks and slips, warm-started.
      RestartedCase{"sliding_block", {"Time/End=0.02", "Checkpoint/Steps=60"}, 2},
      // Penalty springs with friction; bonds while they fail.
      RestartedCase{"sliding_block",
                    {"Time/End=0.02", "Checkpoint/Steps=60", "Contact solver/Type=penalty"},
                    1},
      // Corners and edges of a free rigid body.
      RestartedCase{"dropped_box", {"Time/End=0.03", "Checkpoint/Steps=60"}, 2},
      RestartedCase{"lap_joint", {"Time/End=5.5e-5", "Checkpoint/Interval=2e-5"}, 2},
      // Two unlike meshes, both sides slave and master.
      RestartedCase{"two_bars",
                    {"Time/End=8e-5",
                     "Checkpoint/Steps=30",
                     "Contact solver/Type=coupled",
                     "Contact/interface/Pass=symmetric",
                     "Bodies/left/Box/Cells=20, 3, 3",
                     "Contact/interface/Friction coefficient=0.3"},
                    1}),
    [](const auto &info) {
      return std::to_string(info.index) + "_" + info.param.name + "_on_" +
             std::to_string(info.param.n_ranks);
    });


  // From one to two and from two to three ranks: sums over ranks agree to round-off, the state to
  // the bit.
  TEST(RestartOnOtherRanks, has_the_same_state)
  {
    for (const unsigned int n_ranks : {1u, 2u})
      {
        const ScratchDirectory scratch;
        run_reference({"two_bars", bars, n_ranks}, scratch.path);
        const std::string hash = summary_value(scratch.path, "state_hash");
        const Table before(scratch.path + "/history.csv");
        const auto result = run_program({"--restart",
                                         scratch.path + "/" + checkpoints_in(scratch.path)[0]},
                                        n_ranks + 1);
        EXPECT_EQ(result.status, 0) << result.output;
        EXPECT_EQ(summary_value(scratch.path, "state_hash"), hash);
        const Table after(scratch.path + "/history.csv");
        ASSERT_EQ(after["time"], before["time"]);
        EXPECT_EQ(after["left_face.stress_xx"], before["left_face.stress_xx"]);
        for (const char *const sum : {"kinetic_energy", "strain_energy", "impact_dissipation"})
          for (std::size_t i = 0; i < before.n_rows(); ++i)
            EXPECT_NEAR(after[sum][i], before[sum][i], 1e-12 * before["kinetic_energy"][0]) << sum;
      }
  }


  class RefusedCheckpoint : public testing::Test
  {
  protected:
    RefusedCheckpoint()
    {
      run_reference({"two_bars", bars, 1}, scratch.path);
      newest = scratch.path + "/" + checkpoints_in(scratch.path).back();
      fs::copy(scratch.path,
               untouched.path,
               fs::copy_options::recursive | fs::copy_options::overwrite_existing);
    }

    // The refusal is one line with the reason; nothing else in the directory changes.
    void
    expect_refused(const std::vector<std::string> &arguments, const std::string &reason)
    {
      const std::string damaged = file_content(newest);
      const auto result         = run_program(arguments);
      EXPECT_EQ(result.status, 1) << result.output;
      EXPECT_NE(result.output.find(reason), std::string::npos) << result.output;
      EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1) << result.output;
      EXPECT_EQ(file_content(newest), damaged);
      for (const char *const file :
           {"/history.csv", "/fields.pvd", "/summary.json", "/parameters.prm"})
        EXPECT_EQ(file_content(scratch.path + file), file_content(untouched.path + file)) << file;
    }

    void
    restore_newest()
    {
      fs::copy_file(untouched.path + "/" + fs::path(newest).filename().string(),
                    newest,
                    fs::copy_options::overwrite_existing);
    }

    const ScratchDirectory scratch, untouched;
    std::string newest;
  };


  TEST_F(RefusedCheckpoint, with_a_changed_byte_anywhere)
  {
    const std::string content = file_content(newest);
    ASSERT_GT(content.size(), 10000u);
    // In every line of the header, in its rest, in HDF5's structures and in the data.
    for (const std::size_t place : {std::size_t(2),
                                    std::size_t(23),
                                    std::size_t(33),
                                    std::size_t(42),
                                    std::size_t(58),
                                    std::size_t(500),
                                    std::size_t(513),
                                    content.size() / 2,
                                    content.size() - 1})
      {
        SCOPED_TRACE(place);
        std::string changed = content;
        changed[place] ^= 0x10;
        write_file(newest, changed);
        expect_refused({"--restart", scratch.path}, "is refused: ");
      }
    write_file(newest, content.substr(0, content.size() - 100));
    expect_refused({"--restart", scratch.path}, "bytes instead of");
    write_file(newest, "");
    expect_refused({"--restart", scratch.path}, "is no checkpoint of Akmon");
  }


  TEST_F(RefusedCheckpoint, of_another_format)
  {
    std::string content = file_content(newest);
    const auto at       = content.find("\nformat 3\n");
    ASSERT_LT(at, 512u);
    content[at + 8] = '9';
    write_file(newest, content);
    expect_refused({"--restart", scratch.path}, "it is of format 9, written by Akmon");
  }


  TEST_F(RefusedCheckpoint, of_another_model)
  {
    expect_refused(
      {"--restart", scratch.path, "--set", "Bodies/left/Box/Cells=10, 4, 4"},
      "its mesh has 1050 nodes and 640 cells, that of the case 800 nodes and 480 cells");
    expect_refused({"--restart", scratch.path, "--set", "Bodies/left/Box/Size=10, 1, 0.9"},
                   "its mesh or its materials are not those of the case");
    expect_refused({"--restart", scratch.path, "--set", "Materials/elastic/Density=7e-4"},
                   "its mesh or its materials are not those of the case");
    const std::string parameters = std::regex_replace(file_content(scratch.path +
                                                                   "/parameters.prm"),
                                                      std::regex("left_middle"),
                                                      "left_centre");
    for (const std::string &directory : {scratch.path, untouched.path})
      write_file(directory + "/parameters.prm", parameters);
    expect_refused({"--restart", scratch.path}, "has other columns than the case now");
  }


  TEST_F(RefusedCheckpoint, that_is_not_there)
  {
    expect_refused({"--restart", scratch.path + "/nowhere"}, "there is no such directory");
    expect_refused({"--restart", newest, "--set", "Time/End=1e-5"}, "at or behind the end");
    expect_refused({"--restart", newest, shipped("two_bars")}, "is one too many");
    const ScratchDirectory empty;
    expect_refused({"--restart", empty.path}, "there is no checkpoint in this directory");
  }


  TEST_F(RefusedCheckpoint, whose_history_is_gone)
  {
    const std::string history = file_content(scratch.path + "/history.csv");
    write_file(scratch.path + "/history.csv", history.substr(0, 1000));
    fs::copy_file(scratch.path + "/history.csv",
                  untouched.path + "/history.csv",
                  fs::copy_options::overwrite_existing);
    expect_refused({"--restart", scratch.path}, "lacks rows");
  }


  // The end of a finished run is moved and the run goes on to it.
  TEST(Restart, may_change_parameters)
  {
    const ScratchDirectory scratch;
    run_reference({"two_bars", bars, 1}, scratch.path);
    const auto result = run_program({"--restart", scratch.path, "--set", "Time/End=1.4e-4"});
    EXPECT_EQ(result.status, 0) << result.output;
    const Table history(scratch.path + "/history.csv");
    EXPECT_NEAR(history["time"].back(), 1.4e-4, 1e-16);
    EXPECT_NE(file_content(scratch.path + "/parameters.prm").find("1.4e-4"), std::string::npos);
  }
} // namespace restart
