#pragma once

#include <Eigen/Core>
#include <memory>

namespace akmon
{
  /**
   * Triangular factors of a full square matrix: of a symmetric positive definite one the Cholesky
   * factor, made of its lower triangle, else with pivoting.
   */
  class MatrixFactor
  {
  public:
    MatrixFactor();
    ~MatrixFactor();

    /// @return whether the matrix is positive definite, or not singular to rounding
    bool
    compute(const Eigen::MatrixXd &matrix, const bool symmetric);

    void
    solve_in_place(Eigen::VectorXd &values) const;

  private:
    struct Factors; // of Eigen, whose headers take long to compile
    std::unique_ptr<Factors> factors;
  };
} // namespace akmon
