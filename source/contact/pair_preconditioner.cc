#include <akmon/contact/pair_preconditioner.h>

#include <algorithm>
#include <cmath>

namespace akmon
{
  using dealii::Tensor;

  namespace
  {
    // Whether a factor for one face does for another.
    bool
    alike(const CoulombFace &a, const CoulombFace &b)
    {
      constexpr double turned = 0.9, stiffened = 2.; // cosine; ratio

      if (a.normal != b.normal || a.tangential != b.tangential)
        return false;
      if (a.tangential != CoulombFace::Tangential::circle)
        return true;
      const double ratio = (1. + a.curvature) / (1. + b.curvature);
      return std::abs(a.along * b.along) > turned && ratio < stiffened && ratio > 1. / stiffened;
    }
  } // namespace


  PairPreconditioner::PairPreconditioner(const Mobility &mobility)
    : mobility(mobility)
  {
  }


  void
  PairPreconditioner::set_pairs(const std::vector<ContactPair *> &new_pairs,
                                const Delassus &new_delassus,
                                const double new_mass_factor)
  {
    pairs       = new_pairs;
    delassus    = &new_delassus;
    mass_factor = new_mass_factor;
    present.clear();
    for (unsigned int i = 0; i < pairs.size(); ++i)
      present.push_back(
        {{pairs[i]->interface, pairs[i]->slot, pairs[i]->reversed, pairs[i]->slave_id}, i});
    std::sort(present.begin(), present.end());
    for (const auto &group : groups)
      {
        group->old = true;
        for (auto &member : group->members)
          {
            const auto found = std::lower_bound(present.begin(),
                                                present.end(),
                                                std::make_pair(member.key, 0u));
            member.pair = found != present.end() && !(member.key < found->first) ? found->second :
                                                                                   none;
          }
      }
    find_places();
  }


  void
  PairPreconditioner::find_places()
  {
    places.assign(pairs.size(), {none, none});
    for (unsigned int g = 0; g < groups.size(); ++g)
      for (unsigned int m = 0; m < groups[g]->members.size(); ++m)
        if (const unsigned int pair = groups[g]->members[m].pair; pair != none)
          places[pair] = {g, m};
  }


  void
  PairPreconditioner::forget()
  {
    groups.clear();
    find_places();
  }


  bool
  PairPreconditioner::is_old() const
  {
    return std::any_of(groups.begin(), groups.end(), [](const auto &group) { return group->old; });
  }


  void
  PairPreconditioner::reinit(const std::vector<CoulombFace> &faces, const double new_shift)
  {
    if (shift != new_shift)
      forget();
    shift = new_shift;
    if (still_serve(faces))
      return;
    divide(faces);
    std::vector<std::unique_ptr<Group>> new_groups;
    for (const auto &list : lists)
      {
        const unsigned int old = places[list.front()].group;
        new_groups.push_back(old != none && groups[old] && serves(*groups[old], list, faces) ?
                               std::move(groups[old]) :
                               make_group(list, faces));
      }
    groups = std::move(new_groups);
    find_places();
  }


  bool
  PairPreconditioner::is_closed(const unsigned int pair,
                                const std::vector<CoulombFace> &faces) const
  {
    return delassus->scale()[pair] > 0. &&
           (faces[pair].normal || faces[pair].tangential != CoulombFace::Tangential::none);
  }


  // Whether all groups do as they are.
  bool
  PairPreconditioner::still_serve(const std::vector<CoulombFace> &faces) const
  {
    for (const auto &group : groups)
      for (const auto &member : group->members)
        if (member.pair == none)
          return false;
    for (unsigned int i = 0; i < pairs.size(); ++i)
      {
        const auto [g, m] = places[i];
        if (is_closed(i, faces) != (g != none) ||
            (g != none && !alike(groups[g]->members[m].face, faces[i])))
          return false;
      }
    return true;
  }


  // Lists of closed pairs that share nodes, directly or through others, in the order of their keys.
  void
  PairPreconditioner::divide(const std::vector<CoulombFace> &faces)
  {
    parents.resize(pairs.size());
    pair_at_node.assign(pair_at_node.size(), none);
    for (unsigned int i = 0; i < pairs.size(); ++i)
      {
        parents[i] = i;
        if (!is_closed(i, faces))
          continue;
        for (unsigned int k = 0; k < pairs[i]->n_nodes; ++k)
          {
            const unsigned int node = pairs[i]->nodes[k];
            if (mobility.is_common(node) || mobility.is_held(node))
              continue;
            if (node >= pair_at_node.size())
              pair_at_node.resize(node + 1, none);
            if (pair_at_node[node] == none)
              pair_at_node[node] = i;
            parents[root_of(i)] = root_of(pair_at_node[node]);
          }
      }
    lists.clear();
    std::vector<unsigned int> list_of_root(pairs.size(), none);
    for (const auto &[key, i] : present)
      if (is_closed(i, faces))
        {
          unsigned int &list = list_of_root[root_of(i)];
          if (list == none)
            {
              list = lists.size();
              lists.emplace_back();
            }
          lists[list].push_back(i);
        }
  }


