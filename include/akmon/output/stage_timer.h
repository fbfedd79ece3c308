#pragma once

#include <deal.II/base/mpi.h>

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

namespace akmon
{
  /**
   * Wall time and calls of the stages of a run. A module registers its stages once and keeps the
   * handles; timing a stage then costs two readings of the clock:
   *
   *     const StageTimer::Stage search_stage = timer.add("contact.search");   // once
   *     const StageTimer::Scope timing(search_stage);                         // in every step
   *
   * Stages may nest; each counts its own full time. Not for concurrent threads.
   */
  class StageTimer
  {
    using Clock = std::chrono::steady_clock;

  public:
    /// Handle of a stage, cheap to copy, valid as long as its timer.
    class Stage
    {
      friend class StageTimer;
      Stage(StageTimer &timer, const std::size_t index);

      StageTimer *timer;
      std::size_t index;
    };

    /// Times a stage from here to the end of the block.
    class Scope
    {
    public:
      explicit Scope(const Stage stage);
      ~Scope();
      Scope(const Scope &) = delete;
      Scope &
      operator=(const Scope &) = delete;

    private:
      const Stage stage;
      const Clock::time_point start;
    };

    /// What a stage has taken so far: wall seconds and the number of calls.
    struct Total
    {
      std::string name;
      double seconds;
      unsigned long calls;
      double imbalance = 1.; ///< seconds of the slowest rank over those of the mean one
    };

    StageTimer()                   = default;
    StageTimer(const StageTimer &) = delete;
    StageTimer &
    operator=(const StageTimer &) = delete;

    /// Register a stage; a name known already gives the same stage again.
    Stage
    add(const std::string &name);

    /// Seconds of a stage on this rank so far.
    double
    seconds(const Stage stage) const
    {
      return std::chrono::duration<double>(records[stage.index].duration).count();
    }

    /// Totals of this rank for the stages used so far, in the order of their first use.
    std::vector<Total>
    totals() const;

    /**
     * Like totals(), with the largest seconds and calls of any rank and the imbalance. Collective;
     * needs the same stages registered in the same order on all ranks, though not all of them used.
     */
    std::vector<Total>
    totals(const MPI_Comm comm) const;

  private:
    struct Record
    {
      std::string name;
      Clock::duration duration = Clock::duration::zero();
      unsigned long calls      = 0;
      unsigned int first_use   = 0; // 1 for the stage used first; 0 while unused
    };

    void
    begin(const std::size_t index);

    void
    end(const std::size_t index, const Clock::time_point start);

    std::vector<Record> records;
    unsigned int n_used = 0;
  };


  // The stages are timed several times per step: these stay inline.

  inline StageTimer::Stage::Stage(StageTimer &timer, const std::size_t index)
    : timer(&timer)
    , index(index)
  {
  }


  inline StageTimer::Scope::Scope(const Stage stage)
    : stage(stage)
    , start(Clock::now())
  {
    stage.timer->begin(stage.index);
  }


  inline StageTimer::Scope::~Scope()
  {
    stage.timer->end(stage.index, start);
  }


  inline void
  StageTimer::begin(const std::size_t index)
  {
    // At the begin and not the end, so that an outer stage comes before the ones nested in it.
    if (records[index].first_use == 0)
      records[index].first_use = ++n_used;
  }


  inline void
  StageTimer::end(const std::size_t index, const Clock::time_point start)
  {
    records[index].duration += Clock::now() - start;
    ++records[index].calls;
  }
} // namespace akmon
