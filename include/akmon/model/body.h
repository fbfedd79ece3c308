#pragma once

#include <akmon/model/copies.h>
#include <akmon/model/mesh_library.h>
#include <akmon/model/vector_function.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/tensor.h>

#include <string>

namespace akmon
{
  /// How a cell's stress power is integrated.
  enum class CellIntegration
  {
    full, ///< 2 x 2 x 2 Gauss points, every term; locks when plastic flow keeps the volume
    mean_dilatation, ///< 2 x 2 x 2 Gauss points, dilatation averaged over the cell (B-bar)
    one_point        ///< the mean strain only, with hourglass control
  };


  /// What resists the hourglass patterns of one-point cells.
  enum class HourglassControl
  {
    stiffness, ///< springs: for slow deformation and long runs
    viscous    ///< dampers: for fast deformation
  };


  /// One body: its mesh, place, material and initial motion. Section "Bodies/NAME".
  struct Body
  {
    std::string name;
    std::string family; ///< of a copy: the name of the body it is a copy of
    Copies copies;
    unsigned int copy = 0; ///< number among the copies
    MeshParameters mesh;
    unsigned int refinement = 0;
    dealii::Tensor<1, 3> position; ///< where the body frame's origin goes, length
    dealii::Tensor<2, 3> rotation; ///< turns the body about its frame's origin before it is moved
    dealii::Tensor<1, 3> velocity; ///< initial velocity, length/time
    dealii::Tensor<1, 3> spin;     ///< initial angular velocity about the centre of volume, 1/time
    SpaceTimeFunction velocity_field; ///< v(X) at the start, added to both; length/time
    std::string material;
    CellIntegration integration        = CellIntegration::mean_dilatation;
    HourglassControl hourglass_control = HourglassControl::stiffness;
    double hourglass_coefficient       = 0.02; ///< kappa, dimensionless
    bool erodes = false; ///< cells that fail are taken out instead of ending the run

    /// The name of the section that describes it.
    const std::string &
    section_name() const
    {
      return family.empty() ? name : family;
    }

    /// Whether a name is the body's or that of the body it is a copy of.
    bool
    is_called(const std::string &called) const
    {
      return called == name || called == family;
    }

    static void
    declare(dealii::ParameterHandler &prm);

    /// Throws InputError where a value is missing or inadmissible.
    void
    parse(dealii::ParameterHandler &prm, const std::string &section);
  };
} // namespace akmon
