#include <akmon/contact/pair_preconditioner.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <type_traits>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // Number of items of every rank.
    std::vector<int>
    numbers_of(const std::size_t n, const MPI_Comm communicator)
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
  } // namespace


  PairPreconditioner::PairPreconditioner(const ContactNodes &nodes,
                                         const Mobility &mobility,
                                         const double shift)
    : nodes(nodes)
    , mobility(mobility)
    , shift(shift)
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
      keys.push_back({pairs[i]->interface, pairs[i]->reversed, pairs[i]->slave_id, pairs[i]->slot});
    const bool same = factor.valid && std::equal(keys.begin(),
                                                 keys.end(),
                                                 factor.keys.begin(),
                                                 factor.keys.end(),
                                                 [](const Key &a, const Key &b) {
                                                   return a.values() == b.values();
                                                 });
    if (Utilities::MPI::min(int(same), nodes.get_communicator()) == 1)
      return;
    factor.keys = std::move(keys);
    factor.old  = false;
    gather_rows(factor);
    factorize(factor, along_normals);
  }


  // In the order of the keys, wherever pairs are.
  void
  PairPreconditioner::gather_rows(Factor &factor)
  {
    std::vector<Row> own_rows;
    std::vector<Entry> own_entries;
    const auto &scales = delassus->scale();
    for (const unsigned int i : factor.members)
      {
        const ContactPair &pair = *pairs[i];
        double diagonal         = shift;
        for (unsigned int k = 0; k < pair.n_nodes; ++k)
          {
            const unsigned int node = pair.nodes[k];
            if (mobility.is_common(node))
              {
                const auto force = scales[i] * pair.at_node(k, pair.normal);
                diagonal += force * (mobility[node] * force) / mass_factor;
                continue;
              }
            const double coefficient = scales[i] * pair.weights[k] *
                                       std::sqrt(mobility.inverse_mass(node) / mass_factor);
            if (coefficient != 0.)
              own_entries.push_back(
                {nodes.id(node), static_cast<unsigned int>(own_rows.size()), coefficient});
          }
        own_rows.push_back({factor.keys[own_rows.size()], diagonal, pair.normal});
      }

    const MPI_Comm communicator = nodes.get_communicator();
    factor.n_members            = numbers_of(own_rows.size(), communicator);
    const auto n_entries        = numbers_of(own_entries.size(), communicator);
    std::vector<Row> gathered;
    gather(own_rows, factor.n_members, gathered, communicator);
    gather(own_entries, n_entries, entries, communicator);

    std::vector<unsigned int> order(gathered.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](const auto a, const auto b) {
      return gathered[a].key.values() < gathered[b].key.values();
    });
    rows.clear();
    factor.rows.resize(order.size());
    for (unsigned int row = 0; row < order.size(); ++row)
      {
        factor.rows[order[row]] = row;
        rows.push_back(gathered[order[row]]);
      }
    std::size_t entry = 0, first = 0;
    for (std::size_t rank = 0; rank < n_entries.size(); ++rank)
      {
        for (const std::size_t end = entry + n_entries[rank]; entry < end; ++entry)
          entries[entry].row = factor.rows[first + entries[entry].row];
        first += factor.n_members[rank];
      }
    std::sort(entries.begin(), entries.end(), [](const Entry &a, const Entry &b) {
      return std::tie(a.node, a.row) < std::tie(b.node, b.row);
    });
  }


  void
  PairPreconditioner::factorize(Factor &factor, const bool along_normals)
  {
    const unsigned int n = rows.size();
    triplets.clear();
    for (unsigned int row = 0; row < n; ++row)
      triplets.emplace_back(row, row, rows[row].diagonal);
    for (auto begin = entries.begin(); begin != entries.end();)
      {
        auto end = begin;
        while (end != entries.end() && end->node == begin->node)
          ++end;
        for (auto a = begin; a != end; ++a)
          for (auto b = begin; b <= a; ++b)
            {
              const double cosine = along_normals ? rows[a->row].normal * rows[b->row].normal : 1.;
              triplets.emplace_back(a->row, b->row, cosine * a->coefficient * b->coefficient);
            }
        begin = end;
      }
    Eigen::SparseMatrix<double> matrix(n, n);
    matrix.setFromTriplets(triplets.begin(), triplets.end());
    factor.cholesky.compute(matrix);
    factor.valid = n == 0 || factor.cholesky.info() == Eigen::Success;
  }


  // Of the values of all members; leaves the solution in the rows of `vectors`.
  void
  PairPreconditioner::solve(const Factor &factor, const unsigned int n_columns)
  {
    gather(values, factor.n_members, all_values, nodes.get_communicator());
    vectors.resize(factor.rows.size(), n_columns);
    for (std::size_t i = 0; i < factor.rows.size(); ++i)
      for (unsigned int d = 0; d < n_columns; ++d)
        vectors(factor.rows[i], d) = all_values[i][d];
    vectors = factor.cholesky.solve(vectors).eval();
  }


  void
  PairPreconditioner::apply(const Vector &r, Vector &z)
  {
    for (std::size_t i = 0; i < r.size(); ++i)
      z[i] = r[i] - (faces[i].curvature / (1. + faces[i].curvature) * (faces[i].along * r[i])) *
                      faces[i].along;

    const unsigned int rank = Utilities::MPI::this_mpi_process(nodes.get_communicator());
    const auto first_row    = [&](const Factor &factor) {
      return std::accumulate(factor.n_members.begin(), factor.n_members.begin() + rank, 0U);
    };
    if (normal.valid && !normal.rows.empty())
      {
        values.clear();
        for (const unsigned int i : normal.members)
          values.push_back(r[i]);
        solve(normal, 1);
        unsigned int j = first_row(normal);
        for (const unsigned int i : normal.members)
          z[i][0] = vectors(normal.rows[j++], 0);
      }
    if (tangential.valid && !tangential.rows.empty())
      {
        // In axes that all pairs share.
        values.clear();
        for (const unsigned int i : tangential.members)
          values.push_back(r[i][1] * delassus->frame(i)[1] + r[i][2] * delassus->frame(i)[2]);
        solve(tangential, 3);
        unsigned int j = first_row(tangential);
        for (const unsigned int i : tangential.members)
          {
            const unsigned int row = tangential.rows[j++];
            const Tensor<1, 3> solution({vectors(row, 0), vectors(row, 1), vectors(row, 2)});
            z[i][1] = delassus->frame(i)[1] * solution;
            z[i][2] = delassus->frame(i)[2] * solution;
          }
      }
  }
} // namespace akmon
