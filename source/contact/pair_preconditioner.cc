#include <akmon/contact/pair_preconditioner.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace akmon
{
  using dealii::Tensor;

  namespace
  {
    constexpr unsigned int none = std::numeric_limits<unsigned int>::max();


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


    bool
    is_open(const CoulombFace &face)
    {
      return !face.normal && face.tangential == CoulombFace::Tangential::none;
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
    old         = true;
    present.clear();
    for (unsigned int i = 0; i < pairs.size(); ++i)
      present.push_back(
        {{pairs[i]->interface, pairs[i]->slot, pairs[i]->reversed, pairs[i]->slave_id}, i});
    std::sort(present.begin(), present.end());
    find_members_again();
  }


  void
  PairPreconditioner::find_members_again()
  {
    member_of_pair.assign(pairs.size(), none);
    for (unsigned int m = 0; m < members.size(); ++m)
      {
        const auto found = std::lower_bound(present.begin(),
                                            present.end(),
                                            std::make_pair(members[m].key, 0u));
        members[m].pair  = found != present.end() && !(members[m].key < found->first) ?
                             found->second :
                             none;
        if (members[m].pair != none)
          member_of_pair[members[m].pair] = m;
      }
  }


  void
  PairPreconditioner::forget()
  {
    valid = false;
  }


  void
  PairPreconditioner::reinit(const std::vector<CoulombFace> &faces, const double new_shift)
  {
    if (shift == new_shift && still_serves(faces))
      return;
    shift = new_shift;
    make_members(faces);
    make_entries();
    factorize();
    old = false;
  }


  bool
  PairPreconditioner::still_serves(const std::vector<CoulombFace> &faces) const
  {
    if (!valid || std::any_of(members.begin(), members.end(), [](const Member &member) {
          return member.pair == none;
        }))
      return false;
    for (unsigned int i = 0; i < pairs.size(); ++i)
      if (delassus->scale()[i] > 0. &&
          !(member_of_pair[i] == none ? is_open(faces[i]) :
                                        alike(members[member_of_pair[i]].face, faces[i])))
        return false;
    return true;
  }


  void
  PairPreconditioner::make_members(const std::vector<CoulombFace> &faces)
  {
    members.clear();
    n_rows = 0;
    for (const auto &[key, i] : present)
      {
        if (is_open(faces[i]) || !(delassus->scale()[i] > 0.))
          continue;
        Member member{key, i, faces[i], n_rows, 0, {}};
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
        n_rows += member.n_rows;
        members.push_back(member);
      }
    find_members_again();
  }


  void
  PairPreconditioner::make_entries()
  {
    entries.clear();
    triplets.clear();
    for (const auto &member : members)
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
  PairPreconditioner::factorize()
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
    Eigen::SparseMatrix<double> matrix(n_rows, n_rows);
    matrix.setFromTriplets(triplets.begin(), triplets.end());
    cholesky.compute(matrix);
    valid = n_rows == 0 || cholesky.info() == Eigen::Success;
    if (!valid)
      {
        members.clear();
        member_of_pair.assign(pairs.size(), none);
        n_rows = 0;
      }
  }


  void
  PairPreconditioner::apply(const Vector &r, Vector &z)
  {
    z = r;
    if (n_rows == 0)
      return;
    values.setZero(n_rows);
    for (const auto &member : members)
      if (member.pair != none)
        for (unsigned int j = 0; j < member.n_rows; ++j)
          values[member.first_row + j] = member.directions[j] * r[member.pair];
    const Eigen::VectorXd solution = cholesky.solve(values);
    for (const auto &member : members)
      if (member.pair != none)
        for (unsigned int j = 0; j < member.n_rows; ++j)
          {
            const unsigned int row = member.first_row + j;
            z[member.pair] += (solution[row] - values[row]) * member.directions[j];
          }
  }
} // namespace akmon
