#pragma once

#include <akmon/contact/coupled/buckets.h>

#include <array>
#include <vector>

namespace akmon
{
  /**
   * Triangular factors of a sparse matrix of 3 x 3 blocks whose pattern is symmetric,
   * A = (1 + L) D (1 + D^{-1} U), without pivoting: for matrices that are close to positive
   * definite ones. Rows are ordered for little fill by approximate minimum degree (Amestoy, Davis
   * and Duff, SIAM J. Matrix Anal. Appl. 17, 1996); each is found from those above it, along the
   * elimination tree (up-looking; Davis, Direct Methods for Sparse Linear Systems, 2006, ch. 4).
   */
  class BlockFactor
  {
  public:
    /// Three numbers, and a zero to fill a vector of the processor.
    using Row = double __attribute__((vector_size(32)));

    struct Block
    {
      Row rows[3] = {};
    };

    /// Two block rows that are coupled, and A_ab and A_ba.
    struct Coupling
    {
      unsigned int a, b;
      Block ab, ba;
    };

    /**
     * @param couplings  of different rows, every two once
     * @return whether there are pivots; else there are no factors
     */
    bool
    compute(const std::vector<Block> &diagonal, const std::vector<Coupling> &couplings);

    /// Number of blocks of L, which are as many as those of U.
    std::size_t
    n_entries() const;

    using Vector = std::vector<std::array<double, 3>>;

    /// Three numbers for each block row.
    void
    solve_in_place(Vector &values) const;

  private:
    // L_ik and U_ki of a column k, i below it.
    struct Entry
    {
      unsigned int row;
      Block lower, upper;
    };

    void
    find_order(const unsigned int n, const std::vector<Coupling> &couplings);
    void
    take_row(const unsigned int i, const std::vector<Coupling> &couplings);
    void
    mark_up_from(unsigned int k, const unsigned int i);

    std::vector<unsigned int> positions; ///< in the elimination, by row of A
    Buckets couplings_at;                ///< by the position that comes later
    std::vector<std::vector<Entry>> columns;
    std::vector<Block> inverses; ///< D^{-1}

    // Scratch.
    std::vector<Block> row, column; ///< of the position in work: A_ij and A_ji, less what is known
    std::vector<unsigned int> parents, marks, reach;
    mutable Vector permuted;
  };
} // namespace akmon
