#include <akmon/contact/bonds/bonds.h>
#include <akmon/contact/contact.h>
#include <akmon/contact/coupled/coupled_solver.h>
#include <akmon/contact/nodal_sums.h>
#include <akmon/contact/reproducible_sums.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <map>

// Steps 5 to 7 of Contact: forces and what they do.

namespace akmon
{
  using namespace dealii;

  const ContactLaw &
  Contact::law_of(const ContactPair &pair) const
  {
    if (pair.interface < contacts.size())
      return contacts[pair.interface];
    return bodies[pair.interface - contacts.size()].parameters();
  }


  double
  Contact::release(const ContactPair &pair, const NodalState &state) const
  {
    if (!pair.has_slave_node()) // rigid bodies know no wave speed
      return solver.release_speed * pair.size;
    return solver.release_speed * state.dt_next *
           wave_speeds[discretization.body_of_node[pair.slave]];
  }


  // What the gap of a pair may be at least where the step leads; length, not positive.
  double
  Contact::least_gap(const ContactPair &pair, const NodalState &state) const
  {
    return std::min(0., release(pair, state) - pair.depth);
  }


  // An exact method would put a node that was found inside back within one step, at depth/dt, far
  // above any physical speed. So a penetration is taken back at the release speed only; it cannot
  // grow.
  void
  Contact::set_target_gaps(const NodalState &state)
  {
    for (auto &pair : pairs)
      pair.target_gap = pair.curvature + pair.gap - least_gap(pair, state);
  }


  void
  Contact::set_rigid_mobilities()
  {
    for (unsigned int i = 0; i < bodies.size(); ++i)
      if (bodies[i].moves())
        {
          const unsigned int first = nodes.first_common() + rigid_nodes.first[i];
          mobility.set(first, bodies[i].translation_mobility());
          mobility.set(first + 1, bodies[i].rotation_mobility());
        }
  }


  void
  Contact::resolve_normal(const NodalState &state, const double effective_mass_factor)
  {
    nodes.gather(state.dx_next, dx_free);
    if (bonds->exist())
      {
        bonds->begin_step(state, effective_mass_factor, dx_free);
        nodes.update_ghosts(dx_free);
        // Only now is it known which bonds hold: what has broken in this step is kept out in it.
        pairs.erase(std::remove_if(pairs.begin(),
                                   pairs.end(),
                                   [&](const ContactPair &pair) { return bonds->hold(pair); }),
                    pairs.end());
      }
    add_rigid_motions(dx_free, &RigidBody::next);
    set_rigid_mobilities();
    if (solver.type == ContactSolver::Type::penalty)
      {
        penalty_normal();
        return;
      }
    set_target_gaps(state);
    if (solver.type == ContactSolver::Type::coupled)
      {
        coupled->begin_step(pairs, dx_free, friction_of_pairs(state), effective_mass_factor);
        if (!coupled->has_friction())
          solve_coupled(state);
        return;
      }
    for (auto &pair : pairs)
      {
        const double forward_gap = pair.normal * pair.relative(dx_free) + pair.target_gap;
        const double A_ii        = mobility.along(pair, pair.normal, effective_mass_factor);
        pair.normal_force        = A_ii > 0. ? std::max(0., -forward_gap / A_ii) : 0.;
      }
  }


  // The increments of owned nodes that the pairs' forces cause.
  void
  Contact::add_response(const double effective_mass_factor, ContactNodes::Field &field)
  {
    ContactNodes::Field force;
    nodes.make(force);
    std::vector<ContactPair *> active;
    for (auto &pair : pairs)
      if (pair.normal_force > 0.)
        active.push_back(&pair);
    NodalSums(nodes).add(
      active,
      [&](const std::size_t i, const unsigned int k) {
        return active[i]->at_node(k, active[i]->force());
      },
      force);
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      field.add(i, mobility.times(force[i], i) / effective_mass_factor);
  }


  namespace
  {
    // How far a point comes in the frame of a rigid body: no distance to it changes by more.
    double
    way_in_frame(const Pose &from, const Pose &to, const Tensor<1, 3> &x_0, const Tensor<1, 3> &x_1)
    {
      return ((x_1 - to.place) * to.orientation.matrix() -
              (x_0 - from.place) * from.orientation.matrix())
        .norm();
    }
  } // namespace


