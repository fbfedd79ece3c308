#pragma once

#include <deal.II/base/parameter_handler.h>

namespace akmon
{
  /**
   * The size of the time steps: fixed, or a safety factor times the critical step 2/omega_max.
   * Section "Time".
   */
  struct StepControl
  {
    double end           = 0.; ///< time at which the run ends
    double fixed_step    = 0.; ///< zero: automatic
    double safety_factor = 0.9;
    double smallest      = 1e-3;  ///< of the automatic step, over the critical one of the start
    double scaled_step   = 0.;    ///< for which cells are made heavier; zero: none are
    bool assembled       = false; ///< omega_max of the assembled system, not of its cells
    bool unstable        = false; ///< a fixed step above the critical one is accepted

    static void
    declare(dealii::ParameterHandler &prm);

    /// Throws InputError where a value is missing or inadmissible.
    void
    parse(dealii::ParameterHandler &prm);

    bool
    automatic() const
    {
      return fixed_step == 0.;
    }

    /**
     * The step from time @p t on. The last step ends at `end` exactly; an automatic run shares the
     * rest among its last hundred steps, so that none is much smaller than those before.
     * @param largest_frequency_squared  omega_max^2 over all ranks, 1/time^2
     * @param cuts_fixed  a fixed step above the critical one gives way to the automatic one
     */
    double
    choose(const double t,
           const double largest_frequency_squared,
           const bool cuts_fixed = false) const;

    /// omega^2 beyond which cells are made heavier, 1/time^2; infinite without mass scaling.
    double
    mass_scaling_limit() const;

    /// Whether the run has reached its end at time t.
    bool
    finished(const double t) const;
  };
} // namespace akmon
