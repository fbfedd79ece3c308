#pragma once

#include <akmon/contact/coupled/elimination_fronts.h>
#include <akmon/contact/coupled/front_panel.h>

#include <array>
#include <vector>

namespace akmon
{
  /**
   * Triangular factors of a sparse matrix of 3 x 3 blocks whose pattern is symmetric, without
   * pivoting: for matrices that are close to positive definite ones. Found front by front
   * (EliminationFronts), in each by panels of columns:
   *
   *     F = (A B)   A = L U,   L' = -C U^{-1},   U' = -L^{-1} B,   and what is left: D - L' U'
   *         (C D)
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

    using Vector = std::vector<std::array<double, 3>>;

    /// Three numbers for each block row.
    void
    solve_in_place(Vector &values) const;

  private:
    using Front = EliminationFronts::Front;

    // A range of rows of a front that come one after the other in its parent.
    struct Run
    {
      std::size_t begin, size, begin_in_parent;
    };

    // Where L^{-1}, U^{-1}, L' and U' of a panel are among the factors.
    template <typename Number>
    struct Parts
    {
      Parts(Number *const values, const std::size_t width, const std::size_t n_below);

      static std::size_t
      size(const std::size_t width, const std::size_t n_below);

      Columns<Number> inverse_L, inverse_U, lower, upper;
    };

    void
    take_entries(const unsigned int f,
                 const std::vector<Block> &diagonal,
                 const std::vector<Coupling> &couplings);
    void
    take_changes(const Front &child);
    bool
    eliminate(const Front &front);
    void
    leave_changes(const Front &front);
    void
    load(const Front &front) const;
    void
    store(const Front &front, const bool all) const;
    const double *
    go_forward(const Front &front, const double *factor) const;
    const double *
    go_backward(const Front &front, const double *factor) const;
    void
    multiply(const ConstPanel &A, const std::size_t first, const std::size_t width) const;

    EliminationFronts fronts;
    std::vector<unsigned int> rows; ///< of A, by position
    std::vector<double> factors;    ///< of the panels

    // Scratch.
    std::vector<EliminationFronts::Edge> edges;
    std::vector<double> values;      ///< of the front in work, by columns
    std::size_t stride = 0;          ///< of these
    std::vector<std::size_t> row_of; ///< in that front, by position
    std::vector<unsigned int> open;  ///< fronts that have left changes, the last one's last
    std::vector<double> changes;     ///< of these
    std::vector<Run> runs;
    mutable Vector permuted;              ///< by position
    mutable std::vector<double> of_front; ///< the rows of one
  };
} // namespace akmon
