#include <akmon/contact/contact.h>
#include <akmon/output/history.h>
#include <akmon/parameters.h>

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace akmon
{
  using namespace dealii;

  Contact::Contact(const Discretization &discretization,
                   const std::vector<SurfaceContact> &contacts,
                   const std::vector<RigidPlane> &planes,
                   const EssentialConditions &conditions)
    : discretization(discretization), contacts(contacts), planes(planes),
      mobility(discretization, conditions), nodes(discretization)
  {
    for (unsigned int i = 0; i < contacts.size(); ++i)
      searches.emplace_back(discretization, contacts[i], i);
    for (const auto &plane : planes)
    {
      std::set<types::boundary_id> ids;
      for (const auto &surface : plane.slaves)
        ids.merge(discretization.boundary_ids("Obstacles/" + plane.name, "Surfaces", surface));
      plane_faces.push_back(discretization.faces_on(ids));
      std::map<unsigned int, double> sizes;
      for (const auto &face : plane_faces.back())
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
      plane_slaves.emplace_back(sizes.begin(), sizes.end());
    }
  }


  void
  Contact::search(const NodalState &state)
  {
    pairs.clear();
    if (!searches.empty())
    {
      double reach = std::numeric_limits<double>::max(), fastest = 0.;
      for (const auto &search : searches)
      {
        reach = std::min(reach, search.radius());
        for (const unsigned int node : search.surface_nodes())
          fastest = std::max(fastest, at_node(state.dx, node).norm());
      }
      // Two surfaces can approach each other at twice the speed of the faster one.
      moved += 2. * Utilities::MPI::max(fastest, discretization.communicator());
      if (!prepared || moved > 0.5 * reach)
        rebuild_candidates(state);
      x.exchange(nodes, state.x);
      dx.exchange(nodes, state.dx);
      for (const auto &search : searches)
        search.find_pairs(state.x, x, pairs);
    }
    find_plane_pairs(state);
  }


  void
  Contact::rebuild_candidates(const NodalState &state)
  {
    std::vector<types::global_dof_index> needed;
    for (auto &search : searches)
    {
      const auto of_search = search.fetch_master_faces(state.x);
      needed.insert(needed.end(), of_search.begin(), of_search.end());
    }
    nodes.reinit(needed);
    mobility.reinit(nodes);
    x.exchange(nodes, state.x);
    for (auto &search : searches)
      search.build_candidates(nodes, x);
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
        pair.interface = contacts.size() + i;
        pair.slave     = node;
        pair.normal    = planes[i].normal;
        pair.gap       = planes[i].gap(at_node(state.x, node));
        pair.size      = size;
        pairs.push_back(pair);
      }
  }


  // G u of a pair
  Tensor<1, 3>
  Contact::relative(const ContactNodes::Field &field, const ContactPair &pair) const
  {
    Tensor<1, 3> result = field[pair.slave];
    for (unsigned int k = 0; k < pair.n_masters; ++k)
      result -= pair.N[k] * field[pair.masters[k]];
    return result;
  }


  const ContactLaw &
  Contact::law_of(const ContactPair &pair) const
  {
    if (pair.interface < contacts.size())
      return contacts[pair.interface];
    return planes[pair.interface - contacts.size()];
  }


  void
  Contact::resolve_normal(const NodalState &state, const double effective_mass_factor)
  {
    dx_free.exchange(nodes, state.dx_next);
    for (auto &pair : pairs)
    {
      const double gap = pair.gap >= 0. ? pair.gap : law_of(pair).release_fraction * pair.gap;
      const double forward_gap = pair.normal * relative(dx_free, pair) + gap;
      if (forward_gap < 0.)
      {
        const double A_ii = mobility.along(pair, pair.normal, effective_mass_factor);
        pair.normal_force = A_ii > 0. ? -forward_gap / A_ii : 0.;
      }
    }
  }


  void
  Contact::resolve_friction(const NodalState &state, const double effective_mass_factor)
  {
    dx.exchange(nodes, state.dx);
    for (auto &pair : pairs)
    {
      const ContactLaw &law = law_of(pair);
      if (pair.normal_force == 0. || law.friction.friction_coefficient == 0.)
        continue;
      Tensor<1, 3> slip = relative(dx_free, pair);
      // In the starting step v_0 is given: only the increment can be made to vanish.
      if (law.stick == ContactLaw::Stick::central && state.step > 0)
        slip += (state.dt_next / state.dt) * relative(dx, pair); // 2 dt' v~ = dt'/dt dx
      slip -= (pair.normal * slip) * pair.normal;
      const double size = slip.norm();
      if (size == 0.)
      {
        pair.sticks = true;
        continue;
      }
      const double A_ii = mobility.along(pair, slip / size, effective_mass_factor);
      if (!(A_ii > 0.))
        continue;
      const auto result     = law.friction.tangential_force(-slip / A_ii, pair.normal_force);
      pair.tangential_force = result.force;
      pair.sticks           = result.sticks;
    }
  }


  void
  Contact::add_increments(NodalState &state, const double effective_mass_factor)
  {
    contributions.clear();
    for (const auto &pair : pairs)
      if (pair.normal_force > 0.)
      {
        const auto slave  = discretization.global_node(pair.slave);
        const auto normal = pair.normal_force * pair.normal;
        contributions.push_back({pair.slave, pair.interface, slave, normal, pair.tangential_force});
        for (unsigned int k = 0; k < pair.n_masters; ++k)
          contributions.push_back({pair.masters[k],
                                   pair.interface,
                                   slave,
                                   -pair.N[k] * normal,
                                   -pair.N[k] * pair.tangential_force});
      }
    nodes.send_to_owners(contributions);

    forces.clear();
    for (const auto &contribution : contributions)
    {
      if (forces.empty() || forces.back().node != contribution.node)
        forces.push_back({contribution.node, {}, {}});
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


  ContactReport
  Contact::report(const NodalState &state) const
  {
    ContactReport report;
    report.forces.resize(contacts.size() + planes.size());
    for (const auto &pair : pairs)
    {
      report.max_penetration = std::max(report.max_penetration, -pair.gap);
      if (-pair.gap / pair.size > report.max_penetration_relative)
      {
        report.max_penetration_relative = -pair.gap / pair.size;
        report.place                    = Point<3>(at_node(state.x, pair.slave));
      }
      report.active_pairs += pair.normal_force > 0.;
      report.sticking_pairs += pair.normal_force > 0. && pair.sticks;
      report.forces[pair.interface] += pair.normal_force * pair.normal + pair.tangential_force;
    }
    return report;
  }


  std::vector<std::string>
  Contact::names() const
  {
    std::vector<std::string> result;
    for (const auto &contact : contacts)
      result.push_back(contact.name);
    for (const auto &plane : planes)
      result.push_back(plane.name);
    return result;
  }


  std::vector<BoundaryFace>
  Contact::contact_faces() const
  {
    std::vector<BoundaryFace> faces;
    for (const auto &search : searches)
      faces.insert(faces.end(), search.surface_faces().begin(), search.surface_faces().end());
    for (const auto &of_plane : plane_faces)
      faces.insert(faces.end(), of_plane.begin(), of_plane.end());
    std::sort(faces.begin(), faces.end(), [](const auto &a, const auto &b) { return a.id < b.id; });
    faces.erase(std::unique(faces.begin(),
                            faces.end(),
                            [](const auto &a, const auto &b) { return a.id == b.id; }),
                faces.end());
    return faces;
  }


  void
  Contact::refuse_initial_overlap(const NodalState &state) const
  {
    // What rounding of coordinates in a mesh file may do is tolerated, and released slowly.
    constexpr double tolerated = 1e-6;

    const ContactPair *deepest = nullptr;
    for (const auto &pair : pairs)
      if (pair.gap < -tolerated * pair.size && (!deepest || pair.gap < deepest->gap))
        deepest = &pair;
    std::string message;
    if (deepest)
    {
      const auto place = at_node(state.x, deepest->slave);
      message          = "[" +
                std::string(deepest->interface < contacts.size() ? "Contact/" : "Obstacles/") +
                law_of(*deepest).name + "] body '" +
                discretization.get_bodies()[discretization.body_of_node[deepest->slave]].name +
                "' starts inside its partner, " + shortest_text(-deepest->gap) + " deep at (" +
                shortest_text(place[0]) + ", " + shortest_text(place[1]) + ", " +
                shortest_text(place[2]) + "); move the bodies apart";
    }
    for (const auto &of_rank : Utilities::MPI::all_gather(discretization.communicator(), message))
      if (!of_rank.empty())
        throw InputError(of_rank);
  }
} // namespace akmon
