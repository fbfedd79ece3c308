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
                     dealii::Patterns::Selection("mean dilatation|full|one point"),
                     "Integration of the stress power: 2 x 2 x 2 Gauss points, with the dilatation "
                     "averaged over the cell (does not lock) or not; or one point with hourglass "
                     "control (fastest)");
    prm.declare_entry("Hourglass control",
                      "stiffness",
                      dealii::Patterns::Selection("stiffness|viscous"),
                      "Form of the Flanagan-Belytschko hourglass control of one-point cells");
    prm.declare_entry("Hourglass coefficient",
                      "0.02",
                      dealii::Patterns::Double(0., 0.15),
                      "Coefficient kappa of the hourglass control (dimensionless)");
    prm.declare_entry(
      "Failing cells",
      "stop",
      dealii::Patterns::Selection("stop|erode"),
      "A cell that turns inside out, or makes the automatic step collapse, stops the "
      "run, or is eroded: it carries no stress from then on, its mass stays with its "
      "nodes");
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
    prm.enter_subsection("Copies");
    Copies::declare(prm);
    prm.leave_subsection();
    MeshParameters::declare(prm);
  }


  void
  Body::parse(dealii::ParameterHandler &prm, const std::string &section)
  {
    material = prm.get("Material");
    if (material.empty())
      throw InputError(section, "Material", "(none)", "allowed are the names in Materials/Names");
    integration           = prm.get("Integration") == "full"      ? CellIntegration::full :
                            prm.get("Integration") == "one point" ? CellIntegration::one_point :
                                                                    CellIntegration::mean_dilatation;
    hourglass_control     = prm.get("Hourglass control") == "viscous" ? HourglassControl::viscous :
                                                                        HourglassControl::stiffness;
    hourglass_coefficient = prm.get_double("Hourglass coefficient");
    erodes                = prm.get("Failing cells") == "erode";
    refinement            = prm.get_integer("Refinement");
    position              = get_vector(prm, section, "Position");
    velocity              = get_vector(prm, section, "Velocity");
    spin                  = get_vector(prm, section, "Spin");
    velocity_field.parse(prm, section, "Velocity field", 3);

    const auto axis = get_vector(prm, section, "Rotation axis");
    if (axis.norm() == 0.)
      throw InputError(section, "Rotation axis", prm.get("Rotation axis"), "it must not be zero");
    rotation = dealii::Physics::Transformations::Rotations::rotation_matrix_3d(
      dealii::Point<3>(axis / axis.norm()),
      prm.get_double("Rotation angle") * dealii::numbers::PI / 180.);

    prm.enter_subsection("Copies");
    copies.parse(prm, section + "/Copies");
    prm.leave_subsection();
    mesh.parse(prm, section);
  }
} // namespace akmon
