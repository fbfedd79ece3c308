#pragma once

#include <akmon/contact/coulomb.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/point.h>

#include <string>
#include <vector>

namespace akmon
{
  /// What contact pairs and obstacles have in common: who touches, and how the touch behaves.
  struct ContactLaw
  {
    enum class Stick
    {
      forward, ///< sticking makes the forward increment zero: a stuck node rests
      central  ///< the paper's: zeroes the central velocity, so the node keeps its approach jitter
    };

    std::string name;
    std::vector<std::string> slaves; ///< "BODY:PART"
    Coulomb friction;
    Stick stick = Stick::forward;
    double release_fraction; ///< of a found penetration, per step

    static void
    declare(dealii::ParameterHandler &prm);

    void
    parse(dealii::ParameterHandler &prm);
  };


  /// Contact between boundary parts of bodies. Section "Contact/NAME".
  struct SurfaceContact : ContactLaw
  {
    enum class GapModel
    {
      point_to_segment, ///< a slave node against the closest point of the master faces
      point_to_point    ///< a slave node against the closest master node
    };

    std::vector<std::string> masters; ///< "BODY:PART"
    GapModel gap_model   = GapModel::point_to_segment;
    double rim_tolerance = 0.; ///< of a face's size

    static void
    declare(dealii::ParameterHandler &prm);

    /// Throws InputError where a value is missing.
    void
    parse(dealii::ParameterHandler &prm, const std::string &section);
  };


  /// A fixed rigid plane that boundary parts may hit. Section "Obstacles/NAME".
  struct RigidPlane : ContactLaw
  {
    dealii::Point<3> point;      ///< of the plane, length
    dealii::Tensor<1, 3> normal; ///< unit vector to the side of the bodies

    static void
    declare(dealii::ParameterHandler &prm);

    /// Throws InputError where a value is missing or inadmissible.
    void
    parse(dealii::ParameterHandler &prm, const std::string &section);

    double
    gap(const dealii::Tensor<1, 3> &x) const
    {
      return normal * (x - point);
    }
  };
} // namespace akmon
