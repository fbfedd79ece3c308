#pragma once

#include <akmon/forces/external_forces.h>
#include <akmon/rigid/obstacle.h>

#include <optional>

namespace akmon
{
  /**
   * An obstacle in its motion: where it is, where it goes in this step, and what contact does to
   * it. Its motion is that of a centre (the centre of mass if it is free, else the origin of its
   * frame) and a rotation; the same on all ranks.
   */
  class RigidBody
  {
  public:
    /// @param gravity  body force per mass
    RigidBody(const Obstacle &obstacle, const SpaceTimeFunction &gravity);

    bool
    moves() const
    {
      return obstacle.motion != Obstacle::Motion::fixed;
    }

    bool
    is_free() const
    {
      return free.has_value();
    }

    const Obstacle &
    parameters() const
    {
      return obstacle;
    }

    /// The starting step: increments without contact, from the level at time zero.
    void
    start(const double dt, const double damping);

    /// Go to the next level.
    void
    predict();

    /// Increments of the step without contact.
    void
    free_increment(const double time, const double dt, const double dt_next, const double damping);

    /// A force on the body at a point in space: its sum and its moment about the centre.
    struct Load
    {
      dealii::Tensor<1, 3> force, moment;

      void
      add(const dealii::Tensor<1, 3> &f, const dealii::Tensor<1, 3> &arm)
      {
        force += f;
        moment += cross_product_3d(arm, f);
      }

      double
      work(const RigidIncrement &increment) const
      {
        return force * increment.centre + moment * increment.rotation;
      }
    };

    /// Contact's part of the step, which completes the increments.
    void
    add_contact(const Load &normal, const Load &tangential);

    const Pose &
    pose() const;

    /// At the next level, after contact forces that to the first order add the response.
    Pose
    next_pose(const RigidIncrement &response) const;

    /// At the next level.
    Pose
    next_pose() const
    {
      return next_pose(RigidIncrement());
    }

    dealii::Tensor<1, 3>
    centre() const;

    /// Increments of the step as far as they are known.
    RigidIncrement
    next() const;

    /// Increments a unit force and a unit moment cause, times the effective mass factor.
    dealii::SymmetricTensor<2, 3>
    translation_mobility() const;
    dealii::SymmetricTensor<2, 3>
    rotation_mobility() const;

    /// Of the centre since the start; length.
    dealii::Tensor<1, 3>
    displacement() const;
    /// Since the start, about the vector by its length; radians, at most pi.
    dealii::Tensor<1, 3>
    rotation() const;
    dealii::Tensor<1, 3>
    velocity() const;
    dealii::Tensor<1, 3>
    spin() const;

    /// Momenta and energy of a free body; zero of others.
    dealii::Tensor<1, 3>
    momentum() const;
    dealii::Tensor<1, 3>
    angular_momentum() const;
    double
    kinetic_energy() const;

    /// Works of the level's forces through the increment before the level and the one after it.
    struct Work
    {
      double external = 0.; ///< of gravity and loads; of what moves a prescribed body
      double damping  = 0.; ///< taken by it
    };

    Work
    work_before() const
    {
      return work(increment_before());
    }

    Work
    work_after() const
    {
      return work(increment_after());
    }

    RigidIncrement
    increment_before() const;
    RigidIncrement
    increment_after() const;

    /// Calls visitor(number) for all numbers that change with time; numbers may be set.
    template <typename Visitor>
    void
    visit_state(const Visitor &visitor)
    {
      if (free)
        free->visit_state(visitor);
      if (follower)
        follower->visit_state(visitor);
      visitor(dt);
      visitor(dt_next);
      for (Load *const of : {&load, &normal_load, &tangential_load})
        {
          visit_numbers(of->force, visitor);
          visit_numbers(of->moment, visitor);
        }
      last.visit_state(visitor);
    }

  private:
    Work
    work(const RigidIncrement &increment) const;
    void
    choose_load(const double time);

    const Obstacle &obstacle;
    const SpaceTimeFunction &gravity;
    std::optional<FreeMotion> free;
    std::optional<PathFollower> follower;
    const dealii::Tensor<1, 3> start_centre;
    double dt = 1., dt_next = 1.;
    Load load, normal_load, tangential_load;
    RigidIncrement last; ///< that led a prescribed body here
  };
} // namespace akmon
