#include <akmon/contact/contact_parameters.h>
#include <akmon/parameters.h>

namespace akmon
{
  using dealii::Patterns::Anything;
  using dealii::Patterns::Double;
  using dealii::Patterns::List;
  using dealii::Patterns::Selection;

  void
  ContactLaw::declare(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Friction coefficient",
                      "0",
                      Double(0.),
                      "Coulomb's coefficient of friction mu_c (dimensionless)");
    prm
      .declare_entry("Stick",
                     "forward",
                     Selection("forward|central"),
                     "What sticking makes zero: the forward increment (a stuck node rests), or the "
                     "central velocity as printed in the paper (it jitters)");
    prm.declare_entry("Release fraction",
                      "0.05",
                      Double(0., 1.),
                      "Part of a penetration found by the search that a step may take back "
                      "(dimensionless); the penetration never grows");
  }


  void
  ContactLaw::parse(dealii::ParameterHandler &prm)
  {
    friction.friction_coefficient = prm.get_double("Friction coefficient");
    stick                         = prm.get("Stick") == "central" ? Stick::central : Stick::forward;
    release_fraction              = prm.get_double("Release fraction");
  }


  void
  SurfaceContact::declare(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Slave",
                      "",
                      List(Anything()),
                      "Boundary parts BODY:PART whose nodes are kept out of the master");
    prm.declare_entry("Master", "", List(Anything()), "Boundary parts BODY:PART made of segments");
    prm.declare_entry(
      "Gap model",
      "point to segment",
      Selection("point to segment|point to point"),
      "Partner of a slave node: the closest point of the master faces, or the closest "
      "master node");
    prm.declare_entry(
      "Rim tolerance",
      "0.01",
      Double(0., 1.),
      "How far outside the rim of the master surface a slave node is still in contact "
      "(relative to the size of the face)");
    ContactLaw::declare(prm);
  }


  void
  SurfaceContact::parse(dealii::ParameterHandler &prm, const std::string &section)
  {
    ContactLaw::parse(prm);
    slaves  = split_list(prm.get("Slave"));
    masters = split_list(prm.get("Master"));
    if (slaves.empty())
      throw InputError(section, "Slave", "(none)", "allowed are boundary parts BODY:PART");
    if (masters.empty())
      throw InputError(section, "Master", "(none)", "allowed are boundary parts BODY:PART");
    gap_model     = prm.get("Gap model") == "point to point" ? GapModel::point_to_point
                                                             : GapModel::point_to_segment;
    rim_tolerance = prm.get_double("Rim tolerance");
  }


  void
  RigidPlane::declare(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Surfaces",
                      "",
                      List(Anything()),
                      "Boundary parts BODY:PART whose nodes the plane stops");
    declare_vector(prm, "Point", "0, 0, 0", "A point of the plane (length)");
    declare_vector(prm, "Normal", "0, 0, 1", "Normal of the plane, to the side of the bodies");
    ContactLaw::declare(prm);
  }


  void
  RigidPlane::parse(dealii::ParameterHandler &prm, const std::string &section)
  {
    ContactLaw::parse(prm);
    slaves = split_list(prm.get("Surfaces"));
    if (slaves.empty())
      throw InputError(section, "Surfaces", "(none)", "allowed are boundary parts BODY:PART");
    point  = dealii::Point<3>(get_vector(prm, section, "Point"));
    normal = get_vector(prm, section, "Normal");
    if (normal.norm() == 0.)
      throw InputError(section, "Normal", prm.get("Normal"), "it must not be zero");
    normal /= normal.norm();
  }
} // namespace akmon
