#pragma once

#include <akmon/rigid/mass_properties.h>
#include <akmon/rigid/rotation.h>

#include <array>

namespace akmon
{
  /// Increments of a body's centre (length) and of its rotation, Cayley's vector in space.
  struct RigidIncrement
  {
    dealii::Tensor<1, 3> centre, rotation;

    template <typename Visitor>
    void
    visit_state(const Visitor &visitor)
    {
      visit_numbers(centre, visitor);
      visit_numbers(rotation, visitor);
    }
  };


  /// What of its six ways to move a rigid body may use.
  struct Freedom
  {
    std::array<bool, 3> translation = {{true, true, true}}; ///< along the axes of space
    std::array<bool, 3> rotation    = {{true, true, true}}; ///< all, none, or about one axis
  };


  /**
   * The motion of a free rigid body with the time steps of Fidcd: its centre of mass moves like a
   * node, its angular momentum about the centre L (in space) by the same central differences
   *
   *     L_{n+1/2} (1/dt_bar + eta/2) = L_{n-1/2} (1/dt_bar - eta/2) + M_n,
   *
   * M_n the moment at level n. The body turns by R_{n+1} = R_n cay(T), where the rotation vector T
   * (in the body) makes the mean of the body's angular momentum at both ends I T/dt:
   *
   *     I T + (1/2) T x (I T) = dt R_n^T L_{n+1/2} .
   *
   * Without moments L (by construction) and the energy (1/2) L . I^{-1} L (Cayley's rotation of
   * R^T L about T is normal to T) are kept exactly for any step (Lewis and Simo, J. Nonlinear Sci.
   * 4, 1994).
   */
  class FreeMotion
  {
  public:
    /**
     * @param properties  inertia and centre in the body's frame
     * @param pose        of that frame at the start
     * @param velocity    of the centre of mass; length/time
     * @param spin        angular velocity; 1/time
     */
    FreeMotion(const MassProperties &properties,
               const Freedom &freedom,
               const Pose &pose,
               const dealii::Tensor<1, 3> &velocity,
               const dealii::Tensor<1, 3> &spin);

    /**
     * Free increments of the step from the starting level, by its force and its moment about the
     * centre of mass.
     * @param damping  eta, 1/time
     */
    void
    start(const dealii::Tensor<1, 3> &force,
          const dealii::Tensor<1, 3> &moment,
          const double dt,
          const double damping);

    /// Go to the next level with the increments there are.
    void
    predict();

    /// Free increments of a step dt_next from a level that a step dt has led to.
    void
    free_increment(const dealii::Tensor<1, 3> &force,
                   const dealii::Tensor<1, 3> &moment,
                   const double dt,
                   const double dt_next,
                   const double damping);

    /// Let a further force and moment about the centre act at the level. The increments change by
    /// no more than linear_response() says, to the first order in the moment.
    void
    add(const dealii::Tensor<1, 3> &force, const dealii::Tensor<1, 3> &moment);

    /// Inverse mass, zero along directions that are held: translation a unit force causes, over the
    /// effective mass factor.
    dealii::SymmetricTensor<2, 3>
    translation_mobility() const;

    /// Inverse inertia in space at the level, zero about axes that are held.
    dealii::SymmetricTensor<2, 3>
    rotation_mobility() const;

    /// Of the body's frame at the level.
    const Pose &
    pose() const
    {
      return frame;
    }

    /// Of the body's frame at the next level.
    Pose
    next_pose() const;

    /// The same after forces that, to the first order, add @p response to the increments.
    Pose
    next_pose(const RigidIncrement &response) const;

    /// Centre of mass at the level; length.
    dealii::Tensor<1, 3>
    centre() const;

    /// Forward increments.
    const RigidIncrement &
    next() const
    {
      return ahead;
    }

    /**
     * What the level's force and moment work with, before and after the level: increments of the
     * centre, and dt I^{-1} L_{n -+ 1/2} at the orientation of the level. With them the change of
     * kinetic_energy() over equal steps is the work by the trapezoidal rule exactly, see Fidcd.
     */
    const RigidIncrement &
    work_before() const
    {
      return before;
    }

    const RigidIncrement &
    work_after() const
    {
      return after;
    }

    /// Velocity of the centre at the level; length/time.
    dealii::Tensor<1, 3>
    velocity() const;

    /// Angular velocity at the level; 1/time.
    dealii::Tensor<1, 3>
    spin() const;

    double
    mass() const
    {
      return properties.mass;
    }

    /// Linear momentum, and angular momentum about the origin.
    dealii::Tensor<1, 3>
    momentum() const;
    dealii::Tensor<1, 3>
    angular_momentum() const;

    /// In the form of Fidcd::kinetic_energy().
    double
    kinetic_energy() const;

    /// -eta (m v . increment of the centre + L . increment of the rotation); energy.
    double
    damping_work(const RigidIncrement &increment) const;

    /// Calls visitor(number) for all numbers that change with time; numbers may be set.
    template <typename Visitor>
    void
    visit_state(const Visitor &visitor)
    {
      frame.visit_state(visitor);
      for (double *const number : {&dt, &dt_next, &damping, &divisor})
        visitor(*number);
      double starts = starting ? 1. : 0.;
      visitor(starts);
      starting = starts != 0.;
      for (auto *const v : {&momentum_before, &momentum_after, &turning_before, &turning_after})
        visit_numbers(*v, visitor);
      for (auto *const increment : {&ahead, &before, &after})
        increment->visit_state(visitor);
    }

  private:
    void
    set_increments();
    dealii::Tensor<1, 3>
    rotation_vector() const;
    dealii::Tensor<1, 3>
    held(const dealii::Tensor<1, 3> &v, const std::array<bool, 3> &free) const;
    dealii::Tensor<2, 3>
    rotation() const
    {
      return frame.orientation.matrix();
    }

    const MassProperties properties;
    const Freedom freedom;
    unsigned int n_rotations;                      ///< that are free
    dealii::Tensor<2, 3> inertia, inverse_inertia; ///< in the body's frame

    Pose frame;
    double dt = 0., dt_next = 0., damping = 0.;
    double divisor = 1.; ///< 1/dt_bar + eta/2; 2/dt at the start
    bool starting  = true;
    dealii::Tensor<1, 3> momentum_before, momentum_after; ///< linear, at n -+ 1/2
    dealii::Tensor<1, 3> turning_before, turning_after;   ///< angular about the centre, in space
    RigidIncrement ahead, before, after;
  };
} // namespace akmon
