#include <akmon/contact/coupled/pair_preconditioner.h>

#include <algorithm>

// The Jacobian of a group of pairs, and its factors.

namespace akmon
{
  using namespace dealii;

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
    group.valid = group.n_rows > 0 && group.by_rows.compute(jacobian, is_symmetric(group));
  }


  void
  PairPreconditioner::collect_entries(const Group &group)
  {
    entries.clear();
    for (unsigned int m = 0; m < group.members.size(); ++m)
      {
        const Member &member    = group.members[m];
        const ContactPair &pair = (*pairs)[member.pair];
        const auto in_axes      = [&](const Tensor<1, 3> &v) {
          return delassus->scale()[member.pair] * (v * delassus->frame(member.pair));
        };
        std::array<Tensor<1, 3>, 3> along, forces;
        for (unsigned int j = 0; j < member.directions.n; ++j)
          {
            along[j]  = in_axes(member.directions.e[j]);
            forces[j] = in_axes(member.face.lift(member.directions.e[j]));
          }
        for (unsigned int k = 0; k < pair.n_nodes; ++k)
          if (const unsigned int node = pair.nodes[k]; !mobility->is_held(node))
            {
              Entry &entry = entries.emplace_back();
              entry.node   = node;
              entry.member = m;
              entry.force  = {};
              for (unsigned int j = 0; j < member.directions.n; ++j)
                {
                  const auto force = pair.at_node(k, forces[j]);
                  for (unsigned int d = 0; d < 3; ++d)
                    entry.force[d][j] = force[d];
                  entry.increment[j] = mobility->times(pair.at_node(k, along[j]), node) /
                                       mass_factor;
                }
            }
      }
  }


  // The blocks of members that share nodes.
  void
  PairPreconditioner::couple(const Group &group)
  {
    const auto add = [](const Entry &of_rows, const Entry &of_columns, BlockFactor::Block &block) {
      for (unsigned int i = 0; i < 3; ++i)
        block.rows[i] += of_rows.increment[i][0] * of_columns.force[0] +
                         of_rows.increment[i][1] * of_columns.force[1] +
                         of_rows.increment[i][2] * of_columns.force[2];
    };

    entries_at.fill(mobility->size(), entries.size(), [&](const unsigned int i) {
      return entries[i].node;
    });
    coupled_with.assign(group.members.size(), numbers::invalid_unsigned_int);
    coupling_with.resize(group.members.size());
    couplings.clear();
    for (const Entry &entry : entries)
      {
        const unsigned int m = entry.member;
        add(entry, entry, diagonal[m]);
        if (mobility->is_common(entry.node))
          continue;
        for (const unsigned int i : entries_at[entry.node])
          {
            const Entry &other = entries[i];
            if (other.member == m) // and so are those behind, or of later members
              break;
            if (coupled_with[other.member] != m)
              {
                coupled_with[other.member]  = m;
                coupling_with[other.member] = couplings.size();
                couplings.push_back({m, other.member, {}, {}});
              }
            auto &coupling = couplings[coupling_with[other.member]];
            add(entry, other, coupling.ab);
            add(other, entry, coupling.ba);
          }
      }
  }


  void
  PairPreconditioner::factorize(Group &group)
  {
    diagonal.assign(group.members.size(), {});
    for (unsigned int m = 0; m < group.members.size(); ++m)
      for (unsigned int j = 0; j < 3; ++j)
        diagonal[m].rows[j][j] = j < group.members[m].directions.n ?
                                   shift + group.members[m].curvature_along(j) :
                                   1.;
    couple(group);
    group.has_blocks = group.n_rows > group.members.size();
    if (group.has_blocks)
      group.valid = group.by_members.compute(diagonal, couplings);
    else
      factorize_normals(group);
  }


  // Of members that have no other free direction.
  void
  PairPreconditioner::factorize_normals(Group &group)
  {
    // By value: a reference to one number of a vector of the processor is not to be had.
    const auto add = [&](const unsigned int i, const unsigned int j, const double value) {
      lower_triangle.emplace_back(std::max(i, j), std::min(i, j), value);
    };
    lower_triangle.clear();
    for (unsigned int m = 0; m < group.members.size(); ++m)
      add(m, m, diagonal[m].rows[0][0]);
    for (const auto &coupling : couplings)
      add(coupling.a, coupling.b, coupling.ab.rows[0][0]);
    group.valid = group.by_rows.compute(group.members.size(), lower_triangle);
  }
} // namespace akmon
