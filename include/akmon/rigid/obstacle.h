#pragma once

#include <akmon/contact/contact_parameters.h>
#include <akmon/rigid/free_motion.h>
#include <akmon/rigid/prescribed_path.h>
#include <akmon/rigid/rigid_shape.h>

#include <deal.II/base/parameter_handler.h>

#include <memory>
#include <string>
#include <vector>

namespace akmon
{
  /// How a free rigid body starts and what acts on it. Section "Obstacles/NAME/Free".
  struct FreeStart
  {
    MassProperties properties;
    Freedom freedom;
    dealii::Tensor<1, 3> velocity; ///< of the centre of mass; length/time
    dealii::Tensor<1, 3> spin;     ///< 1/time
    SpaceTimeFunction force;       ///< at the centre of mass; force
    SpaceTimeFunction moment;      ///< about the centre of mass, in space; force length

    static void
    declare(dealii::ParameterHandler &prm);

    /// Throws InputError for a mass or inertia that no body can have.
    void
    parse(dealii::ParameterHandler &prm, const std::string &section, const RigidShape &shape);
  };


  /**
   * A rigid obstacle or tool that boundary parts of bodies may hit: fixed, moved by functions of
   * time, or free. Section "Obstacles/NAME".
   */
  struct Obstacle : ContactLaw
  {
    enum class Motion
    {
      fixed,
      prescribed,
      free
    };

    std::shared_ptr<const RigidShape> shape;
    std::vector<std::string> repairs; ///< what had to be repaired in its surface, a line each
    Pose start;
    double edge_angle = 0.; ///< edges that turn by more are sharp; radians
    Motion motion     = Motion::fixed;
    PrescribedPath path;                ///< if prescribed
    FreeStart free;                     ///< if free
    std::vector<std::string> obstacles; ///< names of those it may hit itself

    static void
    declare(dealii::ParameterHandler &prm);

    /// Throws InputError where a value is missing or inadmissible.
    void
    parse(dealii::ParameterHandler &prm, const std::string &section);
  };
} // namespace akmon
