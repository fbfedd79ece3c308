#include <akmon/contact/pair_preconditioner.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <type_traits>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int none = std::numeric_limits<unsigned int>::max();


    std::vector<int>
    numbers_of_items(const std::size_t n, const MPI_Comm communicator)
    {
      std::vector<int> numbers(Utilities::MPI::n_mpi_processes(communicator));
      const int own = n;
      MPI_Allgather(&own, 1, MPI_INT, numbers.data(), 1, MPI_INT, communicator);
      return numbers;
    }


    // The items of all ranks, one rank after another.
    template <typename Item>
    void
    gather(const std::vector<Item> &own,
           const std::vector<int> &numbers,
           std::vector<Item> &all,
           const MPI_Comm communicator)
    {
      static_assert(std::is_trivially_copyable_v<Item>);

      std::vector<int> sizes, offsets;
      int total = 0;
      for (const int n : numbers)
        {
          offsets.push_back(total * sizeof(Item));
          sizes.push_back(n * sizeof(Item));
          total += n;
        }
      all.resize(total);
      MPI_Allgatherv(own.data(),
                     own.size() * sizeof(Item),
                     MPI_BYTE,
                     all.data(),
                     sizes.data(),
                     offsets.data(),
                     MPI_BYTE,
                     communicator);
    }


    // Which set an element is in, while sets are united.
    unsigned int
    root_of(std::vector<unsigned int> &parents, unsigned int i)
    {
      while (parents[i] != i)
        i = parents[i] = parents[parents[i]];
      return i;
    }
  } // namespace


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


  PairPreconditioner::PairPreconditioner(const ContactNodes &nodes, const Mobility &mobility)
    : nodes(nodes)
    , mobility(mobility)
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
    for (const auto &group : groups)
      group->old = true;
  }


  void
  PairPreconditioner::forget()
  {
    groups.clear();
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
    own.clear();
    for (unsigned int i = 0; i < pairs.size(); ++i)
      if (is_closed(i, faces))
        own.push_back(i);
    if (!groups.empty() &&
        Utilities::MPI::min(int(still_serve(faces)), nodes.get_communicator()) == 1)
      return;
    gather_closed_pairs(faces);
    make_groups(divide());
  }


  bool
  PairPreconditioner::is_closed(const unsigned int pair,
                                const std::vector<CoulombFace> &faces) const
  {
    return delassus->scale()[pair] > 0. &&
           (faces[pair].normal || faces[pair].tangential != CoulombFace::Tangential::none);
  }


  // Whether all groups do as they are for this rank's pairs, in the same order.
  bool
  PairPreconditioner::still_serve(const std::vector<CoulombFace> &faces)
  {
    const auto first = closed.begin() + first_own;
    const auto last  = first + n_closed[Utilities::MPI::this_mpi_process(nodes.get_communicator())];
    return std::equal(own.begin(),
                      own.end(),
                      first,
                      last,
                      [&](const unsigned int i, const ClosedPair &other) {
                        const ContactPair &pair = *pairs[i];
                        return Key(pair.slave_id,
                                   pair.interface,
                                   pair.slot,
                                   pair.reversed,
                                   pair.of_edges,
                                   pair.others) == other.key() &&
                               alike(other.face, faces[i]);
                      });
  }


  void
  PairPreconditioner::gather_closed_pairs(const std::vector<CoulombFace> &faces)
  {
    std::vector<ClosedPair> own_closed;
    for (const unsigned int i : own)
      {
        const ContactPair &pair = *pairs[i];
        ClosedPair c{pair.slave_id,
                     pair.interface,
                     pair.slot,
                     pair.reversed,
                     pair.of_edges,
                     pair.others,
                     faces[i],
                     0,
                     {}};
        for (unsigned int k = 0; k < pair.n_nodes; ++k)
          if (const unsigned int node = pair.nodes[k];
              !mobility.is_common(node) && !mobility.is_held(node))
            c.nodes[c.n_nodes++] = nodes.id(node);
        own_closed.push_back(c);
      }
    const MPI_Comm communicator = nodes.get_communicator();
    n_closed                    = numbers_of_items(own.size(), communicator);
    first_own                   = std::accumulate(n_closed.begin(),
                                n_closed.begin() + Utilities::MPI::this_mpi_process(communicator),
                                0);
    gather(own_closed, n_closed, closed, communicator);
  }


  // Lists of closed pairs that share nodes, directly or through others, in the order of their keys.
  std::vector<std::vector<unsigned int>>
  PairPreconditioner::divide() const
  {
    std::vector<unsigned int> order(closed.size());
    std::iota(order.begin(), order.end(), 0U);
    std::vector<unsigned int> parents = order;

    std::vector<std::pair<ContactNodes::Id, unsigned int>> at_nodes;
    for (unsigned int c = 0; c < closed.size(); ++c)
      for (unsigned int k = 0; k < closed[c].n_nodes; ++k)
        at_nodes.emplace_back(closed[c].nodes[k], c);
    std::sort(at_nodes.begin(), at_nodes.end());
    for (std::size_t i = 1; i < at_nodes.size(); ++i)
      if (at_nodes[i].first == at_nodes[i - 1].first)
        parents[root_of(parents, at_nodes[i].second)] = root_of(parents, at_nodes[i - 1].second);

    std::sort(order.begin(), order.end(), [&](const unsigned int a, const unsigned int b) {
      return closed[a].key() < closed[b].key();
    });
    std::vector<std::vector<unsigned int>> lists;
    std::vector<unsigned int> list_of_root(closed.size(), none);
    for (const unsigned int c : order)
      {
        unsigned int &list = list_of_root[root_of(parents, c)];
        if (list == none)
          {
            list = lists.size();
            lists.emplace_back();
          }
        lists[list].push_back(c);
      }
    return lists;
  }


  bool
  PairPreconditioner::serves(const Group &group, const std::vector<unsigned int> &list) const
  {
    if (group.keys.size() != list.size())
      return false;
    for (std::size_t m = 0; m < list.size(); ++m)
      if (group.keys[m] != closed[list[m]].key() || !alike(group.faces[m], closed[list[m]].face))
        return false;
    return true;
  }


  void
  PairPreconditioner::make_groups(const std::vector<std::vector<unsigned int>> &lists)
  {
    std::map<Key, std::unique_ptr<Group>> old_groups;
    for (auto &group : groups)
      old_groups[group->keys.front()] = std::move(group);
    groups.clear();
    std::vector<bool> is_new;
    for (const auto &list : lists)
      {
        const auto old = old_groups.find(closed[list.front()].key());
        is_new.push_back(old == old_groups.end() || !serves(*old->second, list));
        groups.push_back(is_new.back() ? std::make_unique<Group>() : std::move(old->second));
        Group &group  = *groups.back();
        group.members = list;
        for (std::size_t m = 0; m < list.size(); ++m)
          if (is_new.back())
            {
              group.keys.push_back(closed[list[m]].key());
              group.faces.push_back(closed[list[m]].face);
            }
          else
            closed[list[m]].face = group.faces[m];
      }
    number_rows();
    gather_entries(is_new);
    for (auto begin = entries.cbegin(); begin != entries.cend();)
      {
        const unsigned int group = group_of[begin->pair];
        const auto end           = std::find_if(begin, entries.cend(), [&](const Entry &entry) {
          return group_of[entry.pair] != group;
        });
        factorize(*groups[group], begin, end);
        begin = end;
      }
  }


  void
  PairPreconditioner::number_rows()
  {
    group_of.resize(closed.size());
    first_row.resize(closed.size());
    directions.resize(closed.size());
    for (unsigned int g = 0; g < groups.size(); ++g)
      {
        groups[g]->n_rows = 0;
        for (const unsigned int c : groups[g]->members)
          {
            group_of[c]   = g;
            first_row[c]  = groups[g]->n_rows;
            directions[c] = Directions(closed[c].face);
            groups[g]->n_rows += directions[c].n;
          }
      }
  }


  void
  PairPreconditioner::gather_entries(const std::vector<bool> &is_new)
  {
    std::vector<Entry> own_entries;
    for (unsigned int j = 0; j < own.size(); ++j)
      {
        const unsigned int i = own[j], c = first_own + j;
        if (!is_new[group_of[c]])
          continue;
        for (unsigned int row = 0; row < directions[c].n; ++row)
          {
            const auto in_axes = [&](const Tensor<1, 3> &v) {
              return delassus->scale()[i] * (v * delassus->frame(i));
            };
            const auto along = in_axes(directions[c].e[row]);
            const auto force = in_axes(closed[c].face.lift(directions[c].e[row]));
            for (unsigned int k = 0; k < pairs[i]->n_nodes; ++k)
              {
                const unsigned int node = pairs[i]->nodes[k];
                if (mobility.is_held(node))
                  continue;
                own_entries.push_back(
                  {mobility.is_common(node) ? numbers::invalid_dof_index : nodes.id(node),
                   c,
                   first_row[c] + row,
                   pairs[i]->at_node(k, force),
                   mobility[node] * pairs[i]->at_node(k, along) / mass_factor});
              }
          }
      }
    const MPI_Comm communicator = nodes.get_communicator();
    gather(own_entries, numbers_of_items(own_entries.size(), communicator), entries, communicator);
    std::stable_sort(entries.begin(), entries.end(), [&](const Entry &a, const Entry &b) {
      return std::make_tuple(group_of[a.pair], a.node, a.row) <
             std::make_tuple(group_of[b.pair], b.node, b.row);
    });
  }


  void
  PairPreconditioner::factorize(Group &group,
                                const std::vector<Entry>::const_iterator begin,
                                const std::vector<Entry>::const_iterator end)
  {
    constexpr double rounding = 1e-12; // of what is zero between orthogonal directions

    group.symmetric = std::none_of(group.faces.begin(), group.faces.end(), [](const auto &face) {
      return face.tangential == CoulombFace::Tangential::circle && face.mu != 0.;
    });
    triplets.clear();
    const auto add = [&](const Entry &row, const Entry &column) {
      if (const double value = column.force * row.increment; std::abs(value) > rounding)
        triplets.emplace_back(row.row, column.row, value);
    };
    for (const unsigned int c : group.members)
      for (unsigned int j = 0; j < directions[c].n; ++j)
        {
          const bool turns = closed[c].face.tangential == CoulombFace::Tangential::circle &&
                             directions[c].e[j] == closed[c].face.along;
          triplets.emplace_back(first_row[c] + j,
                                first_row[c] + j,
                                shift + (turns ? closed[c].face.curvature : 0.));
        }
    auto of_node = begin;
    for (auto entry = begin; entry != end; ++entry)
      {
        if (entry->node != of_node->node)
          of_node = entry;
        const bool rigid = entry->node == numbers::invalid_dof_index;
        for (auto other = rigid ? entry : of_node; other <= entry; ++other)
          {
            add(*entry, *other);
            if (!group.symmetric && other != entry)
              add(*other, *entry);
          }
      }
    group.valid = group.symmetric ? group.cholesky.compute(group.n_rows, triplets) :
                                    group.lu.compute(group.n_rows, triplets);
  }


  void
  PairPreconditioner::apply(const Vector &r, Vector &z)
  {
    own_values.resize(own.size());
    for (unsigned int j = 0; j < own.size(); ++j)
      {
        const Directions &d = directions[first_own + j];
        own_values[j].clear();
        for (unsigned int row = 0; row < d.n; ++row)
          own_values[j][row] = d.e[row] * r[own[j]];
      }
    gather(own_values, n_closed, all_values, nodes.get_communicator());
    for (const auto &group : groups)
      {
        values.resize(group->n_rows);
        for (const unsigned int c : group->members)
          for (unsigned int row = 0; row < directions[c].n; ++row)
            values[first_row[c] + row] = all_values[c][row];
        if (group->valid && group->symmetric)
          group->cholesky.solve_in_place(values);
        else if (group->valid)
          group->lu.solve_in_place(values);
        for (const unsigned int c : group->members)
          for (unsigned int row = 0; row < directions[c].n; ++row)
            all_values[c][row] = values[first_row[c] + row];
      }
    z = r;
    for (unsigned int j = 0; j < own.size(); ++j)
      {
        const Directions &d = directions[first_own + j];
        for (unsigned int row = 0; row < d.n; ++row)
          z[own[j]] += (all_values[first_own + j][row] - own_values[j][row]) * d.e[row];
      }
  }
} // namespace akmon
