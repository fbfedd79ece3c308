#include <akmon/rigid/rigid_body.h>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    std::optional<FreeMotion>
    make_free(const Obstacle &obstacle)
    {
      if (obstacle.motion != Obstacle::Motion::free)
        return {};
      return FreeMotion(obstacle.free.properties,
                        obstacle.free.freedom,
                        obstacle.start,
                        obstacle.free.velocity,
                        obstacle.free.spin);
    }


    std::optional<PathFollower>
    make_follower(const Obstacle &obstacle)
    {
      if (obstacle.motion != Obstacle::Motion::prescribed)
        return {};
      return PathFollower(obstacle.path, obstacle.start);
    }


    RigidIncrement
    between(const Pose &from, const Pose &to)
    {
      return {to.place - from.place, (to.orientation * from.orientation.inverse()).cayley_vector()};
    }
  } // namespace


  RigidBody::RigidBody(const Obstacle &obstacle, const SpaceTimeFunction &gravity)
    : obstacle(obstacle)
    , gravity(gravity)
    , free(make_free(obstacle))
    , follower(make_follower(obstacle))
    , start_centre(centre())
  {
  }


  void
  RigidBody::choose_load(const double time)
  {
    const Point<3> at(start_centre);
    load.force  = free->mass() * gravity.vector(at, time) + obstacle.free.force.vector(at, time);
    load.moment = obstacle.free.moment.vector(at, time);
  }


  void
  RigidBody::start(const double step, const double damping)
  {
    dt = dt_next = step;
    if (free)
      {
        choose_load(0.);
        free->start(load.force, load.moment, step, damping);
      }
    if (follower)
      {
        follower->look_ahead(0., step);
        last = next();
      }
  }


  void
  RigidBody::predict()
  {
    if (free)
      free->predict();
    if (follower)
      {
        last = next();
        follower->predict();
      }
    normal_load = tangential_load = Load();
  }


  void
  RigidBody::free_increment(const double time,
                            const double step,
                            const double next_step,
                            const double damping)
  {
    dt      = step;
    dt_next = next_step;
    if (free)
      {
        choose_load(time);
        free->free_increment(load.force, load.moment, dt, dt_next, damping);
      }
    if (follower)
      follower->look_ahead(time, dt_next);
  }


  void
  RigidBody::add_contact(const Load &normal, const Load &tangential)
  {
    normal_load     = normal;
    tangential_load = tangential;
    if (free)
      free->add(normal.force + tangential.force, normal.moment + tangential.moment);
  }


  const Pose &
  RigidBody::pose() const
  {
    return free ? free->pose() : follower ? follower->pose() : obstacle.start;
  }


  Pose
  RigidBody::next_pose(const RigidIncrement &response) const
  {
    return free ? free->next_pose(response) : follower ? follower->next_pose() : obstacle.start;
  }


  Tensor<1, 3>
  RigidBody::centre() const
  {
    return free ? free->centre() : pose().place;
  }


  RigidIncrement
  RigidBody::next() const
  {
    return free     ? free->next() :
           follower ? between(follower->pose(), follower->next_pose()) :
                      RigidIncrement();
  }


  SymmetricTensor<2, 3>
  RigidBody::translation_mobility() const
  {
    return free ? free->translation_mobility() : SymmetricTensor<2, 3>();
  }


  SymmetricTensor<2, 3>
  RigidBody::rotation_mobility() const
  {
    return free ? free->rotation_mobility() : SymmetricTensor<2, 3>();
  }


  RigidIncrement
  RigidBody::increment_before() const
  {
    return free ? free->work_before() : last;
  }


  RigidIncrement
  RigidBody::increment_after() const
  {
    return free ? free->work_after() : next();
  }


  Tensor<1, 3>
  RigidBody::displacement() const
  {
    return centre() - start_centre;
  }


  Tensor<1, 3>
  RigidBody::rotation() const
  {
    return (pose().orientation * obstacle.start.orientation.inverse()).rotation_vector();
  }


  Tensor<1, 3>
  RigidBody::velocity() const
  {
    return 0.5 * (increment_before().centre / dt + increment_after().centre / dt_next);
  }


  Tensor<1, 3>
  RigidBody::spin() const
  {
    return 0.5 * (increment_before().rotation / dt + increment_after().rotation / dt_next);
  }


  Tensor<1, 3>
  RigidBody::momentum() const
  {
    return free ? free->momentum() : Tensor<1, 3>();
  }


  Tensor<1, 3>
  RigidBody::angular_momentum() const
  {
    return free ? free->angular_momentum() : Tensor<1, 3>();
  }


  double
  RigidBody::kinetic_energy() const
  {
    return free ? free->kinetic_energy() : 0.;
  }


  // What moves a prescribed body does the opposite of the work of the contact forces on it.
  RigidBody::Work
  RigidBody::work(const RigidIncrement &increment) const
  {
    Work result;
    if (free)
      {
        result.external = load.work(increment);
        result.damping  = -free->damping_work(increment);
      }
    else
      result.external = -normal_load.work(increment) - tangential_load.work(increment);
    return result;
  }
} // namespace akmon