  // What is left of penetrations into obstacles that forces do not move, after the solution: taken
  // away node by node, exactly, along the pair's normal. Distances to closed surfaces are dear:
  // they are measured only where the way is longer than the gap, and again where a node has been
  // moved.
  void
  Contact::push_out(const NodalState &state, const double effective_mass_factor)
  {
    constexpr unsigned int most_rounds = 8;
    constexpr double rounding          = 1e-6;

    std::vector<ContactPair *> candidates;
    for (auto &pair : pairs)
      if (pair.kind == ContactPair::Kind::node_to_shape &&
          !bodies[pair.interface - contacts.size()].is_free())
        candidates.push_back(&pair);
    if (Utilities::MPI::max(candidates.size(), discretization.communicator()) == 0)
      return;
    const auto poses = reached_poses(nullptr);
    x_reached        = x;
    for (unsigned int i = 0; i < nodes.first_common(); ++i)
      x_reached.add(i, dx_free[i]);
    if (solver.type == ContactSolver::Type::coupled)
      for (unsigned int i = 0; i < nodes.n_owned(); ++i)
        x_reached.add(i, coupled->increments()[i]);
    else
      add_response(effective_mass_factor, x_reached);

    std::vector<unsigned int> pushed;
    for (unsigned int round = 0; round < most_rounds && !candidates.empty(); ++round)
      {
        pushed.clear();
        for (ContactPair *const pair : candidates)
          {
            const unsigned int node = pair->nodes[0], body = pair->interface - contacts.size();
            if (pair->gap >
                way_in_frame(bodies[body].pose(), poses[body], x[node], x_reached[node]) +
                  rounding * pair->size)
              continue;
            double reached;
            reached_gap(*pair, poses, reached);
            const double lacking = std::min(0., pair->gap + release(*pair, state)) - reached;
            const auto response  = mobility.times(pair->normal, node) / effective_mass_factor;
            const double along   = pair->normal * response;
            if (!(lacking > 1e-16 * (pair->size + x_reached[node].norm())) || !(along > 0.))
              continue;
            pair->normal_force += lacking / along;
            x_reached.add(node, (lacking / along) * response);
            pushed.push_back(node);
          }
        std::sort(pushed.begin(), pushed.end());
        candidates.erase(std::remove_if(candidates.begin(),
                                        candidates.end(),
                                        [&](const ContactPair *const pair) {
                                          return !std::binary_search(pushed.begin(),
                                                                     pushed.end(),
                                                                     pair->nodes[0]);
                                        }),
                         candidates.end());
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


  std::vector<double>
  Contact::friction_of_pairs(const NodalState &state) const
  {
    std::vector<double> friction;
    friction.reserve(pairs.size());
    for (const auto &pair : pairs)
      friction.push_back(friction_coefficient(pair, state));
    return friction;
  }


  void
  Contact::resolve_friction(const NodalState &state, const double effective_mass_factor)
  {
    if (solver.type == ContactSolver::Type::coupled)
      {
        if (coupled->has_friction())
          solve_coupled(state);
        return;
      }
    if (solver.type == ContactSolver::Type::penalty)
      {
        penalty_friction(state);
        return;
      }
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
    if (solver.type != ContactSolver::Type::penalty)
      push_out(state, effective_mass_factor);
    load_rigid_bodies();
    contributions.clear();
    for (const auto &pair : pairs)
      if (pair.normal_force > 0.)
        {
          const auto normal = pair.normal_force * pair.normal;
          const auto turn = pair.turn(normal), tangential_turn = pair.turn(pair.tangential_force);
          for (unsigned int k = 0; k < pair.n_nodes; ++k)
            if (pair.nodes[k] < nodes.first_common())
              {
                auto &contribution            = contributions.emplace_back();
                contribution.node             = nodes.id(pair.nodes[k]);
                contribution.interface        = pair.interface;
                contribution.slave            = pair.slave_id;
                contribution.of_rigid_feature = pair.kind == ContactPair::Kind::rigid_feature;
                contribution.normal           = pair.at_node(k, normal, turn);
                contribution.tangential = pair.at_node(k, pair.tangential_force, tangential_turn);
                contribution.sticks     = pair.sticks;
              }
        }
    nodes.send_to_owners(contributions);

    forces.clear();
    for (const auto &contribution : contributions)
      {
        const unsigned int node = nodes.local_node(nodes.number(contribution.node));
        if (forces.empty() || forces.back().node != node ||
            forces.back().interface != contribution.interface)
          forces.push_back({node, contribution.interface, {}, {}, false});
        auto &force = forces.back();
        force.normal += contribution.normal;
        force.tangential += contribution.tangential;
        force.sticks = force.sticks || contribution.sticks;
      }
    for (const auto &force : forces)
      {
        const auto increment = (force.normal + force.tangential) /
                               (discretization.mass[force.node] * effective_mass_factor);
        for (unsigned int d = 0; d < 3; ++d)
          state.dx_next.local_element(3 * force.node + d) += increment[d];
      }
    add_bond_forces(state, effective_mass_factor);
  }


  // The forces on the bodies, summed over the pairs of all ranks.
  void
  Contact::load_rigid_bodies()
  {
    if (rigid_nodes.n == 0)
      return;
    std::vector<std::vector<double>> addends(6 * rigid_nodes.n); // normal and tangential
    visit_rigid_loads([&](const unsigned int,
                          const unsigned int i,
                          const Tensor<1, 3> &normal,
                          const Tensor<1, 3> &tangential) {
      for (unsigned int d = 0; d < 3; ++d)
        {
          addends[6 * i + d].push_back(normal[d]);
          addends[6 * i + 3 + d].push_back(tangential[d]);
        }
    });
    const auto sums   = reproducible_sums(addends, discretization.communicator());
    const auto sum_at = [&](const unsigned int first) {
      return Tensor<1, 3>({sums[first], sums[first + 1], sums[first + 2]});
    };
    for (unsigned int i = 0; i < bodies.size(); ++i)
      if (bodies[i].moves())
        {
          const unsigned int n = rigid_nodes.first[i];
          bodies[i].add_contact({sum_at(6 * n), sum_at(6 * n + 6)},
                                {sum_at(6 * n + 3), sum_at(6 * n + 9)});
        }
  }
} // namespace akmon
