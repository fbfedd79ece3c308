#include <akmon/output/screen.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <sstream>
#include <sys/ioctl.h>
#include <unistd.h>

namespace akmon
{
  namespace
  {
    constexpr std::chrono::milliseconds refresh_interval(200);


    template <typename... Values>
    std::string
    format(const char *pattern, const Values... values)
    {
      char text[256];
      std::snprintf(text, sizeof(text), pattern, values...);
      return text;
    }


    std::string
    clock_text(const double seconds)
    {
      // Before the first rate is known, and when a run stalls, there is no honest estimate.
      constexpr double longest = 1000. * 3600;
      if (!(seconds < longest))
        return "--:--:--";
      const auto whole = static_cast<unsigned int>(std::ceil(seconds));
      return format("%u:%02u:%02u", whole / 3600, whole / 60 % 60, whole % 60);
    }


    double
    fraction_done(const Progress &state)
    {
      return state.end > 0 ? std::clamp(state.time / state.end, 0., 1.) : 1.;
    }


    std::string
    progress_line(const Progress &state, const double seconds_left)
    {
      // What matters most comes first: a narrow terminal shows the start of the line only.
      return format("%5.1f %%  ETA %s  t %.4e  dt %.2e  contacts %u  penetration/h %.1e  "
                    "energy error %.1e  %.2f Mcell-steps/s  step %lu",
                    100. * fraction_done(state),
                    clock_text(seconds_left).c_str(),
                    state.time,
                    state.dt,
                    state.active_pairs,
                    state.penetration_rel,
                    state.energy_error,
                    1e-6 * state.cell_steps_per_second,
                    state.step);
    }


    /// Columns of the terminal behind standard output, 0 if unknown.
    unsigned int
    terminal_columns()
    {
      winsize size;
      return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
    }
  } // namespace


  Screen::Screen(const MPI_Comm comm, const bool quiet)
    : Screen(comm, quiet, std::cout, isatty(STDOUT_FILENO) == 1)
  {
  }


  Screen::Screen(const MPI_Comm comm, const bool quiet, std::ostream &out, const bool terminal)
    : out(out)
    , root(dealii::Utilities::MPI::this_mpi_process(comm) == 0)
    , quiet(quiet)
    , terminal(terminal)
  {
  }


  Screen::~Screen()
  {
    end_progress_line();
  }


  void
  Screen::header(const std::vector<std::pair<std::string, std::string>> &rows)
  {
    if (!root || quiet)
      return;
    std::size_t width = 0;
    for (const auto &row : rows)
      width = std::max(width, row.first.size());
    for (const auto &[name, value] : rows)
      out << "  " << name << std::string(width - name.size() + 2, ' ') << value << '\n';
    out << std::flush;
  }


  void
  Screen::progress(const Progress &state)
  {
    if (!root || quiet)
      return;
    const auto now = Clock::now();
    if (!is_due(state, now))
      return;
    const std::string line = progress_line(state, seconds_left(state, now));
    if (terminal)
      refresh(line);
    else
      out << line << std::endl;
  }


  bool
  Screen::is_due(const Progress &state, const Clock::time_point now)
  {
    const bool first = !started;
    if (first)
      {
        started    = true;
        first_time = state.time;
        first_wall = now;
      }
    if (terminal)
      {
        if (!first && now - last_refresh < refresh_interval && state.time < state.end)
          return false;
        last_refresh = now;
        return true;
      }
    // A sum of steps may miss the exact tenth by rounding.
    const auto tenth = static_cast<unsigned int>(10. * fraction_done(state) + 1e-9);
    if (tenth <= last_tenth)
      return false;
    last_tenth = tenth;
    return true;
  }


  double
  Screen::seconds_left(const Progress &state, const Clock::time_point now) const
  {
    const double wall = std::chrono::duration<double>(now - first_wall).count();
    const double left = std::max(state.end - state.time, 0.);
    return left == 0 ? 0. : left / (state.time - first_time) * wall;
  }


  void
  Screen::refresh(std::string line)
  {
    // A line longer than the terminal would wrap, and the carriage return reach its last part only.
    const unsigned int columns = &out == &std::cout ? terminal_columns() : 0;
    if (columns > 0 && line.size() >= columns)
      line.resize(columns - 1);
    const std::size_t rest = open_length > line.size() ? open_length - line.size() : 0;
    out << '\r' << line << std::string(rest, ' ') << std::string(rest, '\b') << std::flush;
    open_length = line.size();
  }


  void
  Screen::print_above_progress(const std::string &text)
  {
    if (open_length > 0)
      out << '\r' << std::string(open_length, ' ') << '\r';
    open_length = 0;
    out << text << std::endl;
  }


  void
  Screen::message(const std::string &text)
  {
    if (root && !quiet)
      print_above_progress(text);
  }


  void
  Screen::warning(const std::string &text)
  {
    given_warnings.push_back(text);
    if (root)
      print_above_progress("Warning: " + text);
  }


  void
  Screen::recall(const std::string &earlier)
  {
    std::istringstream lines(earlier);
    for (std::string line; std::getline(lines, line);)
      given_warnings.push_back(line);
  }


  bool
  Screen::has_warned_of(const std::string &text) const
  {
    return std::any_of(given_warnings.begin(), given_warnings.end(), [&](const auto &warning) {
      return warning.find(text) != std::string::npos;
    });
  }


  const std::vector<std::string> &
  Screen::warnings() const
  {
    return given_warnings;
  }


  void
  Screen::closing(const std::vector<StageTimer::Total> &stages, const double total_seconds)
  {
    if (!root || quiet)
      return;
    end_progress_line();
    std::size_t width = std::string("stage").size();
    for (const auto &stage : stages)
      width = std::max(width, stage.name.size());
    const auto padded = [width](const std::string &name) {
      return "  " + name + std::string(width - name.size(), ' ');
    };

    out << '\n' << padded("stage") << "     seconds   percent       calls   slowest/mean\n";
    for (const auto &stage : stages)
      out << padded(stage.name)
          << format("  %10.3f  %8.1f  %10lu  %13.2f\n",
                    stage.seconds,
                    total_seconds > 0 ? 100. * stage.seconds / total_seconds : 0.,
                    stage.calls,
                    stage.imbalance);
    out << padded("total") << format("  %10.3f  %8.1f", total_seconds, 100.) << std::endl;
  }


  void
  Screen::end_progress_line()
  {
    if (open_length > 0)
      out << std::endl;
    open_length = 0;
  }
} // namespace akmon
