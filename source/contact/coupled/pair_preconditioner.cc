#include <akmon/contact/coupled/pair_preconditioner.h>
#include <akmon/contact/coupled/united_sets.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace akmon
{
  using namespace dealii;

  PairPreconditioner::Directions::Directions(const CoulombFace &face)
  {
    if (face.normal)
      e[n++] = Tensor<1, 3>({1., 0., 0.});
    if (face.tangential == CoulombFace::Tangential::circle)
      e[n++] = face.along;
    if (face.tangential == CoulombFace::Tangential::disc)
      {
        e[n++] = Tensor<1, 3>({0., 1., 0.});
        e[n++] = Tensor<1, 3>({0., 0., 1.});
      }
  }


  void
  PairPreconditioner::set_pairs(const std::vector<ContactPair> &new_pairs,
                                const Delassus &new_delassus,
                                const Mobility &new_mobility,
                                const double new_mass_factor)
  {
    if (is_assembled())
      groups.clear();
    pairs       = &new_pairs;
    delassus    = &new_delassus;
    mobility    = &new_mobility;
    mass_factor = new_mass_factor;
    closed.clear();
    for (const auto &group : groups)
      group->old = true;
  }


  void
  PairPreconditioner::set_matrix(const Delassus &new_delassus)
  {
    pairs    = nullptr;
    delassus = &new_delassus;
    closed.clear();
    groups.resize(1);
    if (!groups.front())
      groups.front() = std::make_unique<Group>();
    groups.front()->clear();
  }


  bool
  PairPreconditioner::is_old() const
  {
    return !is_assembled() &&
           std::any_of(groups.begin(), groups.end(), [](const auto &group) { return group->old; });
  }


  void
  PairPreconditioner::reinit(const std::vector<CoulombFace> &faces, const double new_shift)
  {
    if (shift != new_shift)
      {
        closed.clear();
        if (!is_assembled())
          forget();
      }
    shift = new_shift;
    now_closed.clear();
    for (unsigned int i = 0; i < faces.size(); ++i)
      if (is_closed(i, faces))
        now_closed.push_back(i);
    if (!groups.empty() && now_closed == closed && all_serve(faces))
      return;
    std::swap(closed, now_closed);
    if (is_assembled())
      {
        groups.front()->clear();
        make_group(closed, faces, *groups.front());
        return;
      }
    std::map<Key, std::unique_ptr<Group>> old_groups;
    for (auto &group : groups)
      old_groups[group->members.front().key] = std::move(group);
    groups.clear();
    for (const auto &list : divide())
      {
        const auto old      = old_groups.find((*pairs)[list.front()].key());
        const bool is_known = old != old_groups.end();
        if (is_known && serves(*old->second, list, faces))
          {
            groups.push_back(std::move(old->second));
            for (std::size_t m = 0; m < list.size(); ++m)
              groups.back()->members[m].pair = list[m];
            continue;
          }
        groups.push_back(is_known ? std::move(old->second) : std::make_unique<Group>());
        groups.back()->clear();
        make_group(list, faces, *groups.back());
      }
  }


  bool
  PairPreconditioner::is_made_for(const std::vector<CoulombFace> &faces,
                                  const double new_shift) const
  {
    if (is_assembled() || shift != new_shift)
      return false;
    unsigned int n_closed = 0;
    for (unsigned int i = 0; i < faces.size(); ++i)
      n_closed += is_closed(i, faces);
    for (const auto &group : groups)
      for (const Member &member : group->members)
        {
          const auto pair = find_pair(*pairs, member.key);
          if (pair == pairs->end() || !alike(member.face, faces[pair - pairs->begin()]))
            return false;
          --n_closed;
        }
    return n_closed == 0;
  }


  bool
  PairPreconditioner::is_closed(const unsigned int pair,
                                const std::vector<CoulombFace> &faces) const
  {
    return delassus->scale()[pair] > 0. &&
           (faces[pair].normal || faces[pair].tangential != CoulombFace::Tangential::none);
  }


  // Of the same closed pairs.
  bool
  PairPreconditioner::all_serve(const std::vector<CoulombFace> &faces) const
  {
    return std::all_of(groups.begin(), groups.end(), [&](const auto &group) {
      return std::all_of(group->members.begin(), group->members.end(), [&](const Member &member) {
        return alike(member.face, faces[member.pair]);
      });
    });
  }


  // Lists of closed pairs that share nodes, directly or through others.
  std::vector<std::vector<unsigned int>>
  PairPreconditioner::divide() const
  {
    UnitedSets sets(closed.size());
    std::vector<unsigned int> last_at_node(mobility->size(), numbers::invalid_unsigned_int);
    for (unsigned int c = 0; c < closed.size(); ++c)
      {
        const ContactPair &pair = (*pairs)[closed[c]];
        for (unsigned int k = 0; k < pair.n_nodes; ++k)
          if (const unsigned int node = pair.nodes[k];
              !mobility->is_common(node) && !mobility->is_held(node))
            {
              if (last_at_node[node] != numbers::invalid_unsigned_int)
                sets.unite(last_at_node[node], c);
              last_at_node[node] = c;
            }
      }
    const auto lists = sets.lists();
    std::vector<std::vector<unsigned int>> of_pairs(lists.size());
    for (std::size_t l = 0; l < lists.size(); ++l)
      for (const unsigned int c : lists[l])
        of_pairs[l].push_back(closed[c]);
    return of_pairs;
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
                      [&](const Member &member, const unsigned int i) {
                        return member.key == (*pairs)[i].key() && alike(member.face, faces[i]);
                      });
  }


  void
  PairPreconditioner::make_group(const std::vector<unsigned int> &list,
                                 const std::vector<CoulombFace> &faces,
                                 Group &group)
  {
    for (const unsigned int i : list)
      {
        group.members.push_back({is_assembled() ? Key() : (*pairs)[i].key(),
                                 faces[i],
                                 i,
                                 group.n_rows,
                                 Directions(faces[i])});
        group.n_rows += group.members.back().directions.n;
      }
    if (is_assembled())
      {
        factorize_full(group);
        return;
      }
    collect_entries(group);
    factorize(group);
  }


  void
  PairPreconditioner::apply(const Vector &r, Vector &z)
  {
    z = r;
    for (const auto &group : groups)
      if (group->valid)
        group->has_blocks ? apply_by_members(*group, r, z) : apply_by_rows(*group, r, z);
  }


  void
  PairPreconditioner::apply_by_rows(const Group &group, const Vector &r, Vector &z)
  {
    values.resize(group.n_rows);
    for (const Member &member : group.members)
      for (unsigned int j = 0; j < member.directions.n; ++j)
        values[member.row + j] = member.directions.e[j] * r[member.pair];
    group.by_rows.solve_in_place(values);
    for (const Member &member : group.members)
      member.replace([&](const unsigned int j) { return values[member.row + j]; }, z[member.pair]);
  }


  void
  PairPreconditioner::apply_by_members(const Group &group, const Vector &r, Vector &z)
  {
    block_values.assign(group.members.size(), {});
    for (unsigned int m = 0; m < group.members.size(); ++m)
      for (unsigned int j = 0; j < group.members[m].directions.n; ++j)
        block_values[m][j] = group.members[m].directions.e[j] * r[group.members[m].pair];
    group.by_members.solve_in_place(block_values);
    for (unsigned int m = 0; m < group.members.size(); ++m)
      group.members[m].replace([&](const unsigned int j) { return block_values[m][j]; },
                               z[group.members[m].pair]);
  }
} // namespace akmon
