#include <akmon/contact/coupled/matrix_factor.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SparseCholesky>

namespace akmon
{
  struct MatrixFactor::Factors
  {
    enum class Kind
    {
      cholesky,
      lu,
      sparse_cholesky
    };

    Kind kind = Kind::cholesky;
    Eigen::MatrixXd full;
    Eigen::VectorXd permuted;
    Eigen::LLT<Eigen::MatrixXd> cholesky;
    Eigen::PartialPivLU<Eigen::MatrixXd> lu;
    Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> sparse_cholesky;
  };


  MatrixFactor::MatrixFactor()
    : factors(std::make_unique<Factors>())
  {
  }


  MatrixFactor::~MatrixFactor() = default;


  bool
  MatrixFactor::compute(const Eigen::MatrixXd &matrix, const bool symmetric)
  {
    constexpr double rounding = 1e-15;

    factors->kind = symmetric ? Factors::Kind::cholesky : Factors::Kind::lu;
    if (symmetric)
      return factors->cholesky.compute(matrix).info() == Eigen::Success;
    factors->lu.compute(matrix);
    const auto pivots = factors->lu.matrixLU().diagonal().cwiseAbs();
    return pivots.minCoeff() > rounding * pivots.maxCoeff();
  }


  bool
  MatrixFactor::compute(const unsigned int n, const Entries &lower_triangle)
  {
    constexpr unsigned int most_full = 170; // rows, which would take longer to order

    if (n <= most_full)
      {
        factors->full.setZero(n, n);
        for (const auto &entry : lower_triangle)
          factors->full(entry.row(), entry.col()) += entry.value();
        return compute(factors->full, true);
      }
    factors->kind = Factors::Kind::sparse_cholesky;
    Eigen::SparseMatrix<double> matrix(n, n);
    matrix.setFromTriplets(lower_triangle.begin(), lower_triangle.end());
    return factors->sparse_cholesky.compute(matrix).info() == Eigen::Success;
  }


  void
  MatrixFactor::solve_in_place(Eigen::VectorXd &values) const
  {
    switch (factors->kind)
      {
        case Factors::Kind::cholesky:
          factors->cholesky.solveInPlace(values);
          break;
        case Factors::Kind::lu:
          factors->permuted.noalias() = factors->lu.permutationP() * values;
          factors->lu.matrixLU().triangularView<Eigen::UnitLower>().solveInPlace(factors->permuted);
          factors->lu.matrixLU().triangularView<Eigen::Upper>().solveInPlace(factors->permuted);
          values.swap(factors->permuted);
          break;
        case Factors::Kind::sparse_cholesky:
          values = factors->sparse_cholesky.solve(values).eval();
          break;
      }
  }
} // namespace akmon
