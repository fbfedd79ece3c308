#include <akmon/contact/coupled/block_factor.h>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <limits>

namespace akmon
{
  namespace
  {
    using Block = BlockFactor::Block;

    constexpr unsigned int none = std::numeric_limits<unsigned int>::max();


    Block
    product(const Block &a, const Block &b)
    {
      Block result;
      for (unsigned int i = 0; i < 3; ++i)
        result.rows[i] = a.rows[i][0] * b.rows[0] + a.rows[i][1] * b.rows[1] +
                         a.rows[i][2] * b.rows[2];
      return result;
    }


    // c - a b
    void
    subtract_product(const Block &a, const Block &b, Block &c)
    {
      const BlockFactor::Row b_0 = b.rows[0], b_1 = b.rows[1], b_2 = b.rows[2];
      for (unsigned int i = 0; i < 3; ++i)
        c.rows[i] -= a.rows[i][0] * b_0 + a.rows[i][1] * b_1 + a.rows[i][2] * b_2;
    }


    // c - a b for a vector of three.
    void
    subtract_product(const Block &a, const std::array<double, 3> &b, std::array<double, 3> &c)
    {
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int k = 0; k < 3; ++k)
          c[i] -= a.rows[i][k] * b[k];
    }


    // False where the determinant is nothing against the entries, or no number.
    bool
    invert(const Block &a, Block &inverse)
    {
      constexpr double least = 1e-14;

      const auto &m = a.rows;
      double size   = 0.;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          {
            const unsigned int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3,
                               j2 = (j + 2) % 3;
            inverse.rows[j][i]    = m[i1][j1] * m[i2][j2] - m[i1][j2] * m[i2][j1];
            size                  = std::max(size, std::abs(m[i][j]));
          }
      const double determinant = m[0][0] * inverse.rows[0][0] + m[0][1] * inverse.rows[1][0] +
                                 m[0][2] * inverse.rows[2][0];
      if (!(std::abs(determinant) > least * size * size * size))
        return false;
      for (auto &of_row : inverse.rows)
        for (unsigned int j = 0; j < 3; ++j)
          of_row[j] /= determinant;
      return true;
    }
  } // namespace


  bool
  BlockFactor::compute(const std::vector<Block> &diagonal, const std::vector<Coupling> &couplings)
  {
    const unsigned int n = diagonal.size();
    find_order(n, couplings);
    columns.resize(std::max<std::size_t>(columns.size(), n)); // that have storage
    for (auto &of_column : columns)
      of_column.clear();
    inverses.assign(n, {});
    for (auto *const blocks : {&row, &column})
      blocks->assign(n, {});
    for (auto *const numbers : {&parents, &marks})
      numbers->assign(n, none);
    std::vector<unsigned int> rows(n);
    for (unsigned int i = 0; i < n; ++i)
      rows[positions[i]] = i;
    for (unsigned int i = 0; i < n; ++i)
      {
        take_row(i, couplings);
        Block pivot = diagonal[rows[i]];
        for (const unsigned int k : reach)
          {
            const Block lower = product(row[k], inverses[k]), upper = column[k];
            row[k] = column[k] = Block();
            for (const Entry &known : columns[k])
              {
                subtract_product(lower, known.upper, row[known.row]);
                subtract_product(known.lower, upper, column[known.row]);
              }
            subtract_product(lower, upper, pivot);
            columns[k].push_back({i, lower, upper});
          }
        if (!invert(pivot, inverses[i]))
          return false;
      }
    return true;
  }


  void
  BlockFactor::find_order(const unsigned int n, const std::vector<Coupling> &couplings)
  {
    std::vector<Eigen::Triplet<double>> pattern;
    for (unsigned int i = 0; i < n; ++i) // without, the order is left as it is
      pattern.emplace_back(i, i, 1.);
    for (const Coupling &coupling : couplings)
      {
        pattern.emplace_back(coupling.a, coupling.b, 1.);
        pattern.emplace_back(coupling.b, coupling.a, 1.);
      }
    Eigen::SparseMatrix<double> graph(n, n);
    graph.setFromTriplets(pattern.begin(), pattern.end());
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
    Eigen::AMDOrdering<int>()(graph, order);
    positions.resize(n);
    for (unsigned int i = 0; i < n; ++i)
      positions[order.indices()[i]] = i;

    couplings_at.fill(n, couplings.size(), [&](const unsigned int c) {
      return std::max(positions[couplings[c].a], positions[couplings[c].b]);
    });
  }


  // Row and column i of A as far as the diagonal, and where those of the factors are not zero: in
  // rising order.
  void
  BlockFactor::take_row(const unsigned int i, const std::vector<Coupling> &couplings)
  {
    reach.clear();
    marks[i] = i;
    for (const unsigned int c : couplings_at[i])
      {
        const Coupling &coupling = couplings[c];
        const bool a_is_later    = positions[coupling.a] == i;
        const unsigned int k     = positions[a_is_later ? coupling.b : coupling.a];
        row[k]                   = a_is_later ? coupling.ab : coupling.ba;
        column[k]                = a_is_later ? coupling.ba : coupling.ab;
        mark_up_from(k, i);
      }
    std::sort(reach.begin(), reach.end());
  }


  // Along the elimination tree.
  void
  BlockFactor::mark_up_from(unsigned int k, const unsigned int i)
  {
    while (marks[k] != i)
      {
        marks[k] = i;
        reach.push_back(k);
        if (parents[k] == none)
          parents[k] = i;
        k = parents[k];
      }
  }


  std::size_t
  BlockFactor::n_entries() const
  {
    std::size_t n = 0;
    for (const auto &of_column : columns)
      n += of_column.size();
    return n;
  }


  void
  BlockFactor::solve_in_place(Vector &values) const
  {
    const unsigned int n = positions.size();
    permuted.resize(n);
    for (unsigned int i = 0; i < n; ++i)
      permuted[positions[i]] = values[i];
    for (unsigned int k = 0; k < n; ++k)
      for (const Entry &entry : columns[k])
        subtract_product(entry.lower, permuted[k], permuted[entry.row]);
    for (unsigned int k = n; k-- > 0;)
      {
        auto sum = permuted[k];
        for (const Entry &entry : columns[k])
          subtract_product(entry.upper, permuted[entry.row], sum);
        permuted[k] = {};
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = 0; j < 3; ++j)
            permuted[k][i] += inverses[k].rows[i][j] * sum[j];
      }
    for (unsigned int i = 0; i < n; ++i)
      values[i] = permuted[positions[i]];
  }
} // namespace akmon
