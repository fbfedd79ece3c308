#pragma once

#include <signal.h>
#include <string>
#include <sys/types.h>
#include <vector>

namespace akmon::test
{
  /// The akmon program on one rank, in the background; killed with the object if it still runs.
  class BackgroundRun
  {
  public:
    /// @param output  file that both its streams go to
    BackgroundRun(const std::vector<std::string> &arguments, const std::string &output);
    ~BackgroundRun();
    BackgroundRun(const BackgroundRun &) = delete;
    BackgroundRun &
    operator=(const BackgroundRun &) = delete;

    void
    send(const int signal) const;

    /// From now on its files do not grow beyond a size; writing further fails as on a full disk.
    void
    limit_file_size(const unsigned long n_bytes) const;

    /// Wait until a file is there; false after @p seconds or if the program ended before.
    bool
    wait_for(const std::string &path, const double seconds) const;

    /// Wait for the end; the exit status, or minus the number of the signal that ended it.
    int
    wait();

    /// Largest resident memory of the ended program; kB.
    long
    largest_memory() const
    {
      return memory;
    }

  private:
    pid_t process;
    long memory = 0;
    bool ended  = false;
  };
} // namespace akmon::test
