#pragma once

#include <Eigen/SparseCore>
#include <memory>
#include <vector>

namespace akmon
{
  /**
   * Triangular factors of a square matrix: of a symmetric positive definite one, full or sparse,
   * the Cholesky factor, made of its lower triangle; of other full ones with pivoting.
   */
  class MatrixFactor
  {
  public:
    MatrixFactor();
    ~MatrixFactor();

    /// @return whether the matrix is positive definite, or not singular to rounding
    bool
    compute(const Eigen::MatrixXd &matrix, const bool symmetric);

    using Entries = std::vector<Eigen::Triplet<double>>;

    /// The same of a sparse symmetric matrix of @p n rows; entries of the same place are added.
    bool
    compute(const unsigned int n, const Entries &lower_triangle);

    void
    solve_in_place(Eigen::VectorXd &values) const;

  private:
    struct Factors; // of Eigen, whose headers take long to compile
    std::unique_ptr<Factors> factors;
  };
} // namespace akmon
