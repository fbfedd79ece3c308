#include <akmon/forces/external_forces.h>
#include <akmon/parameters.h>

#include <deal.II/base/utilities.h>

#include <array>
#include <cmath>
#include <limits>

namespace akmon
{
  using namespace dealii;

  void
  SurfaceLoad::declare(ParameterHandler &prm)
  {
    prm.declare_entry(
      "Type",
      "pressure",
      Patterns::Selection("pressure|traction"),
      "Pressure p against the outward normal, or traction vector f; both per current "
      "area");
    prm.declare_entry("Surfaces",
                      "",
                      Patterns::List(Patterns::Anything()),
                      "Boundary parts BODY:PART the load acts on");
    SpaceTimeFunction::declare(prm,
                               "Function",
                               "0",
                               "Pressure p (one component) or traction f (three components), "
                               "force/area");
  }


  void
  SurfaceLoad::parse(ParameterHandler &prm, const std::string &section)
  {
    type     = prm.get("Type") == "pressure" ? Type::pressure : Type::traction;
    surfaces = split_list(prm.get("Surfaces"));
    if (surfaces.empty())
      throw InputError(section, "Surfaces", "(none)", "allowed are boundary parts BODY:PART");
    function.parse(prm, section, "Function", type == Type::pressure ? 1 : 3);
  }


  void
  BodyForce::declare(ParameterHandler &prm)
  {
    SpaceTimeFunction::declare(prm,
                               "Acceleration",
                               "0; 0; 0",
                               "Body force per mass b/rho, e.g. gravity (length/time^2)");
    prm.declare_entry("Damping",
                      "0",
                      Patterns::Double(0.),
                      "Mass-proportional damping rate eta (1/time)");
    prm.declare_entry("Damping end",
                      "never",
                      Patterns::Anything(),
                      "Time at which the damping is switched off, or 'never'; for settling under "
                      "gravity or a preload before the event (time)");
  }


  void
  BodyForce::parse(ParameterHandler &prm)
  {
    acceleration.parse(prm, "Body force", "Acceleration", 3);
    damping     = prm.get_double("Damping");
    damping_end = get_number_or("never",
                                prm,
                                "Body force",
                                "Damping end",
                                Patterns::Double(0.),
                                "numbers from 0 on")
                    .value_or(std::numeric_limits<double>::infinity());
  }


  ExternalForces::ExternalForces(const Discretization &discretization,
                                 const std::vector<SurfaceLoad> &surface_loads,
                                 const BodyForce &body_force)
    : discretization(discretization)
    , surface_loads(surface_loads)
    , body_force(body_force)
  {
    for (const auto &load : surface_loads)
      loaded_faces.push_back(discretization.faces_on(
        discretization.boundary_ids("Loads/" + load.name, "Surfaces", load.surfaces)));
    if (!surface_loads.empty() || !body_force.acceleration.identically_zero())
      current = discretization.make_vector();
  }


  void
  ExternalForces::add(const NodalState &state, NodalVector &force)
  {
    if (current.size() == 0)
      return;
    current = 0.;
    add_body_force(state, current);
    for (unsigned int i = 0; i < surface_loads.size(); ++i)
      add_surface_load(surface_loads[i], loaded_faces[i], state, current);
    for (unsigned int i = 0; i < 3 * discretization.n_owned_nodes; ++i)
      force.local_element(i) += current.local_element(i);
  }


  void
  ExternalForces::add_body_force(const NodalState &state, NodalVector &force)
  {
    if (body_force.acceleration.identically_zero())
      return;
    const bool uniform        = body_force.acceleration.uniform();
    Tensor<1, 3> acceleration = body_force.acceleration.vector(Point<3>(), state.time);
    for (unsigned int node = 0; node < discretization.n_owned_nodes; ++node)
      {
        if (!uniform)
          acceleration = body_force.acceleration.vector(Point<3>(
                                                          at_node(discretization.reference, node)),
                                                        state.time);
        for (unsigned int d = 0; d < 3; ++d)
          force.local_element(3 * node + d) += discretization.mass[node] * acceleration[d];
      }
  }


  // f_a = int N_a t dGamma over the current bilinear faces, 2 x 2 Gauss points
  void
  ExternalForces::add_surface_load(const SurfaceLoad &load,
                                   const std::vector<BoundaryFace> &faces,
                                   const NodalState &state,
                                   NodalVector &force)
  {
    static const double g                                     = 1. / std::sqrt(3.);
    static constexpr std::array<std::array<int, 2>, 4> corner = {
      {{{-1, -1}}, {{1, -1}}, {{1, 1}}, {{-1, 1}}}};
    for (const auto &face : faces)
      for (const auto &point : corner)
        {
          Tensor<1, 3> X, t_xi, t_eta;
          std::array<double, 4> shape;
          for (unsigned int v = 0; v < 4; ++v)
            {
              const double xi  = 1. + corner[v][0] * g * point[0],
                           eta = 1. + corner[v][1] * g * point[1];
              const auto x     = at_node(state.x, face.nodes[v]);
              shape[v]         = 0.25 * xi * eta;
              X += shape[v] * at_node(discretization.reference, face.nodes[v]);
              t_xi += 0.25 * corner[v][0] * eta * x;
              t_eta += 0.25 * corner[v][1] * xi * x;
            }
          const auto normal = cross_product_3d(t_xi, t_eta); // length: area of the point
          const auto f      = load.type == SurfaceLoad::Type::pressure ?
                                -load.function.value(Point<3>(X), state.time) * normal :
                                load.function.vector(Point<3>(X), state.time) * normal.norm();
          for (unsigned int v = 0; v < 4; ++v)
            if (face.nodes[v] < discretization.n_owned_nodes)
              for (unsigned int d = 0; d < 3; ++d)
                force.local_element(3 * face.nodes[v] + d) += shape[v] * f[d];
        }
  }


  double
  ExternalForces::work(const NodalVector &increment) const
  {
    double sum = 0.;
    if (current.size() > 0)
      for (unsigned int i = 0; i < 3 * discretization.n_owned_nodes; ++i)
        sum += current.local_element(i) * increment.local_element(i);
    return sum;
  }
} // namespace akmon
