#include <akmon/contact/contact.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace akmon
{
  using namespace dealii;

  void
  Contact::search(const NodalState &state)
  {
    double reach = 0.;
    if (!searches.empty())
      {
        double fastest = 0., least_radius = std::numeric_limits<double>::max();
        for (const unsigned int node : surface_nodes)
          fastest = std::max({fastest,
                              at_node(state.dx, node).norm_square(),
                              at_node(state.dx_next, node).norm_square()});
        fastest = std::sqrt(Utilities::MPI::max(fastest, discretization.communicator()));
        // Two surfaces can approach each other at twice the speed of the faster one, and may do
        // several times that when they are pushed.
        reach = 8. * fastest;
        moved += 2. * fastest;
        travelled += 2. * fastest;
        for (const auto &search : searches)
          least_radius = std::min(least_radius, search.radius());
        if (moved + reach > least_radius)
          prepared = false;
      }
    if (!prepared)
      rebuild_candidates(state, reach);
    if (state.step == 0) // bodies may be about to start
      for (const auto &search : searches)
        reach = std::max(reach, search.radius());

    const std::vector<ContactPair> previous = std::move(pairs);
    pairs.clear();
    nodes.gather(state.x, x);
    nodes.gather(state.dx, dx);
    for (auto &search : searches)
      search.find_pairs(state.x, x, reach, travelled, pairs);
    find_plane_pairs(state);
    if (solver.type == ContactSolver::Type::coupled)
      warm_start(previous);
  }


  void
  Contact::rebuild_candidates(const NodalState &state, const double reach)
  {
    // Candidates serve several steps at this speed.
    constexpr double foresight = 2.5;

    std::vector<ContactNodes::Id> needed;
    for (auto &search : searches)
      {
        search.look_as_far_as(foresight * reach);
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
      return std::make_tuple(pair.interface, pair.reversed, pair.slave_id, pair.slot);
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
            pair.tangential_force = pair.tangential_part(old->tangential_force);
            pair.curvature        = old->curvature;
          }
      }
  }
} // namespace akmon
