#include <gtest/gtest.h>

#include <fcntl.h>
#include <semaphore.h>

#include "support/background_run.h"
#include "support/run_directory.h"

// What killed runs leave behind outside their output directory does not stop later ones.

namespace leftovers
{
  using namespace akmon::test;

  // The semaphore that Open MPI's shared file pointers keep for a file's name, as a run that was
  // killed while it held it leaves it: taken.
  class TakenSemaphore
  {
  public:
    explicit TakenSemaphore(const std::string &file)
      : name("/OMPIO_" + file)
      , semaphore(sem_open(name.c_str(), O_CREAT | O_EXCL, 0600, 0))
    {
    }

    ~TakenSemaphore()
    {
      if (!is_there())
        return;
      sem_close(semaphore);
      sem_unlink(name.c_str());
    }

    bool
    is_there() const
    {
      return semaphore != SEM_FAILED;
    }

  private:
    std::string name;
    sem_t *semaphore;
  };


  TEST(Leftovers, taken_semaphores_do_not_stop_a_run_writing_files_of_their_names)
  {
    const TakenSemaphore of_fields("fields_00001.vtu"),
      of_checkpoint("checkpoint_000000000003.h5.tmp");
    ASSERT_TRUE(of_fields.is_there() && of_checkpoint.is_there());
    const ScratchDirectory scratch;
    BackgroundRun run(arguments_for(shipped("two_bars"),
                                    scratch.path,
                                    {"Checkpoint/Steps=3", "Time/End=2e-5"}),
                      scratch.path + "/output");
    ASSERT_TRUE(run.wait_for(scratch.path + "/summary.json", 60))
      << file_content(scratch.path + "/output");
    EXPECT_EQ(run.wait(), 0);
    EXPECT_FALSE(checkpoints_in(scratch.path).empty());
  }
} // namespace leftovers
