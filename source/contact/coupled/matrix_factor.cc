#include <akmon/contact/coupled/matrix_factor.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>

namespace akmon
{
  struct MatrixFactor::Factors
  {
    enum class Kind
    {
      cholesky,
      lu,
      sparse_cholesky,
      sparse_lu
    };

    Kind kind = Kind::cholesky;
    Eigen::MatrixXd matrix;
    Eigen::VectorXd permuted;
    Eigen::LLT<Eigen::MatrixXd> cholesky;
    Eigen::PartialPivLU<Eigen::MatrixXd> lu;
    Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> sparse_cholesky;
    Eigen::SparseLU<Eigen::SparseMatrix<double>> sparse_lu;

    bool
    compute_sparse(const unsigned int n, const Entries &entries, const bool symmetric)
    {
      Eigen::SparseMatrix<double> sparse_matrix(n, n);
      sparse_matrix.setFromTriplets(entries.begin(), entries.end());
      kind = symmetric ? Kind::sparse_cholesky : Kind::sparse_lu;
      if (symmetric)
        return sparse_cholesky.compute(sparse_matrix).info() == Eigen::Success;
      sparse_lu.compute(sparse_matrix);
      return sparse_lu.info() == Eigen::Success;
    }

    void
    add_up(const unsigned int n, const Entries &entries)
    {
      matrix.setZero(n, n);
      for (const auto &entry : entries)
        matrix(entry.row(), entry.col()) += entry.value();
    }

    bool
    compute_full(const Eigen::MatrixXd &matrix, const bool symmetric)
    {
      constexpr double rounding = 1e-15;

      kind = symmetric ? Kind::cholesky : Kind::lu;
      if (symmetric)
        return cholesky.compute(matrix).info() == Eigen::Success;
      lu.compute(matrix);
      const auto pivots = lu.matrixLU().diagonal().cwiseAbs();
      return pivots.minCoeff() > rounding * pivots.maxCoeff();
    }
  };


  MatrixFactor::MatrixFactor()
    : factors(std::make_unique<Factors>())
  {
  }


  MatrixFactor::~MatrixFactor() = default;


  bool
  MatrixFactor::compute(const unsigned int n, const Entries &entries, const bool symmetric)
  {
    constexpr unsigned int most_full = 170; // rows

    if (n > most_full)
      return factors->compute_sparse(n, entries, symmetric);
    factors->add_up(n, entries);
    return factors->compute_full(factors->matrix, symmetric);
  }


  bool
  MatrixFactor::compute(const Eigen::MatrixXd &matrix, const bool symmetric)
  {
    return factors->compute_full(matrix, symmetric);
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
        case Factors::Kind::sparse_lu:
          values = factors->sparse_lu.solve(values).eval();
          break;
      }
  }
} // namespace akmon
