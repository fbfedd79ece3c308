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
  } // namespace


  PairPreconditioner::PairPreconditioner(const Mobility &mobility, const double shift)
    : mobility(mobility)
    , shift(shift)
  {
  }


  void
  PairPreconditioner::set_pairs(const std::vector<ContactPair *> &new_pairs,
                                const Delassus &new_delassus,
                                const double new_mass_factor)
  {
    pairs              = new_pairs;
    delassus           = &new_delassus;
    const auto &scales = delassus->scale();
    mass_factor        = new_mass_factor;
    entries.clear();
    rigid_share.assign(pairs.size(), 0.);
    for (unsigned int i = 0; i < pairs.size(); ++i)
      for (unsigned int k = 0; k < pairs[i]->n_nodes; ++k)
        {
          const unsigned int node = pairs[i]->nodes[k];
          if (mobility.is_common(node))
            {
              const auto force = scales[i] * pairs[i]->at_node(k, pairs[i]->normal);
              rigid_share[i] += force * (mobility[node] * force) / mass_factor;
              continue;
            }
          const double coefficient = scales[i] * pairs[i]->weights[k] *
                                     std::sqrt(mobility.inverse_mass(node) / mass_factor);
          if (coefficient != 0.)
            entries.push_back({node, i, coefficient});
        }
    std::sort(entries.begin(), entries.end(), [](const Entry &a, const Entry &b) {
      return a.node < b.node;
    });
    normal.old = tangential.old = true;
  }


  void
  PairPreconditioner::forget()
  {
    normal.valid = tangential.valid = false;
  }


  void
  PairPreconditioner::reinit(const std::vector<CoulombFace> &new_faces)
  {
    faces               = new_faces;
    const auto set_rows = [&](Factor &factor, const auto &belongs) {
      factor.members.clear();
      for (unsigned int i = 0; i < faces.size(); ++i)
        if (belongs(faces[i]) && delassus->scale()[i] > 0.)
          factor.members.push_back(i);
    };
    set_rows(normal, [](const CoulombFace &f) { return f.normal; });
    set_rows(tangential,
             [](const CoulombFace &f) { return f.tangential == CoulombFace::Tangential::disc; });
    update(normal, true);
    update(tangential, false);
  }


  void
  PairPreconditioner::update(Factor &factor, const bool along_normals)
  {
    std::vector<Key> keys;
    keys.reserve(factor.members.size());
    for (const unsigned int i : factor.members)
      keys.push_back(pairs[i]->key());
    if (factor.valid && keys == factor.keys)
      return;
    factor.keys = std::move(keys);
    factor.old  = false;
    factorize(factor, along_normals);
  }


  void
  PairPreconditioner::factorize(Factor &factor, const bool along_normals)
  {
    const unsigned int n = factor.members.size();
    row_of_pair.assign(pairs.size(), none);
    for (unsigned int row = 0; row < n; ++row)
      row_of_pair[factor.members[row]] = row;
    triplets.clear();
    for (unsigned int row = 0; row < n; ++row)
      triplets.emplace_back(row, row, shift + rigid_share[factor.members[row]]);
    for (auto begin = entries.begin(); begin != entries.end();)
      {
        auto end = begin;
        while (end != entries.end() && end->node == begin->node)
          ++end;
        for (auto a = begin; a != end; ++a)
          for (auto b = begin; b != end; ++b)
            {
              const unsigned int i = row_of_pair[a->pair], j = row_of_pair[b->pair];
              if (i == none || j == none || i < j)
                continue;
              const double cosine = along_normals ?
                                      pairs[a->pair]->normal * pairs[b->pair]->normal :
                                      1.;
              triplets.emplace_back(i, j, cosine * a->coefficient * b->coefficient);
            }
        begin = end;
      }
    Eigen::SparseMatrix<double> matrix(n, n);
    matrix.setFromTriplets(triplets.begin(), triplets.end());
    factor.cholesky.compute(matrix);
    factor.valid = n == 0 || factor.cholesky.info() == Eigen::Success;
  }


  void
  PairPreconditioner::apply(const Vector &r, Vector &z)
  {
    for (std::size_t i = 0; i < r.size(); ++i)
      z[i] = r[i] - (faces[i].curvature / (1. + faces[i].curvature) * (faces[i].along * r[i])) *
                      faces[i].along;

    if (normal.valid && !normal.members.empty())
      {
        values.resize(normal.members.size());
        for (unsigned int row = 0; row < normal.members.size(); ++row)
          values[row] = r[normal.members[row]][0];
        values = normal.cholesky.solve(values).eval();
        for (unsigned int row = 0; row < normal.members.size(); ++row)
          z[normal.members[row]][0] = values[row];
      }
    if (tangential.valid && !tangential.members.empty())
      {
        vectors.resize(tangential.members.size(), 3);
        for (unsigned int row = 0; row < tangential.members.size(); ++row)
          {
            const unsigned int i = tangential.members[row];
            const auto &F        = delassus->frame(i);
            const auto r_tau     = r[i][1] * F[1] + r[i][2] * F[2];
            for (unsigned int d = 0; d < 3; ++d)
              vectors(row, d) = r_tau[d];
          }
        vectors = tangential.cholesky.solve(vectors).eval();
        for (unsigned int row = 0; row < tangential.members.size(); ++row)
          {
            const unsigned int i = tangential.members[row];
            const Tensor<1, 3> solution({vectors(row, 0), vectors(row, 1), vectors(row, 2)});
            z[i][1] = delassus->frame(i)[1] * solution;
            z[i][2] = delassus->frame(i)[2] * solution;
          }
      }
  }
} // namespace akmon
