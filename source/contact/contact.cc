#include <akmon/contact/contact.h>
#include <akmon/parameters.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // Least edge at each owned node of some faces, by local node number.
    std::vector<std::pair<unsigned int, double>>
    node_sizes(const Discretization &discretization, const std::vector<BoundaryFace> &faces)
    {
      std::map<unsigned int, double> sizes;
      for (const auto &face : faces)
        for (unsigned int k = 0; k < 4; ++k)
          for (const unsigned int end : {k, (k + 1) % 4})
            if (face.nodes[end] < discretization.n_owned_nodes)
              {
                const double edge = (at_node(discretization.reference, face.nodes[k]) -
                                     at_node(discretization.reference, face.nodes[(k + 1) % 4]))
                                      .norm();
                const auto entry = sizes.emplace(face.nodes[end], edge).first;
                entry->second    = std::min(entry->second, edge);
              }
      return {sizes.begin(), sizes.end()};
    }


    std::vector<SurfaceSearch>
    make_searches(const Discretization &discretization,
                  const ContactSolver &solver,
                  const std::vector<SurfaceContact> &contacts)
    {
      std::vector<SurfaceSearch> searches;
      for (unsigned int i = 0; i < contacts.size(); ++i)
        {
          const auto &contact  = contacts[i];
          const bool coupled   = solver.type == ContactSolver::Type::coupled;
          const bool symmetric = coupled && contact.symmetric;
          searches.emplace_back(discretization, contact, i, false, coupled);
          if (symmetric && contact.slaves != contact.masters)
            searches.emplace_back(discretization, contact, i, true, coupled);
        }
      return searches;
    }


    std::vector<std::vector<BoundaryFace>>
    faces_of_planes(const Discretization &discretization, const std::vector<RigidPlane> &planes)
    {
      std::vector<std::vector<BoundaryFace>> faces;
      for (const auto &plane : planes)
        {
          std::set<types::boundary_id> ids;
          for (const auto &surface : plane.slaves)
            ids.merge(discretization.boundary_ids("Obstacles/" + plane.name, "Surfaces", surface));
          faces.push_back(discretization.faces_on(ids));
        }
      return faces;
    }


    std::vector<unsigned int>
    owned_nodes(const Discretization &discretization,
                const std::vector<SurfaceSearch> &searches,
                const std::vector<std::vector<BoundaryFace>> &plane_faces)
    {
      std::vector<unsigned int> nodes;
      const auto add = [&](const std::vector<BoundaryFace> &faces) {
        for (const auto &face : faces)
          for (const unsigned int node : face.nodes)
            if (node < discretization.n_owned_nodes)
              nodes.push_back(node);
      };
      for (const auto &search : searches)
        add(search.surface_faces());
      for (const auto &faces : plane_faces)
        add(faces);
      std::sort(nodes.begin(), nodes.end());
      nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
      return nodes;
    }
  } // namespace


  Contact::Contact(const Discretization &discretization,
                   const ContactSolver &solver,
                   const std::vector<SurfaceContact> &contacts,
                   const std::vector<RigidPlane> &planes,
                   const EssentialConditions &conditions)
    : discretization(discretization)
    , solver(solver)
    , contacts(contacts)
    , planes(planes)
    , searches(make_searches(discretization, solver, contacts))
    , plane_faces(faces_of_planes(discretization, planes))
    , surface_nodes(owned_nodes(discretization, searches, plane_faces))
    , nodes(discretization, surface_nodes)
    , mobility(discretization, conditions)
    , coupled(solver, nodes, mobility)
  {
    for (const auto &faces : plane_faces)
      plane_slaves.push_back(node_sizes(discretization, faces));
    for (unsigned int i = 0; i < contacts.size() + planes.size(); ++i)
      {
        const bool is_contact = i < contacts.size();
        const ContactLaw &law = is_contact ? static_cast<const ContactLaw &>(contacts[i]) :
                                             planes[i - contacts.size()];
        if (solver.type == ContactSolver::Type::coupled && law.stick == ContactLaw::Stick::central)
          throw InputError((is_contact ? "Contact/" : "Obstacles/") + law.name,
                           "Stick",
                           "central",
                           "allowed with [Contact solver] Type = decoupled only");
      }
  }


  void
  Contact::search(const NodalState &state)
  {
    double reach = std::numeric_limits<double>::max(), fastest = 0.;
    for (const auto &search : searches)
      reach = std::min(reach, search.radius());
    if (!searches.empty())
      {
        for (const unsigned int node : surface_nodes)
          fastest = std::max(fastest, at_node(state.dx, node).norm_square());
        // Two surfaces can approach each other at twice the speed of the faster one.
        moved += 2. * std::sqrt(Utilities::MPI::max(fastest, discretization.communicator()));
      }
    if (!prepared || moved > 0.5 * reach)
      rebuild_candidates(state);

    const std::vector<ContactPair> previous = std::move(pairs);
    pairs.clear();
    nodes.gather(state.x, x);
    nodes.gather(state.dx, dx);
    x_ahead = x;
    for (unsigned int i = 0; i < nodes.size(); ++i)
      x_ahead.add(i, dx[i]);
    for (const auto &search : searches)
      search.find_pairs(state.x, x, x_ahead, dx, pairs);
    find_plane_pairs(state);
    if (solver.type == ContactSolver::Type::coupled)
      warm_start(previous);
  }


  void
  Contact::rebuild_candidates(const NodalState &state)
  {
    std::vector<ContactNodes::Id> needed;
    for (auto &search : searches)
      {
        const auto of_search = search.fetch_master_faces(nodes, state.x);
        needed.insert(needed.end(), of_search.begin(), of_search.end());
      }
    nodes.reinit(needed);
    mobility.reinit(nodes);
    nodes.gather(state.x, x);
    for (auto &search : searches)
      search.build_candidates(nodes, state.x, x);
    moved    = 0.;
    prepared = true;
  }


  void
  Contact::find_plane_pairs(const NodalState &state)
  {
    for (unsigned int i = 0; i < planes.size(); ++i)
      for (const auto &[node, size] : plane_slaves[i])
        {
          ContactPair pair;
          pair.interface  = contacts.size() + i;
          pair.slave      = node;
          pair.slave_id   = nodes.id_of_local(node);
          pair.nodes[0]   = nodes.number(pair.slave_id);
          pair.weights[0] = 1.;
          pair.normal     = planes[i].normal;
          pair.gap        = planes[i].gap(at_node(state.x, node));
          pair.size       = size;
          pairs.push_back(pair);
        }
  }


  // A pair that was there a step ago starts from its forces. Both lists are sorted alike.
  void
  Contact::warm_start(const std::vector<ContactPair> &previous)
  {
    const auto key = [](const ContactPair &pair) {
      return std::make_tuple(pair.interface, pair.reversed, pair.slave_id);
    };
    auto old = previous.begin();
    for (auto &pair : pairs)
      {
        while (old != previous.end() && key(*old) < key(pair))
          ++old;
        const bool known = old != previous.end() && key(*old) == key(pair);
        if (known)
          {
            pair.normal_force     = old->normal_force;
            pair.tangential_force = old->tangential_force;
          }
        // A pair that is just closing will not move on as it did.
        if (pair.normal_force == 0.)
          pair.curvature = 0.;
      }
  }


  const ContactLaw &
  Contact::law_of(const ContactPair &pair) const
  {
    if (pair.interface < contacts.size())
      return contacts[pair.interface];
    return planes[pair.interface - contacts.size()];
  }


  // An exact method would put a node that was found inside back within one step, at depth/dt, far
  // above any physical speed. So a penetration is taken back at the release speed only; it cannot
  // grow.
  void
  Contact::set_target_gaps(const NodalState &state)
  {
    for (auto &pair : pairs)
      {
        const double c = discretization.material_of(discretization.body_of_node[pair.slave])
                           .dilatational_wave_speed();
        pair.target_gap = pair.curvature +
                          std::max(pair.gap, -solver.release_speed * c * state.dt_next);
      }
  }


  void
  Contact::resolve_normal(const NodalState &state, const double effective_mass_factor)
  {
    nodes.gather(state.dx_next, dx_free);
    set_target_gaps(state);
    if (solver.type == ContactSolver::Type::coupled)
      {
        coupled.solve_normal(pairs, dx_free, effective_mass_factor);
        return;
      }
    for (auto &pair : pairs)
      {
        const double forward_gap = pair.normal * pair.relative(dx_free) + pair.target_gap;
        const double A_ii        = mobility.along(pair, pair.normal, effective_mass_factor);
        pair.normal_force        = A_ii > 0. ? std::max(0., -forward_gap / A_ii) : 0.;
      }
  }


  // mu at the slip speed of the increment that led here
  double
  Contact::friction_coefficient(const ContactPair &pair, const NodalState &state) const
  {
    const Coulomb &friction = law_of(pair).friction;
    if (friction.static_coefficient == friction.kinetic_coefficient)
      return friction.static_coefficient;
    return friction.coefficient(pair.tangential_part(pair.relative(dx)).norm() / state.dt);
  }


  void
  Contact::resolve_friction(const NodalState &state, const double effective_mass_factor)
  {
    if (solver.type == ContactSolver::Type::coupled)
      {
        std::vector<double> coefficients;
        for (const auto &pair : pairs)
          coefficients.push_back(friction_coefficient(pair, state));
        coupled.solve_friction(dx_free, coefficients);
      }
    else
      for (auto &pair : pairs)
        if (pair.normal_force > 0.)
          decoupled_friction(pair, state, effective_mass_factor);
  }


  void
  Contact::decoupled_friction(ContactPair &pair,
                              const NodalState &state,
                              const double effective_mass_factor)
  {
    const double mu = friction_coefficient(pair, state);
    if (mu == 0.)
      return;
    Tensor<1, 3> slip = pair.relative(dx_free);
    // In the starting step v_0 is given: only the increment can be made to vanish.
    if (law_of(pair).stick == ContactLaw::Stick::central && state.step > 0)
      slip += (state.dt_next / state.dt) * pair.relative(dx); // 2 dt' v~ = dt'/dt dx
    slip              = pair.tangential_part(slip);
    const double size = slip.norm();
    const double A_ii = size > 0. ? mobility.along(pair, slip / size, effective_mass_factor) : 0.;
    pair.sticks       = size == 0.;
    if (!(A_ii > 0.))
      return;
    const auto result     = Coulomb::tangential_force(-slip / A_ii, mu * pair.normal_force);
    pair.tangential_force = result.force;
    pair.sticks           = result.sticks;
  }


  void
  Contact::add_increments(NodalState &state, const double effective_mass_factor)
  {
    contributions.clear();
    for (const auto &pair : pairs)
      if (pair.normal_force > 0.)
        for (unsigned int k = 0; k < pair.n_nodes; ++k)
          contributions.push_back({nodes.id(pair.nodes[k]),
                                   pair.interface,
                                   pair.slave_id,
                                   pair.weights[k] * pair.normal_force * pair.normal,
                                   pair.weights[k] * pair.tangential_force});
    nodes.send_to_owners(contributions);

    forces.clear();
    for (const auto &contribution : contributions)
      {
        const unsigned int node = nodes.local_node(nodes.number(contribution.node));
        if (forces.empty() || forces.back().node != node)
          forces.push_back({node, {}, {}});
        forces.back().normal += contribution.normal;
        forces.back().tangential += contribution.tangential;
      }
    for (const auto &force : forces)
      {
        const auto increment = (force.normal + force.tangential) /
                               (discretization.mass[force.node] * effective_mass_factor);
        for (unsigned int d = 0; d < 3; ++d)
          state.dx_next.local_element(3 * force.node + d) += increment[d];
      }
  }


  Contact::Work
  Contact::work(const NodalVector &increment) const
  {
    Work sum;
    for (const auto &force : forces)
      {
        const auto step = at_node(increment, force.node);
        sum.normal += force.normal * step;
        sum.tangential += force.tangential * step;
      }
    return sum;
  }
} // namespace akmon
