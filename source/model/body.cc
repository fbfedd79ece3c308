#include <akmon/model/body.h>
#include <akmon/parameters.h>

#include <deal.II/base/numbers.h>
#include <deal.II/physics/transformations.h>

namespace akmon
{
  void
  Body::declare(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Material",
                      "",
                      dealii::Patterns::Anything(),
                      "Name of the body's material, one of Materials/Names");
    prm
      .declare_entry("Integration",
                     "mean dilatation",
                     dealii::Patterns::Selection("mean dilatation|full"),
                     "Integration of the stress power: 2 x 2 x 2 Gauss points, with the dilatation "
                     "averaged over the cell (does not lock) or not");
    prm.declare_entry("Refinement",
                      "0",
                      dealii::Patterns::Integer(0, 10),
                      "Number of times every cell is split into eight");
    declare_vector(prm, "Position", "0, 0, 0", "Place of the body frame's origin (length)");
    declare_vector(prm,
                   "Rotation axis",
                   "0, 0, 1",
                   "Axis through the body frame's origin that the body is turned about");
    prm.declare_entry("Rotation angle",
                      "0",
                      dealii::Patterns::Double(),
                      "Angle by which the body is turned before it is moved (degrees)");
    declare_vector(prm, "Velocity", "0, 0, 0", "Initial velocity v_0 (length/time)");
    declare_vector(prm,
                   "Spin",
                   "0, 0, 0",
                   "Initial angular velocity omega_0 about the body's centre of volume (1/time)");
    SpaceTimeFunction::declare(prm,
                               "Velocity field",
                               "0; 0; 0",
                               "Initial velocity as a function of position, added to Velocity and "
                               "Spin (length/time)");
    MeshParameters::declare(prm);
  }


  void
  Body::parse(dealii::ParameterHandler &prm, const std::string &section)
  {
    material = prm.get("Material");
    if (material.empty())
      throw InputError(section, "Material", "(none)", "allowed are the names in Materials/Names");
    integration = prm.get("Integration") == "full" ? CellIntegration::full :
                                                     CellIntegration::mean_dilatation;
    refinement  = prm.get_integer("Refinement");
    position    = get_vector(prm, section, "Position");
    velocity    = get_vector(prm, section, "Velocity");
    spin        = get_vector(prm, section, "Spin");
    velocity_field.parse(prm, section, "Velocity field", 3);

    const auto axis = get_vector(prm, section, "Rotation axis");
    if (axis.norm() == 0.)
      throw InputError(section, "Rotation axis", prm.get("Rotation axis"), "it must not be zero");
    rotation = dealii::Physics::Transformations::Rotations::rotation_matrix_3d(
      dealii::Point<3>(axis / axis.norm()),
      prm.get_double("Rotation angle") * dealii::numbers::PI / 180.);

    mesh.parse(prm, section);
  }
} // namespace akmon
