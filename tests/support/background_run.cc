#include "support/background_run.h"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <stdexcept>
#include <sys/resource.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace akmon::test
{
  BackgroundRun::BackgroundRun(const std::vector<std::string> &arguments, const std::string &output)
    : process(fork())
  {
    if (process < 0)
      throw std::runtime_error("cannot fork");
    if (process > 0)
      return;
    // The child: nothing but system calls and exec.
    for (const char *const name : {"OMPI_MCA_ess", "PMIX_RANK", "PMIX_NAMESPACE"})
      unsetenv(name);
    signal(SIGXFSZ, SIG_IGN); // limit_file_size() makes writes fail, not the program end
    const int descriptor = open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    dup2(descriptor, STDOUT_FILENO);
    dup2(descriptor, STDERR_FILENO);
    std::vector<char *> argv{const_cast<char *>(AKMON_PROGRAM)};
    for (const auto &argument : arguments)
      argv.push_back(const_cast<char *>(argument.c_str()));
    argv.push_back(nullptr);
    execv(AKMON_PROGRAM, argv.data());
    _exit(127);
  }


  BackgroundRun::~BackgroundRun()
  {
    if (!ended)
      {
        send(SIGKILL);
        wait();
      }
  }


  void
  BackgroundRun::send(const int signal) const
  {
    kill(process, signal);
  }


  void
  BackgroundRun::limit_file_size(const unsigned long n_bytes) const
  {
    const rlimit limit{n_bytes, n_bytes};
    if (prlimit(process, RLIMIT_FSIZE, &limit, nullptr) != 0)
      throw std::runtime_error("cannot limit the file size");
  }


  bool
  BackgroundRun::wait_for(const std::string &path, const double seconds) const
  {
    const auto begin = std::chrono::steady_clock::now();
    while (!std::filesystem::exists(path))
      {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        siginfo_t info{};
        waitid(P_PID, process, &info, WEXITED | WNOHANG | WNOWAIT);
        const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
        if (info.si_pid != 0 || passed.count() > seconds)
          return std::filesystem::exists(path);
      }
    return true;
  }


  int
  BackgroundRun::wait()
  {
    int status = 0;
    rusage usage{};
    wait4(process, &status, 0, &usage);
    memory = usage.ru_maxrss;
    ended  = true;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
} // namespace akmon::test
