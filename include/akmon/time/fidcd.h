#pragma once

#include <akmon/model/nodal_state.h>

#include <limits>

namespace akmon
{
  /**
   * Forward incremental displacement central differences (28)-(35), written for steps of varying
   * size: with dt = t_n - t_{n-1}, dt' = t_{n+1} - t_n and dt_bar = (dt + dt')/2,
   *
   *     v~ = dx_{n-1}/(2 dt),   a~ = -dx_{n-1}/(dt dt_bar) (31)(32) m (1/(dt' dt_bar) + eta/(2
   * dt')) dx_n = F_n - m a~ - m eta v~                          (33) v_n = v~ + dx_n/(2 dt'),   a_n
   * = a~ + dx_n/(dt' dt_bar)                              (34)(35)
   *
   * which are the paper's equations where dt = dt' (with its n+1 called n here). The starting step
   * (28)(29) is the same with dx_{-1} = 2 dt v_0 - dx_0.
   */
  class Fidcd
  {
  public:
    /**
     * @param damping      mass-proportional damping rate eta, 1/time
     * @param damping_end  time from which on eta is zero
     */
    Fidcd(const Discretization &discretization,
          NodalState &state,
          const double damping,
          const double damping_end = std::numeric_limits<double>::infinity());

    /// eta at the level; 1/time.
    double
    damping_rate() const
    {
      return state.time < damping_end ? damping : 0.;
    }

    /// Free increment of the starting step (28), from F_0 in state.force and v_0 in @p velocity.
    void
    start(const NodalVector &velocity, const double dt);

    /// Close the starting step once dx_0 is final: makes velocity() at n = 0 the given v_0.
    void
    finish_start(const NodalVector &velocity);

    /// Go to the next time level: x_{n+1} = x_n + dx_n (30), on owned and ghost nodes.
    void
    predict();

    /// dx_f of (46): state.dx_next without contact, for the step state.dt_next.
    void
    free_increment();

    /// 1/(dt' dt_bar) + eta/(2 dt'), or 2/dt^2 in the starting step: m* = m times this (65).
    double
    effective_mass_factor() const
    {
      return mass_factor;
    }

    /// v_n (34) at an owned node once dx_next is final; length/time.
    dealii::Tensor<1, 3>
    velocity(const unsigned int node) const
    {
      return 0.5 *
             (at_node(state.dx, node) / state.dt + at_node(state.dx_next, node) / state.dt_next);
    }

    /**
     * Kinetic energy of the owned nodes; at the start (1/2) m v_0^2, then
     *
     *     (1/2) m (v*^2 - dt dt' a_n^2/4),   v* = (dt' v_{n-1/2} + dt v_{n+1/2})/(dt + dt'),
     *
     * which is (1/2) m v_{n-1/2} . v_{n+1/2} for equal steps. This form makes the change of kinetic
     * energy over any number of equal steps exactly the work of the forces by the trapezoidal rule,
     * sum (F_n + F_{n+1})/2 . dx_n, whatever the forces do.
     */
    double
    kinetic_energy() const;

    /// - m eta v_n . increment, summed over the owned nodes: work of the damping forces; energy.
    double
    damping_work(const NodalVector &increment) const;

  private:
    const Discretization &discretization;
    NodalState &state;
    const double damping, damping_end;
    double mass_factor = 0.;
  };
} // namespace akmon
