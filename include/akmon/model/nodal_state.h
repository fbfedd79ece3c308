#pragma once

#include <akmon/checkpoint/checkpoint.h>
#include <akmon/model/discretization.h>

namespace akmon
{
  /**
   * The motion at a time level, called n here. Velocity and acceleration are no unknowns of their
   * own: they follow from the two increments around the level, see Fidcd.
   */
  struct NodalState
  {
    explicit NodalState(const Discretization &discretization)
      : x(discretization.reference)
      , dx(discretization.make_vector())
      , dx_next(discretization.make_vector())
      , force(discretization.make_vector())
    {
      x.update_ghost_values(); // a copy has the owned entries only
    }

    double time        = 0.; ///< t_n
    double dt          = 0.; ///< t_n - t_{n-1}
    double dt_next     = 0.; ///< t_{n+1} - t_n
    unsigned long step = 0;  ///< n

    NodalVector x;       ///< positions x_n, ghosted; length
    NodalVector dx;      ///< increment that led here, x_n - x_{n-1}, ghosted; length
    NodalVector dx_next; ///< forward increment x_{n+1} - x_n; length
    NodalVector force;   ///< forces at n but for contact and reactions, owned entries only

    /// All but the forces, which every step finds anew; nodes in global order (collective).
    void
    save(CheckpointWriter &checkpoint) const;

    /// Take the owned nodes' values from a checkpoint and exchange the ghosts' (collective).
    void
    restore(const CheckpointReader &checkpoint);
  };
} // namespace akmon
