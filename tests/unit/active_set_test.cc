#include <akmon/contact/coupled/active_set.h>

#include <gtest/gtest.h>

#include <random>

#include "support/report.h"

// Forces without friction by a set of active pairs that changes by one at a time: no gap is
// negative, no force pulls, and forces are only where gaps are closed.

namespace active_set_test
{
  using namespace akmon;
  using namespace akmon::test;

  // Rows g of random operators of unit length, for A = G G^T.
  Eigen::MatrixXd
  random_rows(const int n, const int dimension, std::mt19937 &random)
  {
    std::normal_distribution<double> normal;
    Eigen::MatrixXd G(n, dimension);
    for (int i = 0; i < n; ++i)
      {
        for (int k = 0; k < dimension; ++k)
          G(i, k) = normal(random);
        G.row(i).normalize();
      }
    return G;
  }


  // Motions b that some u undoes, G u + b >= 0, so that there is a solution.
  Eigen::VectorXd
  motions(const Eigen::MatrixXd &G, std::mt19937 &random)
  {
    std::normal_distribution<double> normal;
    std::exponential_distribution<double> open;
    const Eigen::VectorXd u    = Eigen::VectorXd::NullaryExpr(G.cols(),
                                                           [&]() { return normal(random); });
    const Eigen::VectorXd gaps = Eigen::VectorXd::NullaryExpr(G.rows(),
                                                              [&]() { return open(random); });
    return gaps - G * u;
  }


  // Largest |min(t, w)|.
  double
  residual(const Eigen::MatrixXd &A, const Eigen::VectorXd &b, const Eigen::VectorXd &t)
  {
    return t.cwiseMin(A * t + b).cwiseAbs().maxCoeff();
  }


  double
  solve(const Eigen::MatrixXd &G, const Eigen::VectorXd &b)
  {
    const Eigen::MatrixXd A = G * G.transpose();
    Eigen::VectorXd t;
    EXPECT_TRUE(solve_by_active_set(A, b, Eigen::VectorXd::Ones(b.size()), 1e-13, t));
    return residual(A, b, t);
  }


  // More pairs than directions: constraints repeat each other.
  TEST(ActiveSet, SolvesSingularProblems)
  {
    double worst = 0.;
    for (unsigned int seed = 1; seed <= 50; ++seed)
      {
        std::mt19937 random(seed);
        const auto G = random_rows(30, 12, random);
        worst        = std::max(worst, solve(G, motions(G, random)));
      }
    report("residual, of 1", worst);
    EXPECT_LE(worst, 1e-12);
  }


  // Each pair is there a second time, a little turned, with a gap that disagrees a little.
  TEST(ActiveSet, SolvesWhereConstraintsNearlyRepeat)
  {
    double worst = 0.;
    for (unsigned int seed = 1; seed <= 50; ++seed)
      {
        std::mt19937 random(seed);
        const auto G = random_rows(15, 20, random);
        Eigen::MatrixXd twice(30, 20);
        twice << G, G + 1e-5 * random_rows(15, 20, random);
        const Eigen::VectorXd b = motions(G, random);
        Eigen::VectorXd of_twice(30);
        of_twice << b, b + 1e-9 * Eigen::VectorXd::Random(15);
        worst = std::max(worst, solve(twice, of_twice));
      }
    report("residual, of 1", worst);
    EXPECT_LE(worst, 1e-12);
  }


  // Two pairs push the same node from opposite sides.
  TEST(ActiveSet, TellsThatThereIsNoSolution)
  {
    Eigen::Matrix2d A;
    A << 1., -1., -1., 1.;
    Eigen::VectorXd t;
    EXPECT_FALSE(
      solve_by_active_set(A, Eigen::Vector2d(-1., -1.), Eigen::Vector2d(1., 1.), 1e-13, t));
  }


  // What nothing can move stays where it is.
  TEST(ActiveSet, LeavesFixedPairs)
  {
    Eigen::VectorXd t;
    EXPECT_TRUE(solve_by_active_set(Eigen::Matrix2d::Zero(),
                                    Eigen::Vector2d(0.5, 0.),
                                    Eigen::Vector2d(1., 1.),
                                    1e-13,
                                    t));
    EXPECT_EQ(t.norm(), 0.);
  }
} // namespace active_set_test
