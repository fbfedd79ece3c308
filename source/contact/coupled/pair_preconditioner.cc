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
        const auto old = old_groups.find((*pairs)[list.front()].key());
        if (old != old_groups.end() && serves(*old->second, list, faces))
          {
            groups.push_back(std::move(old->second));
            for (std::size_t m = 0; m < list.size(); ++m)
              groups.back()->members[m].pair = list[m];
            continue;
          }
        groups.push_back(std::make_unique<Group>());
        make_group(list, faces, *groups.back());
      }
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


  bool
  PairPreconditioner::is_symmetric(const Group &group)
  {
    return std::none_of(group.members.begin(), group.members.end(), [](const Member &member) {
      return member.face.tangential == CoulombFace::Tangential::circle && member.face.mu != 0.;
    });
  }


  void
  PairPreconditioner::factorize_full(Group &group)
  {
    const auto &A = delassus->matrix();
    jacobian.resize(group.n_rows, group.n_rows);
    for (const Member &of_column : group.members)
      for (unsigned int j = 0; j < of_column.directions.n; ++j)
        {
          const auto force = of_column.face.lift(of_column.directions.e[j]);
          values.noalias() = A.middleCols<3>(3 * of_column.pair) *
                             Eigen::Map<const Eigen::Vector3d>(force.begin_raw());
          for (const Member &of_row : group.members)
            for (unsigned int i = 0; i < of_row.directions.n; ++i)
              {
                const Eigen::Map<const Eigen::Vector3d> e(of_row.directions.e[i].begin_raw());
                jacobian(of_row.row + i,
                         of_column.row + j) = e.dot(values.segment<3>(3 * of_row.pair));
              }
          jacobian(of_column.row + j, of_column.row + j) += shift + of_column.curvature_along(j);
        }
    group.valid = group.n_rows > 0 && group.factor.compute(jacobian, is_symmetric(group));
  }


  void
  PairPreconditioner::collect_entries(const Group &group)
  {
    entries.clear();
    for (const Member &member : group.members)
      {
        const ContactPair &pair = (*pairs)[member.pair];
        const auto in_axes      = [&](const Tensor<1, 3> &v) {
          return delassus->scale()[member.pair] * (v * delassus->frame(member.pair));
        };
        for (unsigned int j = 0; j < member.directions.n; ++j)
          {
            const auto &e    = member.directions.e[j];
            const auto along = in_axes(e), force = in_axes(member.face.lift(e));
            for (unsigned int k = 0; k < pair.n_nodes; ++k)
              if (const unsigned int node = pair.nodes[k]; !mobility->is_held(node))
                entries.push_back({node,
                                   member.row + j,
                                   pair.at_node(k, force),
                                   mobility->times(pair.at_node(k, along), node) / mass_factor});
          }
      }
    std::stable_sort(entries.begin(), entries.end(), [](const Entry &a, const Entry &b) {
      return a.node < b.node;
    });
  }


  void
  PairPreconditioner::factorize(Group &group)
  {
    constexpr double rounding = 1e-12; // of what is zero between orthogonal directions

    const bool symmetric = is_symmetric(group);
    triplets.clear();
    const auto add = [&](const Entry &row, const Entry &column) {
      if (const double value = column.force * row.increment; std::abs(value) > rounding)
        triplets.emplace_back(row.row, column.row, value);
    };
    for (const Member &member : group.members)
      for (unsigned int j = 0; j < member.directions.n; ++j)
        triplets.emplace_back(member.row + j, member.row + j, shift + member.curvature_along(j));
    auto of_node = entries.cbegin();
    for (auto entry = entries.cbegin(); entry != entries.cend(); ++entry)
      {
        if (entry->node != of_node->node)
          of_node = entry;
        for (auto other = mobility->is_common(entry->node) ? entry : of_node; other <= entry;
             ++other)
          {
            add(*entry, *other);
            if (!symmetric && other != entry)
              add(*other, *entry);
          }
      }
    group.valid = group.factor.compute(group.n_rows, triplets, symmetric);
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
        for (const Member &member : group->members)
          for (unsigned int j = 0; j < member.directions.n; ++j)
            values[member.row + j] = member.directions.e[j] * r[member.pair];
        group->factor.solve_in_place(values);
        for (const Member &member : group->members)
          for (unsigned int j = 0; j < member.directions.n; ++j)
            {
              const auto &e = member.directions.e[j];
              z[member.pair] += (values[member.row + j] - e * r[member.pair]) * e;
            }
      }
  }
} // namespace akmon
