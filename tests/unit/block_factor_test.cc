#include <akmon/contact/coupled/block_factor.h>

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "support/report.h"

// Factors of sparse matrices of blocks against those of the full matrix.

namespace block_factor_test
{
  using akmon::BlockFactor;
  using akmon::test::report;

  // Points of a square grid, each coupled with those around it, as pairs of an interface are.
  struct Grid
  {
    Grid(const unsigned int m, const bool symmetric)
      : diagonal(m * m)
      , matrix(Eigen::MatrixXd::Zero(3 * m * m, 3 * m * m))
    {
      for (unsigned int a = 0; a < m * m; ++a)
        {
          diagonal[a] = block(a, a, symmetric);
          for (unsigned int b = 0; b < a; ++b)
            if (distance(a / m, b / m) <= 1 && distance(a % m, b % m) <= 1)
              {
                couplings.push_back({a, b, block(a, b, false), {}});
                couplings.back().ba = symmetric ? transpose(couplings.back().ab) :
                                                  block(b, a, false);
                put(couplings.back().ba, b, a);
              }
        }
    }

    static unsigned int
    distance(const unsigned int i, const unsigned int j)
    {
      return i > j ? i - j : j - i;
    }

    static BlockFactor::Block
    transpose(const BlockFactor::Block &block)
    {
      BlockFactor::Block result;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          result.rows[i][j] = block.rows[j][i];
      return result;
    }

    void
    put(const BlockFactor::Block &block, const unsigned int a, const unsigned int b)
    {
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          matrix(3 * a + i, 3 * b + j) = block.rows[i][j];
    }

    BlockFactor::Block
    block(const unsigned int a, const unsigned int b, const bool symmetric)
    {
      BlockFactor::Block result;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          result.rows[i][j] = 0.1 * uniform(random) + (a == b && i == j ? 1. : 0.);
      if (symmetric)
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = 0; j < i; ++j)
            result.rows[i][j] = result.rows[j][i];
      put(result, a, b);
      return result;
    }

    // Over the norm of the solution.
    double
    error_of(const BlockFactor &factor)
    {
      const unsigned int n = diagonal.size();
      Eigen::VectorXd x(3 * n);
      for (unsigned int i = 0; i < 3 * n; ++i)
        x[i] = uniform(random);
      const Eigen::VectorXd b = matrix * x;
      BlockFactor::Vector values(n);
      for (unsigned int i = 0; i < 3 * n; ++i)
        values[i / 3][i % 3] = b[i];
      factor.solve_in_place(values);
      double squares = 0.;
      for (unsigned int i = 0; i < 3 * n; ++i)
        squares += (values[i / 3][i % 3] - x[i]) * (values[i / 3][i % 3] - x[i]);
      return std::sqrt(squares) / x.norm();
    }

    std::mt19937 random;
    std::uniform_real_distribution<double> uniform{-1., 1.};
    std::vector<BlockFactor::Block> diagonal;
    std::vector<BlockFactor::Coupling> couplings;
    Eigen::MatrixXd matrix;
  };


  TEST(BlockFactor, solves)
  {
    BlockFactor factor;
    for (const unsigned int m : {1U, 2U, 16U, 5U}) // larger and smaller ones in turn
      for (const bool symmetric : {true, false})
        {
          Grid grid(m, symmetric);
          ASSERT_TRUE(factor.compute(grid.diagonal, grid.couplings));
          const double error = grid.error_of(factor);
          report("error", error);
          EXPECT_LT(error,
                    1e-13 * Eigen::PartialPivLU<Eigen::MatrixXd>(grid.matrix).inverse().norm());
        }
  }


  TEST(BlockFactor, tells_of_a_singular_matrix)
  {
    Grid grid(4, false);
    auto singular     = grid.diagonal;
    singular[5]       = {};
    auto no_couplings = grid.couplings;
    no_couplings.clear();
    BlockFactor factor;
    EXPECT_FALSE(factor.compute(singular, no_couplings));
    ASSERT_TRUE(factor.compute(grid.diagonal, grid.couplings)); // and serves again
    EXPECT_LT(grid.error_of(factor), 1e-10);
  }
} // namespace block_factor_test
