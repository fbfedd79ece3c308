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

    // The entries on the diagonal in two parts.
    MatrixFactor::Entries
    entries(const unsigned int n, const bool lower_only = false) const
    {
      MatrixFactor::Entries result;
      for (unsigned int i = 0; i < n; ++i)
        {
          result.emplace_back(i, i, diagonal - 1.);
          result.emplace_back(i, i, 1.);
          if (i > 0)
            result.emplace_back(i, i - 1, left);
          if (i + 1 < n && !lower_only)
            result.emplace_back(i, i + 1, right);
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
    ASSERT_TRUE(factor.compute(n, second_difference.entries(n, true), true));
    expect_solution(factor, second_difference);
  }


  TEST_P(Rows, tell_of_an_indefinite_matrix)
  {
    EXPECT_FALSE(factor.compute(n, indefinite.entries(n, true), true));
    ASSERT_TRUE(factor.compute(n, second_difference.entries(n, true), true)); // and serve again
    expect_solution(factor, second_difference);
  }


  // With a small diagonal too, where rows change places.
  TEST_P(Rows, of_matrices_that_are_not_symmetric)
  {
    for (const Chain &chain : {Chain{2.5, -1.7, 0.3}, Chain{0.5, -1.5, 1.5}})
      {
        ASSERT_TRUE(factor.compute(n, chain.entries(n), false));
        expect_solution(factor, chain);
      }
  }


  TEST_P(Rows, tell_of_a_singular_matrix)
  {
    const Chain chain{2.5, -1.7, 0.3};
    auto entries = chain.entries(n);
    for (auto &entry : entries)
      if (entry.row() == 2)
        entry = {2, entry.col(), 0.};
    EXPECT_FALSE(factor.compute(n, entries, false));
    ASSERT_TRUE(factor.compute(n, chain.entries(n), false)); // and serve again
    expect_solution(factor, chain);
  }


  // Full and sparse.
  INSTANTIATE_TEST_SUITE_P(Matrix, Rows, testing::Values(5u, 170u, 171u, 1000u));
} // namespace matrix_factor_test
