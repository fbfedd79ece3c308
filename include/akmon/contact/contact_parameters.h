#pragma once

#include <akmon/contact/bonds/bond_law.h>
#include <akmon/contact/coulomb.h>

#include <deal.II/base/parameter_handler.h>

#include <string>
#include <vector>

namespace akmon
{
  /// How the contact forces of a step are found. Section "Contact solver".
  struct ContactSolver
  {
    enum class Type
    {
      coupled,   ///< all pairs at once through the full Delassus operator (Problem 2)
      decoupled, ///< every pair alone (Problem 3)
      penalty    ///< springs that push back what has penetrated
    };

    Type type            = Type::coupled;
    double tolerance     = 1e-10; ///< of gaps, relative to the cell size
    unsigned int limit   = 1000;  ///< applications of the operator in one solve
    double release_speed = 1e-4;  ///< over the dilatational wave speed
    double penalty_scale = 0.1;   ///< f_s, of K A^2/V

    static void
    declare(dealii::ParameterHandler &prm);

    void
    parse(dealii::ParameterHandler &prm);
  };


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

    static void
    declare(dealii::ParameterHandler &prm);

    /// Throws InputError where a value is inadmissible.
    void
    parse(dealii::ParameterHandler &prm, const std::string &section);
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
    bool symmetric       = true;  ///< both sides are slave and master
    double rim_tolerance = 0.;    ///< of a face's size
    double edge_angle    = 0.7;   ///< least turn of a surface at its sharp edges; radians
    bool tied            = false; ///< bonded at the start
    double bond_distance = 0.;    ///< how far apart tied surfaces may be, over the face size
    BondLaw bond;

    static void
    declare(dealii::ParameterHandler &prm);

    /// Throws InputError where a value is missing.
    void
    parse(dealii::ParameterHandler &prm, const std::string &section);
  };
} // namespace akmon
