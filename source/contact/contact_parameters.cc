#include <akmon/contact/contact_parameters.h>
#include <akmon/parameters.h>

#include <deal.II/base/utilities.h>

#include <limits>

namespace akmon
{
  using dealii::Patterns::Anything;
  using dealii::Patterns::Double;
  using dealii::Patterns::List;
  using dealii::Patterns::Selection;

  namespace
  {
    // A positive number or 'infinite'.
    double
    strength(dealii::ParameterHandler &prm, const std::string &section, const std::string &key)
    {
      return get_number_or("infinite", prm, section, key, Double(1e-300), "positive numbers")
        .value_or(std::numeric_limits<double>::infinity());
    }
  } // namespace


  void
  ContactSolver::declare(dealii::ParameterHandler &prm)
  {
    prm.declare_entry(
      "Type",
      "coupled",
      Selection("coupled|decoupled|penalty"),
      "Contact forces of all pairs at once (exact for any meshes), every pair alone "
      "as in the paper (exact for node pairs and rigid planes only), or springs against "
      "penetration as in common explicit codes (a baseline)");
    prm.declare_entry(
      "Tolerance",
      "1e-10",
      Double(0.),
      "Largest remaining gap violation of the coupled solution, relative to the cell "
      "size (dimensionless)");
    prm.declare_entry("Maximum iterations",
                      "1000",
                      dealii::Patterns::Integer(1),
                      "Applications of the Delassus operator that one coupled solution may take "
                      "before gaps are closed with less friction than Coulomb's");
    prm.declare_entry(
      "Release speed",
      "1e-4",
      Double(0.),
      "Speed at which a penetration found by the search is taken back, relative to the "
      "dilatational wave speed (dimensionless); it never grows");
    prm.declare_entry(
      "Penalty scale",
      "0.1",
      Double(0.),
      "Scale f_s of the stiffness f_s K A^2/V of penalty springs, with bulk modulus K, "
      "area A and volume V of the softer side's cell (dimensionless)");
  }


  void
  ContactSolver::parse(dealii::ParameterHandler &prm)
  {
    const std::string name = prm.get("Type");
    type                   = name == "coupled"   ? Type::coupled :
                             name == "decoupled" ? Type::decoupled :
                                                   Type::penalty;
    tolerance              = prm.get_double("Tolerance");
    limit                  = prm.get_integer("Maximum iterations");
    release_speed          = prm.get_double("Release speed");
    penalty_scale          = prm.get_double("Penalty scale");
    if (!(penalty_scale > 0.))
      throw InputError("Contact solver",
                       "Penalty scale",
                       prm.get("Penalty scale"),
                       "allowed are positive numbers");
  }


  void
  ContactLaw::declare(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Friction coefficient",
                      "0",
                      Double(0.),
                      "Coulomb's coefficient of friction mu_c, static (dimensionless)");
    prm.declare_entry("Kinetic friction coefficient",
                      "same",
                      Anything(),
                      "Coefficient mu_k at high slip speed, or 'same' as the static one "
                      "(dimensionless)");
    prm.declare_entry(
      "Friction decay",
      "0",
      Double(0.),
      "Decay d from static to kinetic friction, mu = mu_k + (mu_s - mu_k) exp(-d |v|) "
      "(time/length)");
    prm.declare_entry(
      "Stick",
      "forward",
      Selection("forward|central"),
      "What sticking makes zero: the forward increment (a stuck node rests), or the "
      "central velocity as printed in the paper (it jitters; decoupled solver only)");
  }


  void
  ContactLaw::parse(dealii::ParameterHandler &prm, const std::string &section)
  {
    friction.static_coefficient  = prm.get_double("Friction coefficient");
    friction.decay               = prm.get_double("Friction decay");
    stick                        = prm.get("Stick") == "central" ? Stick::central : Stick::forward;
    friction.kinetic_coefficient = get_number_or("same",
                                                 prm,
                                                 section,
                                                 "Kinetic friction coefficient",
                                                 Double(0., friction.static_coefficient),
                                                 "numbers from 0 to the friction coefficient")
                                     .value_or(friction.static_coefficient);
  }


  void
  SurfaceContact::declare(dealii::ParameterHandler &prm)
  {
    prm.declare_entry(
      "Slave",
      "",
      List(Anything()),
      "Boundary parts BODY:PART whose nodes are kept out of the master; 'all' is every "
      "surface of every body");
    prm.declare_entry("Master", "", List(Anything()), "Boundary parts BODY:PART made of segments");
    prm.declare_entry(
      "Gap model",
      "point to segment",
      Selection("point to segment|point to point"),
      "Partner of a slave node: the closest point of the master faces, or the closest "
      "master node");
    prm
      .declare_entry("Pass",
                     "symmetric",
                     Selection("symmetric|single"),
                     "Whether both sides are slave and master (coupled solver only), or slaves are "
                     "on one side only");
    prm.declare_entry(
      "Rim tolerance",
      "0.01",
      Double(0., 1.),
      "How far outside the rim of the master surface a slave node is still in contact "
      "(relative to the size of the face)");
    prm.declare_entry(
      "Edge angle",
      "40",
      Double(0., 180.),
      "Convex edges at which a surface turns by more than this are sharp: sharp edges of both sides "
      "that cross are kept apart, too (degrees; 180: none; not with the decoupled solver)");
    prm
      .declare_entry("Type",
                     "contact",
                     Selection("contact|tied"),
                     "Whether the surfaces only touch, or are bonded where they meet at the start; "
                     "bonds that break become contact");
    prm.declare_entry("Normal strength",
                      "infinite",
                      Anything(),
                      "Normal stress N at which a bond fails, with (t_n/N)^2 + (t_s/S)^2 = 1, or "
                      "'infinite' (stress; tied)");
    prm.declare_entry("Shear strength",
                      "infinite",
                      Anything(),
                      "Shear stress S at which a bond fails, or 'infinite' (stress; tied)");
    prm.declare_entry("Fracture energy",
                      "0",
                      Double(0.),
                      "Energy G a failing bond takes while its strength falls to nothing; 0: it is "
                      "gone at once (energy/area; tied)");
    prm.declare_entry("Bond distance",
                      "0.05",
                      Double(0., 1.),
                      "How far apart points of tied surfaces may be at the start to be bonded "
                      "(relative to the size of the face)");
    ContactLaw::declare(prm);
  }


  void
  SurfaceContact::parse(dealii::ParameterHandler &prm, const std::string &section)
  {
    ContactLaw::parse(prm, section);
    slaves  = split_list(prm.get("Slave"));
    masters = split_list(prm.get("Master"));
    if (slaves.empty())
      throw InputError(section, "Slave", "(none)", "allowed are boundary parts BODY:PART");
    if (masters.empty())
      throw InputError(section, "Master", "(none)", "allowed are boundary parts BODY:PART");
    gap_model            = prm.get("Gap model") == "point to point" ? GapModel::point_to_point :
                                                                      GapModel::point_to_segment;
    symmetric            = prm.get("Pass") == "symmetric";
    rim_tolerance        = prm.get_double("Rim tolerance");
    edge_angle           = prm.get_double("Edge angle") * dealii::numbers::PI / 180.;
    tied                 = prm.get("Type") == "tied";
    bond_distance        = prm.get_double("Bond distance");
    bond.normal_strength = strength(prm, section, "Normal strength");
    bond.shear_strength  = strength(prm, section, "Shear strength");
    bond.fracture_energy = prm.get_double("Fracture energy");
  }
} // namespace akmon
