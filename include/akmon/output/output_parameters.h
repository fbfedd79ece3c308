#pragma once

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/point.h>

#include <cmath>
#include <string>

namespace akmon
{
  /// When something is written: every so much time, every so many steps, or both.
  struct OutputTick
  {
    double interval     = 0.; ///< time; zero: not by time
    unsigned long steps = 0;  ///< zero: not by steps

    /// Whether the tick is due at a time level; remembers the last one.
    bool
    due(const double time, const unsigned long step)
    {
      const bool by_steps = steps > 0 && step % steps == 0;
      const bool by_time  = interval > 0. && time >= next * (1. - 1e-9);
      if (by_time)
        {
          const double following = interval * (std::floor(time / interval * (1. + 1e-9)) + 1.);
          next                   = std::isfinite(following) ? following : time;
        }
      return by_steps || by_time;
    }

    double next = 0.; ///< due by time from here on
  };


  /// What a run writes. Section "Output".
  struct OutputParameters
  {
    OutputTick fields, history;
    bool deformed                 = true; ///< meshes are written in the current configuration
    double energy_error_bound     = 0.05; ///< relative; the run stops beyond
    double hourglass_energy_bound = 0.1;  ///< relative; the run stops beyond
    double penetration_bound      = 0.25; ///< over the cell size; the run stops beyond

    static void
    declare(dealii::ParameterHandler &prm);

    void
    parse(dealii::ParameterHandler &prm);
  };


  /// A node whose motion and stress enter the history. Section "Probes/NAME".
  struct Probe
  {
    std::string name;
    std::string body;
    dealii::Point<3> point; ///< initial position; the body's closest node is taken; length

    static void
    declare(dealii::ParameterHandler &prm);

    /// Throws InputError where a value is missing.
    void
    parse(dealii::ParameterHandler &prm, const std::string &section);
  };
} // namespace akmon
