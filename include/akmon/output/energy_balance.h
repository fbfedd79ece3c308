#pragma once

#include <array>

namespace akmon
{
  /**
   * The works of the forces on a rank up to a time level, by the trapezoidal rule
   * W_n = sum_{k<n} (F_k + F_{k+1})/2 . dx_k, which is what the kinetic energy of central
   * differences answers to exactly (Fidcd::kinetic_energy). A level gives half its force to the
   * increment that led to it, half to the next one.
   */
  class WorkLine
  {
  public:
    /**
     * @param before  work of the level's force through the increment that led there
     * @param after   work of the same force through the forward increment
     */
    void
    add_level(const double before, const double after)
    {
      at_level = carried + 0.5 * before;
      carried  = at_level + 0.5 * after;
    }

    /**
     * The starting level, whose step changes the velocity from v_0 to v_{1/2}: the force works over
     * half a step at the mean velocity (v_0 + v_{1/2})/2. With dx_{-1} = 2 dt v_0 - dx_0 that is F
     * . (dx_{-1} + 3 dx_0)/8.
     */
    void
    add_start(const double before, const double after)
    {
      at_level = 0.;
      carried  = (before + 3. * after) / 8.;
    }

    /// What the line consists of, for checkpoints.
    std::array<double, 2>
    parts() const
    {
      return {{at_level, carried}};
    }

    void
    continue_from(const std::array<double, 2> &parts)
    {
      at_level = parts[0];
      carried  = parts[1];
    }

    /// Work up to the level; energy.
    double
    value() const
    {
      return at_level;
    }

    double at_level = 0., carried = 0.;
  };


  /// The energies of all bodies at a time level, summed over ranks; energy.
  struct EnergyBalance
  {
    double kinetic              = 0.;
    double strain               = 0.; ///< time integral of the elastic stress power
    double plastic_dissipation  = 0.;
    double damping_dissipation  = 0.;
    double friction_dissipation = 0.;
    double
      impact_dissipation = 0.; ///< kinetic energy of striking nodes that exact enforcement takes
    double hourglass     = 0.; ///< work against hourglass control
    double contact       = 0.; ///< elastic energy of penalty springs
    double bond          = 0.; ///< taken by bonds that fail
    double external_work = 0.; ///< of loads and prescribed motions

    /// What must stay the same.
    double
    sum() const
    {
      return kinetic + strain + plastic_dissipation + damping_dissipation + friction_dissipation +
             impact_dissipation + hourglass + contact + bond - external_work;
    }
  };
} // namespace akmon
