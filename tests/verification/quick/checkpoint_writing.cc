#include <gtest/gtest.h>

#include <csignal>
#include <thread>

#include "support/background_run.h"
#include "support/run_directory.h"

// Checkpoints on request, and what happens when they cannot be written.

namespace checkpoint_writing
{
  using namespace akmon::test;

  namespace fs = std::filesystem;

  class CheckpointWriting : public testing::Test
  {
  protected:
    // A run of many steps that goes on until it is stopped.
    std::vector<std::string>
    endless(std::vector<std::string> overrides) const
    {
      overrides.insert(overrides.end(), {"Time/End=1e6", "Output/Fields interval=0"});
      return arguments_for(shipped("one_cell"), directory, overrides);
    }

    // The newest checkpoint, once it is no longer the one given (or after 20 seconds).
    std::string
    newest_after(const std::string &last) const
    {
      std::string newest = last;
      for (unsigned int i = 0; i < 4000 && newest == last; ++i)
        {
          std::this_thread::sleep_for(std::chrono::milliseconds(5));
          const auto checkpoints = checkpoints_in(directory);
          newest                 = checkpoints.empty() ? last : checkpoints.back();
        }
      return newest;
    }

    const ScratchDirectory scratch;
    const std::string directory = scratch.path + "/run", output = scratch.path + "/output";
  };


  TEST_F(CheckpointWriting, on_sigterm_ends_the_run)
  {
    BackgroundRun run(endless({}), output);
    ASSERT_TRUE(run.wait_for(directory + "/history.csv", 30.)) << file_content(output);
    run.send(SIGTERM);
    EXPECT_EQ(run.wait(), 8);
    EXPECT_NE(file_content(output).find("stopped by SIGTERM"), std::string::npos);
    EXPECT_EQ(summary_value(directory, "exit_status"), "8");
    ASSERT_EQ(checkpoints_in(directory).size(), 1u);
    const unsigned long steps = std::stoul(summary_value(directory, "steps"));
    const auto rest           = run_program(
      {"--restart", directory, "--set", "Time/End=" + std::to_string((steps + 10) * 0.01)});
    EXPECT_EQ(rest.status, 0) << rest.output;
    EXPECT_EQ(Table(directory + "/history.csv").n_rows(),
              std::stoul(summary_value(directory, "steps")) + 1);
  }


  TEST_F(CheckpointWriting, on_sigusr1_and_goes_on)
  {
    BackgroundRun run(endless({}), output);
    ASSERT_TRUE(run.wait_for(directory + "/history.csv", 30.)) << file_content(output);
    std::string last;
    for (unsigned int n = 0; n < 3; ++n)
      {
        run.send(SIGUSR1);
        const std::string newest = newest_after(last);
        EXPECT_NE(newest, last);
        last = newest;
      }
    run.send(SIGTERM);
    EXPECT_EQ(run.wait(), 8) << file_content(output);
    EXPECT_EQ(checkpoints_in(directory).size(), 2u);
  }


  TEST_F(CheckpointWriting, by_wall_time)
  {
    BackgroundRun run(endless({"Checkpoint/Wall minutes=0.002"}), output);
    ASSERT_TRUE(run.wait_for(directory + "/history.csv", 30.)) << file_content(output);
    for (unsigned int i = 0; i < 2000 && checkpoints_in(directory).size() < 2; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_EQ(checkpoints_in(directory).size(), 2u);
  }


  // Checkpoints of the bars have 341 kB, all other files fewer than 300.
  TEST_F(CheckpointWriting, on_a_full_disk_stops_with_the_last_one_intact)
  {
    const std::vector<std::string> overrides = {"Time/End=1e6",
                                                "Output/Fields interval=0",
                                                "Output/History steps=0"};
    BackgroundRun run(arguments_for(shipped("two_bars"), directory, overrides), output);
    ASSERT_TRUE(run.wait_for(directory + "/history.csv", 30.)) << file_content(output);
    run.send(SIGUSR1);
    const std::string intact = newest_after("");
    ASSERT_NE(intact, "");

    run.limit_file_size(300000);
    run.send(SIGUSR1);
    EXPECT_EQ(run.wait(), 7); // HDF5 survives until the program has ended
    const std::string said = file_content(output);
    EXPECT_NE(said.find("cannot write '" + directory + "/checkpoint_"), std::string::npos) << said;
    EXPECT_NE(said.find("File too large"), std::string::npos) << said;
    EXPECT_EQ(checkpoints_in(directory), std::vector<std::string>{intact});
    for (const auto &entry : fs::directory_iterator(directory))
      EXPECT_NE(entry.path().extension(), ".tmp");

    const double step          = 0.7274e-6;
    const unsigned long n_done = std::stoul(intact.substr(std::string("checkpoint_").size()));
    const auto rest            = run_program(
      {"--restart", directory, "--set", "Time/End=" + akmon::shortest_text((n_done + 10) * step)});
    EXPECT_EQ(rest.status, 0) << rest.output;
    EXPECT_EQ(summary_value(directory, "steps"), std::to_string(n_done + 10));
  }


  TEST_F(CheckpointWriting, where_nothing_can_be_written_stops_the_run)
  {
    BackgroundRun run(endless({}), output);
    ASSERT_TRUE(run.wait_for(directory + "/fields.pvd", 30.)) << file_content(output);
    fs::rename(directory, directory + "_elsewhere");
    run.send(SIGUSR1);
    EXPECT_EQ(run.wait(), 7) << file_content(output);
    EXPECT_NE(file_content(output).find("cannot write '" + directory + "/checkpoint_"),
              std::string::npos)
      << file_content(output);
  }
} // namespace checkpoint_writing
