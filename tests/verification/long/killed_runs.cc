#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include "support/background_run.h"
#include "support/run_directory.h"

// kill -9 at 20 random moments: whatever was being written, the run goes on from its checkpoints
// and ends as the run that nobody disturbed. A checkpoint every third step makes a good part of the
// moments fall into their writing.

namespace killed_runs
{
  using namespace akmon::test;

  const std::vector<std::string> overrides = {"Checkpoint/Steps=3", "Output/Fields interval=1e-5"};


  double
  seconds_of(const std::vector<std::string> &arguments, const std::string &output)
  {
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(BackgroundRun(arguments, output).wait(), 0) << file_content(output);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }


  TEST(KilledRun, goes_on_to_the_same_end)
  {
    const ScratchDirectory scratch;
    const std::string reference = scratch.path + "/reference", killed = scratch.path + "/killed",
                      output = scratch.path + "/output";
    const double duration    = seconds_of(arguments_for(shipped("two_bars"), reference, overrides),
                                       output);

    std::mt19937 random(20);
    unsigned int n_kills = 0, n_while_writing = 0, n_finished = 0;
    while (n_kills < 20)
      {
        // From the beginning as long as there is no checkpoint.
        const bool fresh = !std::filesystem::exists(killed) || checkpoints_in(killed).empty();
        BackgroundRun run(fresh ? arguments_for(shipped("two_bars"), killed, overrides) :
                                  std::vector<std::string>{"--restart", killed},
                          output);
        const double moment = std::uniform_real_distribution<double>(0.2, 0.6)(random) * duration;
        std::this_thread::sleep_for(std::chrono::duration<double>(moment));
        run.send(SIGKILL);
        const int status = run.wait();
        ASSERT_TRUE(status == 0 || status == -SIGKILL) << file_content(output);
        if (status == 0)
          {
            // It was faster than the signal: its end is compared, and a new run begun.
            expect_same_run(killed, reference);
            std::filesystem::remove_all(killed);
            ++n_finished;
            continue;
          }
        ++n_kills;
        if (std::filesystem::exists(killed))
          for (const auto &entry : std::filesystem::directory_iterator(killed))
            n_while_writing += entry.path().extension() == ".tmp";
      }
    if (!std::filesystem::exists(killed) || checkpoints_in(killed).empty())
      seconds_of(arguments_for(shipped("two_bars"), killed, overrides), output);
    else
      seconds_of({"--restart", killed}, output);
    expect_same_run(killed, reference);
    RecordProperty("killed_while_writing", int(n_while_writing));
    RecordProperty("finished_in_between", int(n_finished));
    EXPECT_GT(n_while_writing, 0u);
  }
} // namespace killed_runs
