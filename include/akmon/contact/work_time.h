#pragma once

#include <chrono>

namespace akmon
{
  /// Adds the time that a block takes to a sum; seconds. For work in which a rank waits for no
  /// other.
  class WorkTime
  {
    using Clock = std::chrono::steady_clock;

  public:
    explicit WorkTime(double &sum)
      : sum(sum)
      , begin(Clock::now())
    {
    }

    ~WorkTime()
    {
      sum += std::chrono::duration<double>(Clock::now() - begin).count();
    }

    WorkTime(const WorkTime &) = delete;
    WorkTime &
    operator=(const WorkTime &) = delete;

  private:
    double &sum;
    const Clock::time_point begin;
  };
} // namespace akmon
