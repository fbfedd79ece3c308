#pragma once

#include <Eigen/LU>
#include <Eigen/SparseLU>
#include <vector>

namespace akmon
{
  /**
   * Triangular factors, with pivoting, of a square matrix given by its entries: sparse, or full
   * where the matrix is so small that ordering it would take longer.
   */
  class LuFactor
  {
  public:
    using Entries = std::vector<Eigen::Triplet<double>>;

    /// Entries of the same place are added. False if the matrix is singular to rounding.
    bool
    compute(const unsigned int n, const Entries &entries)
    {
      constexpr unsigned int most_full = 150; // rows
      constexpr double rounding        = 1e-15;
      is_full                          = n <= most_full;
      if (is_full)
        {
          matrix.setZero(n, n);
          for (const auto &entry : entries)
            matrix(entry.row(), entry.col()) += entry.value();
          full.compute(matrix);
          const Eigen::ArrayXd pivots = full.matrixLU().diagonal().cwiseAbs();
          return pivots.minCoeff() > rounding * pivots.maxCoeff();
        }
      Eigen::SparseMatrix<double> sparse_matrix(n, n);
      sparse_matrix.setFromTriplets(entries.begin(), entries.end());
      sparse.compute(sparse_matrix);
      return sparse.info() == Eigen::Success;
    }

    void
    solve_in_place(Eigen::VectorXd &values) const
    {
      values = (is_full ? Eigen::VectorXd(full.solve(values)) :
                          Eigen::VectorXd(sparse.solve(values)));
    }

  private:
    bool is_full = true;
    Eigen::MatrixXd matrix;
    Eigen::PartialPivLU<Eigen::MatrixXd> full;
    Eigen::SparseLU<Eigen::SparseMatrix<double>> sparse;
  };
} // namespace akmon
