#include <akmon/contact/lu_factor.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace
{
  using akmon::LuFactor;

  // A chain with flow along it, the entries on its diagonal in two parts.
  LuFactor::Entries
  chain(const unsigned int n, const double diagonal, const double left, const double right)
  {
    LuFactor::Entries entries;
    for (unsigned int i = 0; i < n; ++i)
      {
        entries.emplace_back(i, i, diagonal - 1.);
        entries.emplace_back(i, i, 1.);
        if (i > 0)
          entries.emplace_back(i, i - 1, left);
        if (i + 1 < n)
          entries.emplace_back(i, i + 1, right);
      }
    return entries;
  }


  class Lu : public testing::TestWithParam<unsigned int>
  {
  };


  // With a small diagonal too, where rows change places.
  TEST_P(Lu, solves)
  {
    const unsigned int n = GetParam();
    for (const auto &[diagonal, left, right] :
         {std::array<double, 3>{{2.5, -1.7, 0.3}}, std::array<double, 3>{{0.5, -1.5, 1.5}}})
      {
        LuFactor factor;
        ASSERT_TRUE(factor.compute(n, chain(n, diagonal, left, right)));
        Eigen::VectorXd x(n), b(n);
        for (unsigned int i = 0; i < n; ++i)
          x[i] = std::sin(1. + i);
        for (unsigned int i = 0; i < n; ++i)
          b[i] = diagonal * x[i] + (i > 0 ? left * x[i - 1] : 0.) +
                 (i + 1 < n ? right * x[i + 1] : 0.);
        factor.solve_in_place(b);
        EXPECT_LT((b - x).norm(), 1e-12 * n);
      }
  }


  TEST_P(Lu, tells_of_singular_matrices)
  {
    const unsigned int n = GetParam();
    auto entries         = chain(n, 2.5, -1.7, 0.3);
    for (auto &entry : entries)
      if (entry.row() == 2)
        entry = {2, entry.col(), 0.};
    LuFactor factor;
    EXPECT_FALSE(factor.compute(n, entries));
    EXPECT_TRUE(factor.compute(n, chain(n, 2.5, -1.7, 0.3))); // and serves again
  }


  // Full and sparse.
  INSTANTIATE_TEST_SUITE_P(Rows, Lu, testing::Values(5u, 150u, 151u, 1000u));
} // namespace
