#include <akmon/parameters.h>
#include <akmon/time/step_control.h>

#include <cmath>
#include <limits>

namespace akmon
{
  namespace
  {
    // Sums of steps reach the end time up to rounding only.
    constexpr double rounding = 1e-9;
  } // namespace


  void
  StepControl::declare(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("End",
                      "0",
                      dealii::Patterns::Double(0.),
                      "Time at which the run ends (time)");
    prm.declare_entry(
      "Step",
      "automatic",
      dealii::Patterns::Anything(),
      "Time step dt (time), or 'automatic': the safety factor times the critical step "
      "2/omega_max, estimated anew every step");
    prm
      .declare_entry("Critical step",
                     "cells",
                     dealii::Patterns::Selection("cells|assembled"),
                     "Whose largest frequency omega_max bounds the step: that of the cells taken "
                     "alone, or of the assembled system, which is smaller but has to be estimated: "
                     "worth it in runs of thousands of steps");
    prm.declare_entry("Safety factor",
                      "0.9",
                      dealii::Patterns::Double(0., 1.),
                      "Automatic step over critical step (dimensionless)");
    prm.declare_entry("Smallest step",
                      "1e-3",
                      dealii::Patterns::Double(0., 1.),
                      "The run stops, or cells are eroded, when the critical step falls below this "
                      "part of the first one (dimensionless)");
    prm.declare_entry("Mass scaling step",
                      "0",
                      dealii::Patterns::Double(0.),
                      "Cells that do not allow this step in the initial configuration are made "
                      "heavier until they do (time); 0: none are");
    prm.declare_entry("Allow unstable step",
                      "false",
                      dealii::Patterns::Bool(),
                      "Accept a fixed step above the critical one");
  }


  void
  StepControl::parse(dealii::ParameterHandler &prm)
  {
    end           = prm.get_double("End");
    safety_factor = prm.get_double("Safety factor");
    smallest      = prm.get_double("Smallest step");
    scaled_step   = prm.get_double("Mass scaling step");
    assembled     = prm.get("Critical step") == "assembled";
    unstable      = prm.get_bool("Allow unstable step");
    if (!(end > 0.))
      throw InputError("Time", "End", prm.get("End"), "allowed are positive numbers");
    if (!(safety_factor > 0.))
      throw InputError("Time",
                       "Safety factor",
                       prm.get("Safety factor"),
                       "allowed are 0 < factor <= 1");
    const std::string step = prm.get("Step");
    if (step == "automatic")
      return;
    std::size_t used = 0;
    try
      {
        fixed_step = std::stod(step, &used);
      }
    catch (const std::exception &)
      {
      }
    if (used != step.size() || !(fixed_step > 0.) || !std::isfinite(fixed_step))
      throw InputError("Time", "Step", step, "allowed are positive numbers or 'automatic'");
  }


  double
  StepControl::choose(const double t, const double largest_frequency_squared) const
  {
    const double rest = end - t;
    if (!automatic())
      return rest > rounding * fixed_step && rest < fixed_step * (1. + rounding) ? rest :
                                                                                   fixed_step;
    // Central differences keep an energy that depends on the step: a last step of a tenth of the
    // others would show what no step showed before it.
    constexpr double sharing = 100.;
    const double step        = safety_factor * 2. / std::sqrt(largest_frequency_squared);
    if (rest <= rounding * step || rest >= sharing * step)
      return step;
    return rest / std::ceil(rest / step * (1. - rounding));
  }


  double
  StepControl::mass_scaling_limit() const
  {
    if (scaled_step == 0.)
      return std::numeric_limits<double>::infinity();
    const double omega = (automatic() ? safety_factor : 1.) * 2. / scaled_step;
    return omega * omega;
  }


  bool
  StepControl::finished(const double t) const
  {
    return t >= end * (1. - 1e-12);
  }
} // namespace akmon
