#include <akmon/contact/bonds/bonds.h>
#include <akmon/contact/contact.h>
#include <akmon/contact/coupled/coupled_solver.h>
#include <akmon/contact/search/edge_search.h>
#include <akmon/contact/search/feature_search.h>
#include <akmon/contact/work_time.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace akmon
{
  using namespace dealii;

  double
  Contact::work_seconds() const
  {
    return seconds_of_work + (coupled ? coupled->work_seconds() : 0.);
  }


  // Of rigid bodies at the furthest slave node, over all ranks.
  double
  Contact::fastest_rigid_motion(const NodalState &state) const
  {
    double fastest = 0.;
    for (const auto &body : bodies)
      {
        if (!body.moves())
          continue;
        double furthest = std::min(body.parameters().shape->radius(), 1e300);
        if (furthest == 1e300)
          furthest = 0.;
        for (const unsigned int node : surface_nodes)
          furthest = std::max(furthest, (at_node(state.x, node) - body.centre()).norm());
        for (const auto &motion : {body.increment_before(), body.next()})
          fastest = std::max(fastest, motion.centre.norm() + furthest * motion.rotation.norm());
      }
    return Utilities::MPI::max(fastest, discretization.communicator());
  }


  double
  Contact::least_radius_of_searches() const
  {
    double least = std::numeric_limits<double>::max();
    for (const auto &search : searches)
      least = std::min(least, search.radius());
    for (const auto &search : feature_searches)
      if (search.exists())
        least = std::min(least, search.radius());
    return least;
  }


  // Sharp features look as far as nodes do for obstacles, and further where all are at rest.
  double
  Contact::reach_of_features(const NodalState &state, const double of_obstacles) const
  {
    double reach = of_obstacles;
    for (const auto &search : feature_searches)
      reach = std::max(reach, state.step == 0 ? search.radius() : search.least_reach());
    return reach;
  }


  // Whether all that is within a reach is among the candidates. Bodies may be closer to where they
  // were when these were found than the sum of their increments tells.
  bool
  Contact::candidates_hold(const NodalState &state, const double reach, const bool has_features)
  {
    constexpr double most = 0.75; // of what is left: else they are asked again soon

    const double left = least_radius_of_searches() - reach;
    if (!prepared || moved <= left)
      return prepared;
    if (has_features) // rigid bodies move too
      return false;
    const double since = motions.approach_since_mark(state);
    if (since > most * left)
      return false;
    moved = since;
    return true;
  }


  // The forces of the coming step, which may move surfaces, are not known yet: several times what
  // any node does now is looked at, surfaces at rest that are pushed from inside included.
  void
  Contact::search(const NodalState &state)
  {
    constexpr double steps      = 8.;
    constexpr double least_part = 0.02; // of the radius, where all are at rest

    motions.measure(state);
    const double of_rigid_bodies = fastest_rigid_motion(state);
    const double fastest         = std::max(motions.largest(), of_rigid_bodies);
    const double least_radius    = least_radius_of_searches();
    const bool has_features      = std::any_of(feature_searches.begin(),
                                          feature_searches.end(),
                                          [](const auto &search) { return search.exists(); });
    // Sharp features of rigid bodies come on their own; without any, obstacles have no candidates.
    moved += has_features ?
               std::max(motions.largest_approach(), motions.largest() + of_rigid_bodies) :
               motions.largest_approach();
    travelled += motions.largest() + of_rigid_bodies;
    const double reach_of_obstacles = steps * fastest;
    double reach = reach_of_obstacles, least_reach = steps * of_rigid_bodies;
    if (!searches.empty())
      {
        least_reach = std::max(least_reach, least_part * least_radius);
        reach       = std::max(reach, least_reach);
      }
    const double reach_of_all = std::max(reach, reach_of_features(state, reach_of_obstacles));
    if (!candidates_hold(state, reach_of_all, has_features))
      rebuild_candidates(state, reach_of_all);
    if (state.step == 0) // bodies may be about to start
      for (const auto &search : searches)
        reach = least_reach = std::max(reach, search.radius());

    std::swap(pairs, previous);
    pairs.clear();
    nodes.gather(state.x, x);
    nodes.gather(state.dx, dx);
    add_rigid_motions(dx, &RigidBody::increment_before);
    x_reached = x; // as far as is known
    for (unsigned int i = 0; i < nodes.first_common(); ++i)
      x_reached.add(i, dx[i]);
    const WorkTime timing(seconds_of_work);
    for (unsigned int i = 0; i < searches.size(); ++i)
      {
        searches[i].find_pairs(x, motions, steps, least_reach, pairs);
        const unsigned int interface = searches[i].get_interface();
        const bool last = i + 1 == searches.size() || searches[i + 1].get_interface() != interface;
        if (last && !edge_searches.empty())
          edge_searches[interface].find_pairs(x, x_reached, reach, previous, pairs);
      }
    find_obstacle_pairs(state, reach_of_obstacles);
    for (auto &pair : pairs)
      pair.depth = std::max(0., -pair.gap);
    if (solver.type != ContactSolver::Type::decoupled)
      warm_start();
  }


  // Pairs in the order of their keys.
  void
  Contact::find_obstacle_pairs(const NodalState &state, const double reach)
  {
    for (unsigned int i = 0; i < bodies.size(); ++i)
      {
        const unsigned int first = nodes.first_common() + rigid_nodes.first[i];
        obstacle_searches[i].find_pairs(nodes, x, first, reach, travelled, pairs);
        for (const bool reversed : {false, true})
          {
            for (auto &touch : rigid_touches)
              if (touch.get_interface() == contacts.size() + i)
                touch.find_pairs(nodes, rigid_nodes, reversed, reach, pairs);
            if (!reversed && !feature_searches.empty())
              feature_searches[i].find_pairs({x, dx, first, reach_of_features(state, reach)},
                                             previous,
                                             pairs);
          }
      }
  }


  // The motion of the bodies' centres and their rotations, at their contact nodes.
  void
  Contact::add_rigid_motions(ContactNodes::Field &field,
                             RigidIncrement (RigidBody::*motion)() const) const
  {
    for (unsigned int i = 0; i < bodies.size(); ++i)
      if (bodies[i].moves())
        {
          const RigidIncrement increment = (bodies[i].*motion)();
          const unsigned int first       = nodes.first_common() + rigid_nodes.first[i];
          field.set(first, increment.centre);
          field.set(first + 1, increment.rotation);
        }
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
    for (unsigned int i = 0; i < edge_searches.size(); ++i)
      {
        const auto of_edges = edge_searches[i].fetch_edges(nodes, state.x, radius_of_edges(i));
        needed.insert(needed.end(), of_edges.begin(), of_edges.end());
      }
    for (auto &search : feature_searches)
      {
        search.look_as_far_as(foresight * reach);
        const auto of_features = search.fetch_faces(nodes, state.x);
        needed.insert(needed.end(), of_features.begin(), of_features.end());
      }
    nodes.reinit(needed);
    mobility.reinit(discretization, conditions, nodes);
    bonds->update_mobilities();
    nodes.gather(state.x, x);
    std::vector<std::array<unsigned int, 2>> neighbours;
    for (auto &search : searches)
      {
        if (!prepared)
          search.forget_distances();
        search.build_candidates(nodes, x, moved);
        search.collect_neighbours(neighbours);
      }
    motions.set_neighbours(neighbours);
    for (unsigned int i = 0; i < edge_searches.size(); ++i)
      edge_searches[i].build_candidates(nodes, x, radius_of_edges(i));
    for (auto &search : feature_searches)
      search.build_candidates(nodes, x);
    motions.mark(state);
    moved    = 0.;
    prepared = true;
  }


  // Edges are looked for as far as the nodes of the same contact.
  double
  Contact::radius_of_edges(const unsigned int interface) const
  {
    for (const auto &search : searches)
      if (search.get_interface() == interface)
        return search.radius();
    return 0.;
  }


  // A pair that was there a step ago starts from its forces. Both lists are sorted alike.
  void
  Contact::warm_start()
  {
    auto old = previous.begin();
    for (auto &pair : pairs)
      {
        while (old != previous.end() && old->key() < pair.key())
          ++old;
        const bool known = old != previous.end() && old->key() == pair.key();
        if (known)
          {
            pair.normal_force     = old->normal_force;
            pair.tangential_force = pair.tangential_part(old->tangential_force);
            pair.curvature        = old->curvature;
          }
      }
  }
} // namespace akmon
