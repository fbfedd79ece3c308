#include <akmon/contact/coupled/matrix_factor.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace akmon
{
  struct MatrixFactor::Factors
  {
    bool is_symmetric = true;
    Eigen::VectorXd permuted;
    Eigen::LLT<Eigen::MatrixXd> cholesky;
    Eigen::PartialPivLU<Eigen::MatrixXd> lu;
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

    factors->is_symmetric = symmetric;
    if (symmetric)
      return factors->cholesky.compute(matrix).info() == Eigen::Success;
    factors->lu.compute(matrix);
    const auto pivots = factors->lu.matrixLU().diagonal().cwiseAbs();
    return pivots.minCoeff() > rounding * pivots.maxCoeff();
  }


  void
  MatrixFactor::solve_in_place(Eigen::VectorXd &values) const
  {
    if (factors->is_symmetric)
      {
        factors->cholesky.solveInPlace(values);
        return;
      }
    factors->permuted.noalias() = factors->lu.permutationP() * values;
    factors->lu.matrixLU().triangularView<Eigen::UnitLower>().solveInPlace(factors->permuted);
    factors->lu.matrixLU().triangularView<Eigen::Upper>().solveInPlace(factors->permuted);
    values.swap(factors->permuted);
  }
} // namespace akmon
