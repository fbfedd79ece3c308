#pragma once

#include <Eigen/SparseCore>
#include <memory>
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

    MatrixFactor();
    ~MatrixFactor();

    /**
     * Entries of the same place are added.
     * @param symmetric  only entries of the lower triangle are given
     * @return whether the matrix is positive definite, or not singular to rounding
     */
    bool
    compute(const unsigned int n, const Entries &entries, const bool symmetric);

    /// The same of a full matrix, of which only the lower triangle counts if it is symmetric.
    bool
    compute(const Eigen::MatrixXd &matrix, const bool symmetric);

    void
    solve_in_place(Eigen::VectorXd &values) const;

  private:
    struct Factors; // of Eigen, whose headers take long to compile
    std::unique_ptr<Factors> factors;
  };
} // namespace akmon
