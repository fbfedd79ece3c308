#pragma once

#include <akmon/output/stage_timer.h>

#include <deal.II/base/mpi.h>

#include <chrono>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace akmon
{
  /// Where a run stands, for the progress line. Times are physical, in the units of the run.
  struct Progress
  {
    double time                  = 0; ///< time reached
    double end                   = 0; ///< time at which the run ends
    double dt                    = 0; ///< last step
    unsigned long step           = 0; ///< steps done
    unsigned int active_pairs    = 0; ///< contact pairs that carry a force
    double penetration_rel       = 0; ///< largest penetration over the local cell size h
    double energy_error          = 0; ///< relative to the largest energy so far
    double cell_steps_per_second = 0; ///< cells times steps over wall seconds
  };

  /**
   * What the user sees while a run goes on. Only rank 0 prints; every function may be called on all
   * ranks and none communicates. A quiet screen prints warnings only.
   */
  class Screen
  {
  public:
    /// Print to standard output, refreshing the progress line if that is a terminal.
    Screen(const MPI_Comm comm, const bool quiet);

    /// Print to this stream, as to a terminal or not; the stream must outlive the screen.
    Screen(const MPI_Comm comm, const bool quiet, std::ostream &out, const bool terminal);

    /// Ends a progress line still open, so that what others print starts on a line of its own.
    ~Screen();

    Screen(const Screen &) = delete;
    Screen &
    operator=(const Screen &) = delete;

    /// Rows of name and value ("cells", "12000"), the values below each other.
    void
    header(const std::vector<std::pair<std::string, std::string>> &rows);

    /**
     * Show where the run stands; call it in every step. On a terminal one line is refreshed up to
     * five times a second, elsewhere a line is added for every tenth of the time span. The end of
     * the run is always shown.
     */
    void
    progress(const Progress &state);

    /// A line of text; the progress line continues below it.
    void
    message(const std::string &text);

    /// A line of text that is shown even by a quiet screen, and kept for the summary.
    void
    warning(const std::string &text);

    /// Take over the warnings (lines) of an earlier part of the run without showing them again.
    void
    recall(const std::string &earlier);

    /// Whether there has been a warning with a text in it.
    bool
    has_warned_of(const std::string &text) const;

    /// The warnings given on this rank so far.
    const std::vector<std::string> &
    warnings() const;

    /// The table of stages, with seconds as parts of the wall seconds of the whole run.
    void
    closing(const std::vector<StageTimer::Total> &stages, const double total_seconds);

  private:
    using Clock = std::chrono::steady_clock;

    bool
    is_due(const Progress &state, const Clock::time_point now);

    double
    seconds_left(const Progress &state, const Clock::time_point now) const;

    void
    refresh(std::string line);

    void
    print_above_progress(const std::string &text);

    void
    end_progress_line();

    std::ostream &out;
    const bool root;
    const bool quiet;
    const bool terminal;
    std::vector<std::string> given_warnings;
    std::size_t open_length = 0; // of the progress line the cursor stands behind

    // The run as first seen here: after a restart it did not start at time zero.
    bool started      = false;
    double first_time = 0;
    Clock::time_point first_wall;
    Clock::time_point last_refresh;
    unsigned int last_tenth = 0;
  };
} // namespace akmon
