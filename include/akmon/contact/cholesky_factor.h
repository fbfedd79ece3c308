#pragma once

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <vector>

namespace akmon
{
  /**
   * Cholesky factor of a symmetric positive definite matrix given by the entries of its lower
   * triangle: sparse, or full where the matrix is so small that ordering it would take longer.
   */
  class CholeskyFactor
  {
  public:
    using Entries = std::vector<Eigen::Triplet<double>>;

    /// Entries of the same place are added. False if the matrix is not positive definite.
    bool
    compute(const unsigned int n, const Entries &entries)
    {
      constexpr unsigned int most_full = 200; // rows
      is_full                          = n <= most_full;
      if (is_full)
        {
          matrix.setZero(n, n);
          for (const auto &entry : entries)
            matrix(entry.row(), entry.col()) += entry.value();
          full.compute(matrix);
          return full.info() == Eigen::Success;
        }
      Eigen::SparseMatrix<double> sparse_matrix(n, n);
      sparse_matrix.setFromTriplets(entries.begin(), entries.end());
      sparse.compute(sparse_matrix);
      return sparse.info() == Eigen::Success;
    }

    void
    solve_in_place(Eigen::VectorXd &values) const
    {
      if (is_full)
        full.solveInPlace(values);
      else
        values = sparse.solve(values).eval();
    }

  private:
    bool is_full = true;
    Eigen::MatrixXd matrix;
    Eigen::LLT<Eigen::MatrixXd> full;
    Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> sparse;
  };
} // namespace akmon