  unsigned int
  PairPreconditioner::root_of(unsigned int pair)
  {
    while (parents[pair] != pair)
      pair = parents[pair] = parents[parents[pair]];
    return pair;
  }


  bool
  PairPreconditioner::serves(const Group &group,
                             const std::vector<unsigned int> &list,
                             const std::vector<CoulombFace> &faces) const
  {
    return std::equal(group.members.begin(),
                      group.members.end(),
                      list.begin(),
                      list.end(),
                      [&](const Member &member, const unsigned int pair) {
                        return member.pair == pair && alike(member.face, faces[pair]);
                      });
  }


  std::unique_ptr<PairPreconditioner::Group>
  PairPreconditioner::make_group(const std::vector<unsigned int> &list,
                                 const std::vector<CoulombFace> &faces)
  {
    auto group = std::make_unique<Group>();
    for (const unsigned int i : list)
      {
        Member member{{pairs[i]->interface, pairs[i]->slot, pairs[i]->reversed, pairs[i]->slave_id},
                      i,
                      faces[i],
                      group->n_rows,
                      0,
                      {}};
        const auto add = [&](const Tensor<1, 3> &direction) {
          member.directions[member.n_rows++] = direction;
        };
        if (faces[i].normal)
          add(Tensor<1, 3>({1., 0., 0.}));
        if (faces[i].tangential == CoulombFace::Tangential::circle)
          add(faces[i].along);
        if (faces[i].tangential == CoulombFace::Tangential::disc)
          {
            add(Tensor<1, 3>({0., 1., 0.}));
            add(Tensor<1, 3>({0., 0., 1.}));
          }
        group->n_rows += member.n_rows;
        group->members.push_back(member);
      }
    make_entries(*group);
    factorize(*group);
    return group;
  }


  void
  PairPreconditioner::make_entries(const Group &group)
  {
    entries.clear();
    triplets.clear();
    for (const auto &member : group.members)
      {
        const ContactPair &pair = *pairs[member.pair];
        const double s          = delassus->scale()[member.pair];
        for (unsigned int j = 0; j < member.n_rows; ++j)
          {
            const auto force       = s * (member.directions[j] * delassus->frame(member.pair));
            const unsigned int row = member.first_row + j;
            double diagonal        = shift;
            if (member.face.tangential == CoulombFace::Tangential::circle &&
                member.directions[j] == member.face.along)
              diagonal += member.face.curvature;
            for (unsigned int k = 0; k < pair.n_nodes; ++k)
              {
                const unsigned int node = pair.nodes[k];
                const auto at_node      = pair.at_node(k, force);
                if (mobility.is_common(node))
                  diagonal += at_node * (mobility[node] * at_node) / mass_factor;
                else if (!mobility.is_held(node))
                  entries.push_back({node, row, at_node});
              }
            triplets.emplace_back(row, row, diagonal);
          }
      }
    std::sort(entries.begin(), entries.end(), [](const Entry &a, const Entry &b) {
      return std::tie(a.node, a.row) < std::tie(b.node, b.row);
    });
  }


  void
  PairPreconditioner::factorize(Group &group)
  {
    constexpr double rounding = 1e-12; // of what is zero between orthogonal directions

    for (auto begin = entries.begin(); begin != entries.end();)
      {
        const auto &W = mobility[begin->node];
        auto end      = begin;
        for (; end != entries.end() && end->node == begin->node; ++end)
          {
            const auto increment = W * end->force / mass_factor;
            for (auto other = begin; other != end + 1; ++other)
              {
                const double value = other->force * increment;
                if (std::abs(value) > rounding)
                  triplets.emplace_back(end->row, other->row, value);
              }
          }
        begin = end;
      }
    group.valid = group.cholesky.compute(group.n_rows, triplets);
  }


  void
  PairPreconditioner::apply(const Vector &r, Vector &z)
  {
    z = r;
    for (const auto &group : groups)
      {
        if (!group->valid)
          continue;
        values.resize(group->n_rows);
        for (const auto &member : group->members)
          for (unsigned int j = 0; j < member.n_rows; ++j)
            values[member.first_row + j] = member.directions[j] * r[member.pair];
        solution = values;
        group->cholesky.solve_in_place(solution);
        for (const auto &member : group->members)
          for (unsigned int j = 0; j < member.n_rows; ++j)
            {
              const unsigned int row = member.first_row + j;
              z[member.pair] += (solution[row] - values[row]) * member.directions[j];
            }
      }
  }
} // namespace akmon
