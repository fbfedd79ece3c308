#include <akmon/contact/coupled/matrix_factor.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace matrix_factor_test
{
  using akmon::MatrixFactor;

  struct Chain
  {
    double diagonal, left, right;

    // What is above the diagonal does not count in a symmetric matrix.
    Eigen::MatrixXd
    matrix(const unsigned int n, const bool lower_only = false) const
    {
      Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, n);
      for (unsigned int i = 0; i < n; ++i)
        {
          result(i, i) = diagonal;
          if (i > 0)
            result(i, i - 1) = left;
          if (i + 1 < n)
            result(i, i + 1) = lower_only ? 7. : right;
        }
      return result;
    }
  };

  constexpr Chain second_difference{2.5, -1., -1.}, indefinite{0.5, -1., -1.};


  class Rows : public testing::TestWithParam<unsigned int>
  {
  protected:
    void
    expect_solution(const MatrixFactor &factor, const Chain &chain) const
    {
      Eigen::VectorXd x(n), b(n);
      for (unsigned int i = 0; i < n; ++i)
        x[i] = std::sin(1. + i);
      for (unsigned int i = 0; i < n; ++i)
        b[i] = chain.diagonal * x[i] + (i > 0 ? chain.left * x[i - 1] : 0.) +
               (i + 1 < n ? chain.right * x[i + 1] : 0.);
      factor.solve_in_place(b);
      EXPECT_LT((b - x).norm(), 1e-12 * n);
    }

    const unsigned int n = GetParam();
    MatrixFactor factor;
  };


  TEST_P(Rows, of_a_symmetric_matrix)
  {
    ASSERT_TRUE(factor.compute(second_difference.matrix(n, true), true));
    expect_solution(factor, second_difference);
  }


  // Entries of the same place are added.
  TEST_P(Rows, of_a_sparse_matrix)
  {
    for (const Chain &chain : {indefinite, second_difference})
      {
        MatrixFactor::Entries entries;
        for (unsigned int i = 0; i < n; ++i)
          {
            entries.emplace_back(i, i, chain.diagonal - 1.);
            entries.emplace_back(i, i, 1.);
            if (i > 0)
              entries.emplace_back(i, i - 1, chain.left);
          }
        EXPECT_EQ(factor.compute(n, entries), chain.diagonal > 2.);
      }
    expect_solution(factor, second_difference);
  }


  TEST_P(Rows, tell_of_an_indefinite_matrix)
  {
    EXPECT_FALSE(factor.compute(indefinite.matrix(n, true), true));
    ASSERT_TRUE(factor.compute(second_difference.matrix(n, true), true)); // and serve again
    expect_solution(factor, second_difference);
  }


  // With a small diagonal too, where rows change places.
  TEST_P(Rows, of_matrices_that_are_not_symmetric)
  {
    for (const Chain &chain : {Chain{2.5, -1.7, 0.3}, Chain{0.5, -1.5, 1.5}})
      {
        ASSERT_TRUE(factor.compute(chain.matrix(n), false));
        expect_solution(factor, chain);
      }
  }


  TEST_P(Rows, tell_of_a_singular_matrix)
  {
    const Chain chain{2.5, -1.7, 0.3};
    auto matrix = chain.matrix(n);
    matrix.row(2).setZero();
    EXPECT_FALSE(factor.compute(matrix, false));
    ASSERT_TRUE(factor.compute(chain.matrix(n), false)); // and serve again
    expect_solution(factor, chain);
  }


  INSTANTIATE_TEST_SUITE_P(Matrix, Rows, testing::Values(5u, 170u, 171u));
} // namespace matrix_factor_test
