#include <akmon/model/essential_conditions.h>
#include <akmon/parameters.h>

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace akmon
{
  using namespace dealii;

  void
  PrescribedMotion::declare(ParameterHandler &prm)
  {
    prm.declare_entry(
      "Type",
      "symmetry",
      Patterns::Selection("symmetry|displacement|velocity"),
      "What is prescribed: nodes stay in their (plane) surface, or a displacement or "
      "velocity as a function of time");
    prm.declare_entry("Surfaces",
                      "",
                      Patterns::List(Patterns::Anything()),
                      "Boundary parts BODY:PART the condition holds on");
    prm.declare_entry("Components",
                      "x, y, z",
                      Patterns::MultipleSelection("x|y|z"),
                      "Components that are prescribed (displacement, velocity)");
    SpaceTimeFunction::declare(prm,
                               "Function",
                               "0; 0; 0",
                               "Displacement u (length) or velocity v (length/time)");
  }


  void
  PrescribedMotion::parse(ParameterHandler &prm, const std::string &section)
  {
    const std::string chosen = prm.get("Type");
    type                     = chosen == "symmetry" ? Type::symmetry :
                               chosen == "velocity" ? Type::velocity :
                                                      Type::displacement;
    surfaces                 = split_list(prm.get("Surfaces"));
    if (surfaces.empty())
      throw InputError(section, "Surfaces", "(none)", "allowed are boundary parts BODY:PART");
    for (const auto &component : split_list(prm.get("Components")))
      components.push_back(component[0] - 'x');
    function.parse(prm, section, "Function", 3);
  }


  EssentialConditions::EssentialConditions(const Discretization &discretization,
                                           const std::vector<PrescribedMotion> &motions)
    : discretization(discretization)
    , motions(motions)
    , index_of_node(discretization.n_owned_nodes, numbers::invalid_unsigned_int)
  {
    for (unsigned int m = 0; m < motions.size(); ++m)
      for (const auto &surface : motions[m].surfaces)
        {
          const std::string section = "Prescribed motion/" + motions[m].name;
          const auto faces          = discretization.faces_on(
            discretization.boundary_ids(section, "Surfaces", surface));

          // The plane's normal is the area-weighted mean normal of all ranks' faces; every face
          // must agree.
          Tensor<1, 3> normal_sum;
          std::vector<Tensor<1, 3>> normals;
          for (const auto &face : faces)
            {
              const auto corner = [&](const unsigned int v) {
                return at_node(discretization.reference, face.nodes[v]);
              };
              normals.push_back(0.5 *
                                cross_product_3d(corner(2) - corner(0), corner(3) - corner(1)));
              if (face.owned)
                normal_sum += normals.back();
            }
          normal_sum = Utilities::MPI::sum(normal_sum, discretization.communicator());
          bool plane = normal_sum.norm() > 0.;
          if (plane)
            normal_sum /= normal_sum.norm();
          for (const auto &normal : normals)
            plane = plane && normal * normal_sum > (1. - 1e-6) * normal.norm();
          if (motions[m].type == PrescribedMotion::Type::symmetry &&
              Utilities::MPI::min(int(plane), discretization.communicator()) == 0)
            throw InputError(section,
                             "Surfaces",
                             surface,
                             "a symmetry plane must be a plane surface");

          for (const auto &face : faces)
            for (const unsigned int node : face.nodes)
              if (node < discretization.n_owned_nodes)
                {
                  if (motions[m].type == PrescribedMotion::Type::symmetry)
                    constrain(node, m, normal_sum);
                  else
                    for (const unsigned int c : motions[m].components)
                      {
                        Tensor<1, 3> axis;
                        axis[c] = 1.;
                        constrain(node, m, axis);
                      }
                }
        }
  }


  // Gram-Schmidt against the directions a node already has; where conditions meet, earlier ones
  // win.
  void
  EssentialConditions::constrain(const unsigned int node,
                                 const unsigned int motion,
                                 const Tensor<1, 3> &direction)
  {
    if (index_of_node[node] == numbers::invalid_unsigned_int)
      {
        index_of_node[node] = nodes.size();
        nodes.push_back({node, {}, {}});
      }
    auto &directions = nodes[index_of_node[node]].directions;
    Direction added{direction, {{motion, direction}}};
    for (const auto &existing : directions)
      {
        const double overlap = direction * existing.d;
        added.d -= overlap * existing.d;
        for (const auto &[k, weight] : existing.terms)
          added.terms.emplace_back(k, -overlap * weight);
      }
    const double length = added.d.norm();
    if (length < 1e-6)
      return;
    added.d /= length;
    for (auto &term : added.terms)
      term.second /= length;
    directions.push_back(added);
  }


  // u at the end or v in the middle of the coming step
  Tensor<1, 3>
  EssentialConditions::function_value(const unsigned int motion,
                                      const NodalState &state,
                                      const Point<3> &X) const
  {
    const auto &of  = motions[motion];
    const double dt = state.dt_next;
    return of.function.vector(X,
                              of.type == PrescribedMotion::Type::velocity ? state.time + 0.5 * dt :
                                                                            state.time + dt);
  }


  // Parsing an expression at every node costs more than the rest of a small step.
  void
  EssentialConditions::evaluate_uniform_functions(const NodalState &state)
  {
    uniform_values.resize(motions.size());
    for (unsigned int m = 0; m < motions.size(); ++m)
      if (motions[m].type != PrescribedMotion::Type::symmetry && motions[m].function.uniform())
        uniform_values[m] = function_value(m, state, Point<3>());
  }


  double
  EssentialConditions::prescribed_increment(const Direction &direction,
                                            const NodalState &state,
                                            const unsigned int node) const
  {
    const Point<3> X(at_node(discretization.reference, node));
    const auto x = at_node(state.x, node);
    double sum   = 0.;
    for (const auto &[k, weight] : direction.terms)
      {
        const auto type = motions[k].type;
        if (type == PrescribedMotion::Type::symmetry)
          {
            sum += weight * (X - x);
            continue;
          }
        const auto value = motions[k].function.uniform() ? uniform_values[k] :
                                                           function_value(k, state, X);
        sum += type == PrescribedMotion::Type::velocity ? weight * value * state.dt_next :
                                                          weight * (X + value - x);
      }
    return sum;
  }


  void
  EssentialConditions::apply(NodalState &state, const double effective_mass_factor)
  {
    if (!nodes.empty())
      evaluate_uniform_functions(state);
    for (auto &constrained : nodes)
      {
        const unsigned int node = constrained.node;
        const auto before       = at_node(state.dx_next, node);
        auto after              = before;
        for (const auto &direction : constrained.directions)
          after += (prescribed_increment(direction, state, node) - before * direction.d) *
                   direction.d;
        constrained.reaction += discretization.mass[node] * effective_mass_factor *
                                (after - before);
        for (unsigned int d = 0; d < 3; ++d)
          state.dx_next.local_element(3 * node + d) = after[d];
      }
  }


  void
  EssentialConditions::clear_reactions()
  {
    for (auto &constrained : nodes)
      constrained.reaction = Tensor<1, 3>();
  }


  double
  EssentialConditions::reaction_work(const NodalVector &increment) const
  {
    double work = 0.;
    for (const auto &constrained : nodes)
      work += constrained.reaction * at_node(increment, constrained.node);
    return work;
  }


  SymmetricTensor<2, 3>
  EssentialConditions::projector(const unsigned int node) const
  {
    SymmetricTensor<2, 3> result = unit_symmetric_tensor<3>();
    if (index_of_node[node] != numbers::invalid_unsigned_int)
      for (const auto &direction : nodes[index_of_node[node]].directions)
        result -= symmetrize(outer_product(direction.d, direction.d));
    return result;
  }


  void
  EssentialConditions::adjust_initial_velocity(NodalVector &velocity) const
  {
    for (const auto &constrained : nodes)
      {
        const Point<3> X(at_node(discretization.reference, constrained.node));
        auto v = at_node(velocity, constrained.node);
        for (const auto &direction : constrained.directions)
          {
            double prescribed = 0.;
            for (const auto &[k, weight] : direction.terms)
              if (motions[k].type == PrescribedMotion::Type::velocity)
                prescribed += weight * motions[k].function.vector(X, 0.);
            v += (prescribed - v * direction.d) * direction.d;
          }
        for (unsigned int d = 0; d < 3; ++d)
          velocity.local_element(3 * constrained.node + d) = v[d];
      }
  }
} // namespace akmon
