#pragma once

#include <stdexcept>
#include <string>

namespace akmon
{
  /// The exit status of the program, by what ended the run. The manual lists them.
  enum class ExitStatus : int
  {
    done             = 0, ///< the end was reached and the energy balance held
    bad_input        = 1, ///< arguments, parameter file, mesh or checkpoint; nothing was computed
    inverted_cell    = 2,
    not_a_number     = 3,
    energy_error     = 4, ///< beyond its bound
    step_collapsed   = 5, ///< the automatic step fell below its bound
    lost_contact     = 6, ///< a penetration beyond its bound
    output_failed    = 7, ///< disk full or not writable; the last checkpoint is intact
    terminated       = 8, ///< by SIGTERM, after a checkpoint was written
    unexpected_error = 9
  };


  /// The run cannot go on or must not be trusted; the message has step, time and place.
  class RunError : public std::runtime_error
  {
  public:
    RunError(const ExitStatus status, const std::string &message)
      : std::runtime_error(message)
      , status(status)
    {
    }

    const ExitStatus status;
  };
} // namespace akmon
