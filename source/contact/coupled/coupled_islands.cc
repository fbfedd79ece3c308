#include <akmon/contact/bonds/bonds.h>
#include <akmon/contact/coupled/coupled_solver.h>
#include <akmon/contact/coupled/gather.h>
#include <akmon/contact/work_time.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <numeric>

// How the coupled solver divides pairs into islands, and which rank solves them.

namespace akmon
{
  using namespace dealii;

  // Nodes that move are what pairs share. All bonds together are like one node, the last.
  template <typename VisitNodes>
  UnitedSets
  CoupledSolver::unite(const unsigned int n_pairs,
                       const std::size_t n_nodes,
                       const VisitNodes &visit_nodes)
  {
    last_at.resize(std::max(last_at.size(), n_nodes + 1));
    ++n_divisions; // there are far more nodes than pairs: none is put back
    UnitedSets sets(n_pairs);
    for (unsigned int i = 0; i < n_pairs; ++i)
      visit_nodes(i, [&](const std::size_t node) {
        if (last_at[node].division == n_divisions)
          sets.unite(last_at[node].pair, i);
        last_at[node] = {n_divisions, i};
      });
    return sets;
  }


  bool
  CoupledSolver::is_bonded(const ContactPair &pair) const
  {
    return bonds && bonds->exist() &&
           std::any_of(pair.nodes.begin(),
                       pair.nodes.begin() + pair.n_nodes,
                       [&](const unsigned int node) {
                         return bonds->hold_node(nodes.id_or_common(node));
                       });
  }


  // Pairs that other ranks can have no part in stay on this one.
  void
  CoupledSolver::divide_into_islands()
  {
    std::swap(old_islands, islands);
    islands.clear();
    lone.clear();
    collect_own_pairs();
    divide_own_pairs();
    if (nodes.is_parallel())
      divide_shared_pairs();
    old_islands.clear();
  }


  // And where other ranks have some at nodes of this one.
  void
  CoupledSolver::collect_own_pairs()
  {
    own.clear();
    bonded.clear();
    met.clear();
    for (unsigned int i = 0; i < all.size(); ++i)
      if (active[i])
        {
          own.push_back(i);
          bonded.push_back(is_bonded(*all[i]));
          for (unsigned int k = 0; k < all[i]->n_nodes && nodes.is_parallel(); ++k)
            if (const unsigned int node = all[i]->nodes[k];
                node >= nodes.n_owned() && node < nodes.first_common())
              met.push_back({nodes.id(node)});
        }
    nodes.transfer_to_owners(met);
    met_by_others.assign(nodes.n_owned(), false);
    for (const auto &at : met)
      met_by_others[nodes.number(at.node)] = true;
  }


  void
  CoupledSolver::divide_own_pairs()
  {
    const WorkTime timing(seconds_of_work);
    const unsigned int of_bonds = nodes.size();
    const auto visit_nodes      = [&](const unsigned int i, const auto &visit) {
      const ContactPair &pair = *all[own[i]];
      for (unsigned int k = 0; k < pair.n_nodes; ++k)
        if (!mobility.is_held(pair.nodes[k]))
          visit(pair.nodes[k]);
      if (bonded[i])
        visit(of_bonds);
    };
    const auto is_shared = [&](const unsigned int i) {
      bool any = false;
      visit_nodes(i, [&](const unsigned int node) {
        any = any || node >= nodes.n_owned() || met_by_others[node];
      });
      return any;
    };

    shared.clear();
    closing.clear();
    closing.reserve(own.size()); // members are referred to
    const auto lists = unite(own.size(), of_bonds, visit_nodes).lists();
    auto old_island  = old_islands.begin();
    for (std::size_t l = 0; l < lists.size(); ++l)
      if (const auto list = lists[l];
          nodes.is_parallel() && std::any_of(list.begin(), list.end(), is_shared))
        for (const unsigned int i : list)
          append_closing_pair(own[i], bonded[i], shared);
      else if (list.size() == 1 && !bonded[list[0]] && mobility.moves_alike(*all[own[list[0]]]))
        lone.push_back(own[list[0]]);
      else
        {
          members.clear();
          for (const unsigned int i : list)
            {
              append_closing_pair(own[i], bonded[i], closing);
              members.push_back(&closing.back());
            }
          make_island(old_island);
        }
  }


  void
  CoupledSolver::append_closing_pair(const unsigned int number,
                                     const bool bonded,
                                     std::vector<ClosingPair> &pairs) const
  {
    const ContactPair &pair = *all[number];
    ClosingPair &closing    = pairs.emplace_back();
    closing.pair            = &pair;
    closing.friction        = friction_of_all[number];
    closing.free_motion     = pair.relative(*free_increments);
    closing.is_bonded       = bonded;
    closing.rank            = rank;
    closing.number          = number;
    for (unsigned int k = 0; k < pair.n_nodes; ++k)
      {
        closing.ids[k]      = nodes.id_or_common(pair.nodes[k]);
        closing.mobility[k] = mobility[pair.nodes[k]];
      }
  }


