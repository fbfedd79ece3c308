#include <akmon/contact/cholesky_factor.h>

#include <gtest/gtest.h>

#include <cmath>

namespace
{
  using akmon::CholeskyFactor;

  // The second difference with 2.5 on its diagonal, each entry in two parts, lower triangle only.
  CholeskyFactor::Entries
  chain(const unsigned int n, const double diagonal)
  {
    CholeskyFactor::Entries entries;
    for (unsigned int i = 0; i < n; ++i)
      {
        entries.emplace_back(i, i, diagonal - 1.);
        entries.emplace_back(i, i, 1.);
        if (i > 0)
          entries.emplace_back(i, i - 1, -1.);
      }
    return entries;
  }


  class Cholesky : public testing::TestWithParam<unsigned int>
  {
  };


  TEST_P(Cholesky, solves)
  {
    const unsigned int n = GetParam();
    CholeskyFactor factor;
    ASSERT_TRUE(factor.compute(n, chain(n, 2.5)));
    Eigen::VectorXd x(n), b(n);
    for (unsigned int i = 0; i < n; ++i)
      x[i] = std::sin(1. + i);
    for (unsigned int i = 0; i < n; ++i)
      b[i] = 2.5 * x[i] - (i > 0 ? x[i - 1] : 0.) - (i + 1 < n ? x[i + 1] : 0.);
    factor.solve_in_place(b);
    EXPECT_LT((b - x).norm(), 1e-13 * n);
  }


  TEST_P(Cholesky, tells_of_indefinite_matrices)
  {
    CholeskyFactor factor;
    EXPECT_FALSE(factor.compute(GetParam(), chain(GetParam(), 0.5)));
    EXPECT_TRUE(factor.compute(GetParam(), chain(GetParam(), 2.5))); // and serves again
  }


  // Full and sparse.
  INSTANTIATE_TEST_SUITE_P(Rows, Cholesky, testing::Values(5u, 200u, 201u, 1000u));
} // namespace
