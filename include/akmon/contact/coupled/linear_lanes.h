#pragma once

#include <akmon/simd.h>

#include <vector>

namespace akmon
{
  /**
   * Linear systems with three rows for each of n contact pairs, one system in each SIMD lane.
   * Solved by elimination in blocks of 3 x 3 without pivoting: for matrices that are close to
   * positive definite ones. What becomes of a lane does not depend on the others.
   */
  class LinearLanes
  {
  public:
    using Mask = Lanes::batch_bool_type;

    /// Everything is to be set anew.
    void
    reinit(const unsigned int n_pairs)
    {
      n       = n_pairs;
      columns = 3 * n + 1;
      values.resize(3 * n * columns);
      reciprocal.resize(3 * n);
    }

    Lanes &
    operator()(const unsigned int row, const unsigned int column)
    {
      return values[columns * row + column];
    }

    /// Of a row, and the solution after solve().
    Lanes &
    right_hand(const unsigned int row)
    {
      return values[columns * row + 3 * n];
    }

    /// Solve in place; tells the lanes with pivots.
    Mask
    solve();

  private:
    void
    eliminate(const unsigned int i, const unsigned int k);
    Mask
    factorize_diagonal(const unsigned int i);
    void
    substitute();

    unsigned int n = 0, columns = 1;
    std::vector<Lanes> values;     ///< by row and column; the right-hand side is the last column
    std::vector<Lanes> reciprocal; ///< of the pivots
  };
} // namespace akmon