  // The rank of an island's first pair solves it.
  void
  CoupledSolver::divide_shared_pairs()
  {
    to_send.clear();
    for (const ClosingPair &own : shared)
      to_send.push_back({*own.pair, own});
    of_all_ranks = gather(to_send, nodes.get_communicator());
    for (SentPair &pair : of_all_ranks)
      pair.closing.pair = &pair.pair;
    order.resize(of_all_ranks.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](const auto a, const auto b) {
      return by_key(of_all_ranks[a].pair, of_all_ranks[b].pair);
    });

    const ContactNodes::Id of_bonds = nodes.first_common_id() + nodes.size() - nodes.first_common();
    const auto visit_nodes          = [&](const unsigned int i, const auto &visit) {
      const ClosingPair &pair = of_all_ranks[order[i]].closing;
      for (unsigned int k = 0; k < pair.pair->n_nodes; ++k)
        if (trace(pair.mobility[k]) > 0.)
          visit(pair.ids[k]);
      if (pair.is_bonded)
        visit(of_bonds);
    };
    const auto lists = unite(order.size(), of_bonds, visit_nodes).lists();
    auto old_island  = old_islands.begin();
    for (std::size_t l = 0; l < lists.size(); ++l)
      {
        const auto list          = lists[l];
        const ClosingPair &first = of_all_ranks[order[list[0]]].closing;
        if (first.rank != rank)
          continue;
        if (list.size() == 1 && !first.is_bonded && mobility.moves_alike(*all[first.number]))
          {
            lone.push_back(first.number);
            continue;
          }
        members.clear();
        for (const unsigned int i : list)
          members.push_back(&of_all_ranks[order[i]].closing);
        make_island(old_island);
      }
    std::sort(islands.begin(), islands.end(), [](const auto &a, const auto &b) {
      return a->key < b->key;
    });
  }


  // Of the members, sorted by key. Moved as it was in the last step, which asks for no memory.
  // @param old  from where to look for it among the old islands: keys of islands rise
  void
  CoupledSolver::make_island(std::vector<std::unique_ptr<Island>>::iterator &old)
  {
    const auto key = members.front()->pair->key();
    while (old != old_islands.end() && (!*old || (*old)->key < key))
      ++old;
    const bool is_known = old != old_islands.end() && (*old)->key == key;
    islands.push_back(is_known ? std::move(*old) : std::make_unique<Island>());
    const auto &island = islands.back();
    island->key        = key;
    const bool is_same = island->of_this_step && // pairs only join during a step
                         island->get_members().size() == members.size();
    island->set_members(members);
    if (is_same)
      return;
    const bool any_bonded = std::any_of(members.begin(), members.end(), [](const auto *member) {
      return member->is_bonded;
    });
    island->reinit(nodes.first_common_id(), any_bonded ? bonds : nullptr, mass_factor);
    island->of_this_step = true;
  }


  // Of pairs that have been sent; all else is as it was when the islands were made.
  void
  CoupledSolver::take_target_gaps()
  {
    if (!nodes.is_parallel() || of_all_ranks.empty())
      return;
    gaps.clear();
    for (const ClosingPair &own : shared)
      gaps.push_back(all[own.number]->target_gap);
    gaps = gather(gaps, nodes.get_communicator());
    for (std::size_t i = 0; i < gaps.size(); ++i)
      of_all_ranks[i].pair.target_gap = gaps[i];
  }


  void
  CoupledSolver::bring_forces_home()
  {
    const auto take = [&](const unsigned int number, const PairForce &force) {
      ContactPair &pair     = *all[number];
      pair.normal_force     = force.normal;
      pair.tangential_force = force.tangential;
      pair.sticks           = force.sticks;
    };

    solved.clear();
    for (const auto &island : islands)
      for (std::size_t i = 0; i < island->get_members().size() && island->is_new; ++i)
        {
          const ClosingPair &member = *island->get_members()[i];
          const PairForce &force    = island->get_forces()[i];
          if (member.rank == rank)
            take(member.number, force);
          else
            solved.push_back({member.rank, member.number, force});
        }
    if (!nodes.is_parallel() || of_all_ranks.empty())
      return;
    for (const Solved &of_pair : gather(solved, nodes.get_communicator()))
      if (of_pair.rank == rank)
        take(of_pair.number, of_pair.force);
  }
} // namespace akmon
