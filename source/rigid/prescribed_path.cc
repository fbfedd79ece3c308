#include <akmon/parameters.h>
#include <akmon/rigid/prescribed_path.h>

namespace akmon
{
  using namespace dealii;

  void
  PrescribedPath::declare(ParameterHandler &prm)
  {
    const auto declare = [&](const std::string &key, const std::string &documentation) {
      SpaceTimeFunction::declare(prm, key, "0; 0; 0", documentation + ", a function of time only");
    };
    declare("Displacement", "Displacement u(t) from the initial place (length)");
    declare("Velocity", "Velocity v(t), integrated and added to the displacement (length/time)");
    declare("Rotation", "Rotation from the initial attitude, axis times angle (degrees)");
    declare("Spin", "Angular velocity omega(t), integrated, before the rotation (1/time)");
  }


  void
  PrescribedPath::parse(ParameterHandler &prm, const std::string &section)
  {
    const auto parse = [&](SpaceTimeFunction &function, const std::string &key) {
      function.parse(prm, section, key, 3);
      if (!function.uniform())
        throw InputError(section, key, prm.get(key), "allowed are functions of t only");
    };
    parse(displacement, "Displacement");
    parse(velocity, "Velocity");
    parse(rotation, "Rotation");
    parse(spin, "Spin");
    for (const char *const key : {"Displacement", "Rotation"})
      {
        const auto &function = key[0] == 'D' ? displacement : rotation;
        if (function.vector(Point<3>(), 0.).norm() > 1e-12)
          throw InputError(section, key, prm.get(key), "it must be zero at t = 0");
      }
  }


  PathFollower::PathFollower(const PrescribedPath &path, const Pose &start)
    : path(path)
    , start(start)
  {
    here.pose = ahead.pose = start;
  }


  void
  PathFollower::look_ahead(const double time, const double dt)
  {
    const Point<3> anywhere;
    const double middle = time + 0.5 * dt;
    ahead.travelled     = here.travelled + dt * path.velocity.vector(anywhere, middle);
    ahead.turned        = Orientation::about(dt * path.spin.vector(anywhere, middle)) * here.turned;
    ahead.pose.place    = start.place + path.displacement.vector(anywhere, time + dt) +
                       ahead.travelled;
    ahead.pose.orientation = Orientation::about(numbers::PI / 180. *
                                                path.rotation.vector(anywhere, time + dt)) *
                             ahead.turned * start.orientation;
  }


  void
  PathFollower::predict()
  {
    here = ahead;
  }
} // namespace akmon
