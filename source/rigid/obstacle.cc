#include <akmon/parameters.h>
#include <akmon/rigid/obstacle.h>
#include <akmon/rigid/shape_parameters.h>

#include <deal.II/base/utilities.h>

#include <cmath>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    std::array<bool, 3>
    get_axes(ParameterHandler &prm, const std::string &key)
    {
      std::array<bool, 3> axes = {{false, false, false}};
      for (const auto &axis : split_list(prm.get(key)))
        axes[axis[0] - 'x'] = true;
      return axes;
    }


    double
    get_mass(ParameterHandler &prm, const std::string &section, const RigidShape &shape)
    {
      if (const auto mass = get_number_or("from density",
                                          prm,
                                          section,
                                          "Mass",
                                          Patterns::Double(1e-300),
                                          "positive numbers"))
        return *mass;
      const double density = prm.get_double("Density");
      if (!(density > 0.))
        throw InputError(section, "Density", prm.get("Density"), "a free body needs a mass");
      const double mass = shape.mass_properties(density).mass;
      if (std::isinf(mass))
        throw InputError(section,
                         "Mass",
                         prm.get("Mass"),
                         "the shape is infinite or hollow: give Mass and Inertia");
      return mass;
    }


    // Principal moments of a body fulfil I_1 + I_2 >= I_3 > 0.
    void
    check_inertia(const SymmetricTensor<2, 3> &inertia,
                  const std::string &section,
                  const std::string &text)
    {
      const auto moments = eigenvalues(inertia); // in descending order
      if (!(moments[2] > 0.) || moments[0] > (moments[1] + moments[2]) * (1. + 1e-6))
        throw InputError(section,
                         "Inertia",
                         text,
                         "no body has this: moments must be positive, none above the sum of the "
                         "others");
    }


    SymmetricTensor<2, 3>
    get_inertia(ParameterHandler &prm, const std::string &section)
    {
      const std::string text = prm.get("Inertia");
      const auto entries     = split_list(text);
      bool good              = entries.size() == 3 || entries.size() == 6;
      for (const auto &entry : entries)
        good = good && Patterns::Double().match(entry);
      if (!good)
        throw InputError(section,
                         "Inertia",
                         text,
                         "allowed are 'from shape' and three or six numbers");
      constexpr unsigned int rows[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};
      SymmetricTensor<2, 3> inertia;
      for (unsigned int i = 0; i < entries.size(); ++i)
        inertia[rows[i][0]][rows[i][1]] = Utilities::string_to_double(entries[i]);
      check_inertia(inertia, section, text);
      return inertia;
    }
  } // namespace


  void
  FreeStart::declare(ParameterHandler &prm)
  {
    prm.declare_entry("Density",
                      "0",
                      Patterns::Double(0.),
                      "Density rho that mass and inertia follow from (mass/length^3)");
    prm.declare_entry("Mass",
                      "from density",
                      Patterns::Anything(),
                      "Mass m, or 'from density' (mass)");
    prm.declare_entry("Inertia",
                      "from shape",
                      Patterns::Anything(),
                      "Inertia about the centre of mass in the shape's axes, I_xx, I_yy, I_zz and "
                      "optionally I_xy, I_yz, I_zx, or 'from shape' of uniform density (mass "
                      "length^2)");
    declare_vector(prm,
                   "Velocity",
                   "0, 0, 0",
                   "Initial velocity of the centre of mass (length/time)");
    declare_vector(prm, "Spin", "0, 0, 0", "Initial angular velocity omega_0 (1/time)");
    SpaceTimeFunction::declare(prm,
                               "Force",
                               "0; 0; 0",
                               "Force at the centre of mass, a function of time (force)");
    SpaceTimeFunction::declare(
      prm,
      "Moment",
      "0; 0; 0",
      "Moment about the centre of mass, a function of time (force length)");
    prm.declare_entry("Translations",
                      "x, y, z",
                      Patterns::MultipleSelection("x|y|z"),
                      "Directions in which the body may move; it is guided in the others");
    prm.declare_entry("Rotations",
                      "x, y, z",
                      Patterns::MultipleSelection("x|y|z"),
                      "Axes about which the body may turn: all, one or none");
  }


  void
  FreeStart::parse(ParameterHandler &prm, const std::string &section, const RigidShape &shape)
  {
    const double mass = get_mass(prm, section, shape);
    properties        = shape.mass_properties(1.);
    if (prm.get("Inertia") != "from shape")
      {
        properties.inertia = get_inertia(prm, section);
        if (std::isinf(properties.mass))
          properties.centre = Point<3>();
      }
    else if (std::isinf(properties.mass))
      throw InputError(section,
                       "Inertia",
                       "from shape",
                       "the shape is infinite or hollow: give three or six numbers");
    else
      properties.inertia *= mass / properties.mass;
    properties.mass     = mass;
    freedom.translation = get_axes(prm, "Translations");
    freedom.rotation    = get_axes(prm, "Rotations");
    if (freedom.rotation[0] + freedom.rotation[1] + freedom.rotation[2] == 2)
      throw InputError(section,
                       "Rotations",
                       prm.get("Rotations"),
                       "allowed are all axes, one or none");
    velocity = get_vector(prm, section, "Velocity");
    spin     = get_vector(prm, section, "Spin");
    force.parse(prm, section, "Force", 3);
    moment.parse(prm, section, "Moment", 3);
    for (const char *const key : {"Force", "Moment"})
      if (!(key[0] == 'F' ? force : moment).uniform())
        throw InputError(section, key, prm.get(key), "allowed are functions of t only");
  }


  void
  Obstacle::declare(ParameterHandler &prm)
  {
    prm.declare_entry("Surfaces",
                      "",
                      Patterns::List(Patterns::Anything()),
                      "Boundary parts BODY:PART whose nodes the obstacle stops");
    prm.declare_entry("Obstacles",
                      "",
                      Patterns::List(Patterns::Anything()),
                      "Names of other obstacles that a free one may hit");
    declare_vector(prm,
                   "Point",
                   "0, 0, 0",
                   "A point of the plane; place of any other shape's origin: centre, or origin of "
                   "the file (length)");
    declare_vector(prm,
                   "Normal",
                   "0, 0, 1",
                   "Normal of the plane, to the side of the bodies; axis of cylinder and torus; "
                   "direction of the z axis of box and file");
    prm.declare_entry("Twist",
                      "0",
                      Patterns::Double(),
                      "Angle by which the shape is turned about its z axis first (degrees)");
    prm.declare_entry(
      "Edge angle",
      "20",
      Patterns::Double(0., 180.),
      "Convex edges of a box or a file's surface that turn by more than this are sharp: they and their "
      "corners are kept out of faces of the bodies, however large these are (degrees; 180: none; not "
      "with the decoupled solver)");
    ShapeFromParameters::declare(prm);
    ContactLaw::declare(prm);
    prm.declare_entry("Motion",
                      "fixed",
                      Patterns::Selection("fixed|prescribed|free"),
                      "How the obstacle moves: not at all, by functions of time, or under forces; "
                      "see the subsections");
    prm.enter_subsection("Prescribed");
    PrescribedPath::declare(prm);
    prm.leave_subsection();
    prm.enter_subsection("Free");
    FreeStart::declare(prm);
    prm.leave_subsection();
  }


  void
  Obstacle::parse(ParameterHandler &prm, const std::string &section)
  {
    ContactLaw::parse(prm, section);
    slaves      = split_list(prm.get("Surfaces"));
    obstacles   = split_list(prm.get("Obstacles"));
    start.place = get_vector(prm, section, "Point");
    auto normal = get_vector(prm, section, "Normal");
    if (normal.norm() == 0.)
      throw InputError(section, "Normal", prm.get("Normal"), "it must not be zero");
    const double twist = prm.get_double("Twist") * numbers::PI / 180.;
    edge_angle         = prm.get_double("Edge angle") * numbers::PI / 180.;
    start.orientation  = Orientation::z_axis_to(normal / normal.norm()) *
                        Orientation::about(Tensor<1, 3>({0., 0., twist}));
    const auto made = ShapeFromParameters::parse(prm, section);
    shape           = made.shape;
    repairs         = made.repairs;

    const std::string chosen = prm.get("Motion");
    motion                   = chosen == "fixed"      ? Motion::fixed :
                               chosen == "prescribed" ? Motion::prescribed :
                                                        Motion::free;
    if (motion == Motion::prescribed)
      {
        prm.enter_subsection("Prescribed");
        path.parse(prm, section + "/Prescribed");
        prm.leave_subsection();
      }
    if (motion == Motion::free)
      {
        prm.enter_subsection("Free");
        free.parse(prm, section + "/Free", *shape);
        prm.leave_subsection();
      }
    if (slaves.empty() && obstacles.empty() && motion != Motion::free)
      throw InputError(section, "Surfaces", "(none)", "allowed are boundary parts BODY:PART");
  }
} // namespace akmon
