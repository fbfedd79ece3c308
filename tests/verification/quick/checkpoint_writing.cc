#include <gtest/gtest.h>

#include <csignal>
#include <sys/resource.h>
#include <thread>

#include "support/background_run.h"
#include "support/run_directory.h"

// Checkpoints on request, and what happens when they cannot be written.

using namespace akmon::test;

namespace
{
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
        std::string newest;
        for (unsigned int i = 0; i < 2000 && newest == last; ++i)
          {
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
            const auto checkpoints = checkpoints_in(directory);
            newest                 = checkpoints.empty() ? last : checkpoints.back();
          }
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


  // While it lives, no file of this process grows beyond a size; writes fail as on a full disk.
  class FullDisk
  {
  public:
    explicit FullDisk(const rlim_t size)
      : former_handler(std::signal(SIGXFSZ, SIG_IGN))
    {
      getrlimit(RLIMIT_FSIZE, &former);
      const rlimit limit{size, former.rlim_max};
      setrlimit(RLIMIT_FSIZE, &limit);
    }

    ~FullDisk()
    {
      setrlimit(RLIMIT_FSIZE, &former);
      std::signal(SIGXFSZ, former_handler);
    }

    FullDisk(const FullDisk &) = delete;

  private:
    rlimit former{};
    void (*former_handler)(int);
  };


  // Checkpoints of the bars have 341 kB, all other files fewer than 300.
  TEST_F(CheckpointWriting, on_a_full_disk_stops_with_the_last_one_intact)
  {
    const std::vector<std::string> overrides = {"Checkpoint/Steps=10", "Output/History steps=0"};
    const auto before = arguments_for(shipped("two_bars"), directory, overrides);
    ASSERT_EQ(run_program(before).status, 0);
    const auto checkpoints = checkpoints_in(directory);
    ASSERT_EQ(checkpoints.size(), 2u);

    const std::string newest = directory + "/" + checkpoints[1];
    akmon::Simulation simulation(akmon::Case::read(directory + "/parameters.prm",
                                                   {"Time/End=4e-4"}),
                                 MPI_COMM_SELF,
                                 true);
    {
      const FullDisk full_disk(300000);
      try
        {
          simulation.run(newest);
          FAIL() << "the run did not notice";
        }
      catch (const akmon::RunError &error)
        {
          EXPECT_EQ(error.status, akmon::ExitStatus::output_failed);
          EXPECT_NE(std::string(error.what()).find("cannot write '" + directory + "/checkpoint_"),
                    std::string::npos)
            << error.what();
          EXPECT_NE(std::string(error.what()).find("File too large"), std::string::npos);
        }
    }
    EXPECT_EQ(checkpoints_in(directory), checkpoints);
    for (const auto &entry : fs::directory_iterator(directory))
      EXPECT_NE(entry.path().extension(), ".tmp");
    const auto rest = run_program({"--restart", directory, "--set", "Time/End=2.2e-4"});
    EXPECT_EQ(rest.status, 0) << rest.output;
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
} // namespace
