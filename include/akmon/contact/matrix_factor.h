#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>
#include <vector>

namespace akmon
{
  /**
   * Triangular factors of a square matrix given by its entries: sparse, or full where the matrix is
   * so small that ordering it would take longer. Of a symmetric positive definite matrix the
   * Cholesky factor, made of its lower triangle, else with pivoting.
   */
  class MatrixFactor
  {
  public:
    using Entries = std::vector<Eigen::Triplet<double>>;

    /**
     * Entries of the same place are added.
     * @param symmetric  only entries of the lower triangle are given
     * @return whether the matrix is positive definite, or not singular to rounding
     */
    bool
    compute(const unsigned int n, const Entries &entries, const bool symmetric)
    {
      constexpr unsigned int most_full = 170; // rows

      if (n > most_full)
        {
          Eigen::SparseMatrix<double> sparse_matrix(n, n);
          sparse_matrix.setFromTriplets(entries.begin(), entries.end());
          kind = symmetric ? Kind::sparse_cholesky : Kind::sparse_lu;
          if (symmetric)
            return sparse_cholesky.compute(sparse_matrix).info() == Eigen::Success;
          sparse_lu.compute(sparse_matrix);
          return sparse_lu.info() == Eigen::Success;
        }
      matrix.setZero(n, n);
      for (const auto &entry : entries)
        matrix(entry.row(), entry.col()) += entry.value();
      kind = symmetric ? Kind::cholesky : Kind::lu;
      if (symmetric)
        return cholesky.compute(matrix).info() == Eigen::Success;
      lu.compute(matrix);
      const Eigen::ArrayXd pivots = lu.matrixLU().diagonal().cwiseAbs();
      return pivots.minCoeff() > rounding * pivots.maxCoeff();
    }

    void
    solve_in_place(Eigen::VectorXd &values) const
    {
      switch (kind)
        {
          case Kind::cholesky:
            cholesky.solveInPlace(values);
            break;
          case Kind::lu:
            values = lu.solve(values).eval();
            break;
          case Kind::sparse_cholesky:
            values = sparse_cholesky.solve(values).eval();
            break;
          case Kind::sparse_lu:
            values = sparse_lu.solve(values).eval();
            break;
        }
    }

  private:
    static constexpr double rounding = 1e-15;

    enum class Kind
    {
      cholesky,
      lu,
      sparse_cholesky,
      sparse_lu
    };

    Kind kind = Kind::cholesky;
    Eigen::MatrixXd matrix;
    Eigen::LLT<Eigen::MatrixXd> cholesky;
    Eigen::PartialPivLU<Eigen::MatrixXd> lu;
    Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> sparse_cholesky;
    Eigen::SparseLU<Eigen::SparseMatrix<double>> sparse_lu;
  };
} // namespace akmon
