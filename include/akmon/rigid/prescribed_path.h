#pragma once

#include <akmon/model/vector_function.h>
#include <akmon/rigid/rotation.h>

namespace akmon
{
  /**
   * A rigid motion as a function of time, about the point where the body's frame starts:
   * displacement functions and integrated velocities add up, and a rotation vector turns what the
   * integrated spin has turned.
   */
  struct PrescribedPath
  {
    SpaceTimeFunction displacement; ///< length
    SpaceTimeFunction velocity;     ///< length/time
    SpaceTimeFunction rotation;     ///< axis times angle, degrees
    SpaceTimeFunction spin;         ///< angular velocity in space, 1/time

    static void
    declare(dealii::ParameterHandler &prm);

    /// Throws InputError for functions that depend on position or do not start from zero.
    void
    parse(dealii::ParameterHandler &prm, const std::string &section);
  };


  /// The motion of a body along a path, step by step.
  class PathFollower
  {
  public:
    /// @param start  pose at time zero
    PathFollower(const PrescribedPath &path, const Pose &start);

    /**
     * Choose the step from the level at @p time; velocity and spin count with their value in its
     * middle.
     */
    void
    look_ahead(const double time, const double dt);

    /// Go to the next level.
    void
    predict();

    const Pose &
    pose() const
    {
      return here.pose;
    }

    const Pose &
    next_pose() const
    {
      return ahead.pose;
    }

    /// Calls visitor(number) for all numbers that change with time; numbers may be set.
    template <typename Visitor>
    void
    visit_state(const Visitor &visitor)
    {
      here.visit_state(visitor);
      ahead.visit_state(visitor);
    }

  private:
    struct Level
    {
      Pose pose;
      dealii::Tensor<1, 3> travelled; ///< integrated velocity
      Orientation turned;             ///< integrated spin

      template <typename Visitor>
      void
      visit_state(const Visitor &visitor)
      {
        pose.visit_state(visitor);
        visit_numbers(travelled, visitor);
        turned.visit_state(visitor);
      }
    };

    const PrescribedPath &path;
    const Pose start;
    Level here, ahead;
  };
} // namespace akmon
