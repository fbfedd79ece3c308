#include <akmon/contact/projected_cg.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "support/report.h"

// The solver of the coupled contact problem alone: small complementarity problems, regular and
// singular, against the enumeration of all active sets; friction discs against a plain projected
// gradient run to the end.

namespace
{
  using namespace akmon;
  using namespace akmon::test;

  using Vector = dealii::Tensor<1, 3>;
  using Matrix = std::vector<std::vector<double>>;

  constexpr double tolerance = 1e-12;


  double
  norm_bound(const Matrix &A)
  {
    double largest = 0.;
    for (const auto &row : A)
      {
        double sum = 0.;
        for (const double a : row)
          sum += std::abs(a);
        largest = std::max(largest, sum);
      }
    return largest;
  }


  // min (1/2) t . A t + b . t with A = G G^T scaled to a unit diagonal and b = G f + gaps, gaps >=
  // 0: bounded below whatever the rank of G is.
  struct Problem
  {
    Problem(const unsigned int n, const unsigned int n_repeated, const unsigned int seed)
      : A(n, std::vector<double>(n))
      , b(n)
    {
      std::mt19937 random(seed);
      std::normal_distribution<double> normal;
      Matrix G(n, std::vector<double>(n));
      for (unsigned int i = 0; i < n; ++i)
        for (auto &g : G[i])
          g = normal(random);
      for (unsigned int i = 0; i < n_repeated; ++i)
        G[n - 1 - i] = G[i];
      for (auto &row : G)
        {
          double square = 0.;
          for (const double g : row)
            square += g * g;
          for (double &g : row)
            g /= std::sqrt(square);
        }
      std::vector<double> f(n);
      for (auto &f_k : f)
        f_k = normal(random);
      for (unsigned int i = 0; i < n; ++i)
        {
          // Every other gap is closed; rows that repeat each other may have different gaps.
          b[i] = i % 2 ? 0. : 0.1 * std::abs(normal(random));
          for (unsigned int k = 0; k < n; ++k)
            b[i] += G[i][k] * f[k];
          for (unsigned int j = 0; j < n; ++j)
            for (unsigned int k = 0; k < n; ++k)
              A[i][j] += G[i][k] * G[j][k];
        }
    }

    template <typename T>
    void
    apply(const std::vector<T> &t, std::vector<T> &y) const
    {
      for (std::size_t i = 0; i < A.size(); ++i)
        {
          y[i] = T();
          for (std::size_t j = 0; j < A.size(); ++j)
            y[i] += A[i][j] * t[j];
        }
    }

    std::vector<double>
    gaps(const std::vector<double> &t) const
    {
      std::vector<double> w(t.size());
      apply(t, w);
      for (std::size_t i = 0; i < t.size(); ++i)
        w[i] += b[i];
      return w;
    }

    Matrix A;
    std::vector<double> b;
  };


  // Cholesky's solution of A_SS t_S = -b_S for the set of bits S; false if A_SS is singular.
  bool
  solve_on_set(const Problem &problem, const unsigned int set, std::vector<double> &t)
  {
    std::vector<unsigned int> S;
    for (unsigned int i = 0; i < problem.b.size(); ++i)
      if (set & (1u << i))
        S.push_back(i);
    const unsigned int m = S.size();
    Matrix L(m, std::vector<double>(m));
    std::vector<double> y(m);
    for (unsigned int i = 0; i < m; ++i)
      {
        for (unsigned int j = 0; j <= i; ++j)
          {
            double sum = problem.A[S[i]][S[j]];
            for (unsigned int k = 0; k < j; ++k)
              sum -= L[i][k] * L[j][k];
            if (i == j && sum < 1e-10)
              return false;
            L[i][j] = i == j ? std::sqrt(sum) : sum / L[j][j];
          }
        y[i] = -problem.b[S[i]];
        for (unsigned int k = 0; k < i; ++k)
          y[i] -= L[i][k] * y[k];
        y[i] /= L[i][i];
      }
    t.assign(problem.b.size(), 0.);
    for (unsigned int i = m; i-- > 0;)
      {
        for (unsigned int k = i + 1; k < m; ++k)
          y[i] -= L[k][i] * y[k];
        t[S[i]] = y[i] /= L[i][i];
      }
    return true;
  }


  // A solution by trying all active sets: there is one whose A_SS is regular.
  std::vector<double>
  enumerate(const Problem &problem)
  {
    std::vector<double> t;
    for (unsigned int set = 0; set < (1u << problem.b.size()); ++set)
      if (solve_on_set(problem, set, t))
        {
          const auto w    = problem.gaps(t);
          bool admissible = true;
          for (std::size_t i = 0; i < t.size(); ++i)
            admissible = admissible && t[i] >= -1e-11 && w[i] >= -1e-11;
          if (admissible)
            return t;
        }
    ADD_FAILURE() << "no active set";
    return t;
  }


  template <typename Set, typename Unknown>
  typename ProjectedConjugateGradients<Set>::Result
  solve(const Problem &problem,
        const std::vector<Unknown> &b,
        const Set &set,
        std::vector<Unknown> &t,
        const unsigned int limit = 1000)
  {
    ProjectedConjugateGradients<Set> solver(MPI_COMM_SELF, tolerance, limit);
    return solver.solve([&](const std::vector<Unknown> &tau,
                            std::vector<Unknown> &y) { problem.apply(tau, y); },
                        b,
                        set,
                        std::vector<double>(b.size(), 1.),
                        norm_bound(problem.A),
                        t);
  }


  // Number of rows and how many of them repeat others.
  class Complementarity : public testing::TestWithParam<std::pair<unsigned int, unsigned int>>
  {
  };


  TEST_P(Complementarity, agrees_with_the_enumeration_of_active_sets)
  {
    const auto [n, n_repeated] = GetParam();
    unsigned int most = 0, sum = 0;
    for (unsigned int seed = 1; seed <= 50; ++seed)
      {
        const Problem problem(n, n_repeated, seed);
        std::vector<double> t(n, 0.);
        const auto result = solve(problem, problem.b, HalfLine(), t);
        ASSERT_TRUE(result.converged) << seed << ": residual " << result.residual;
        const auto w = problem.gaps(t), expected = problem.gaps(enumerate(problem));
        for (unsigned int i = 0; i < n; ++i)
          {
            EXPECT_GE(t[i], 0.) << seed;
            EXPECT_GE(w[i], -2. * tolerance) << seed;
            EXPECT_LE(std::min(t[i], w[i]), 1e-10) << seed;
            EXPECT_NEAR(w[i], expected[i], 1e-9) << seed;
          }
        most = std::max(most, result.n_applications);
        sum += result.n_applications;
      }
    report("applications, mean", sum / 50.);
    report("applications, most", most);
  }


  TEST_P(Complementarity, starts_warm)
  {
    const auto [n, n_repeated] = GetParam();
    const Problem problem(n, n_repeated, 7);
    std::vector<double> t(n, 0.);
    const auto cold = solve(problem, problem.b, HalfLine(), t);

    // From the solution: the check of the residual and nothing else (two for the drift of the
    // recursive gradient).
    std::vector<double> again = t;
    EXPECT_LE(solve(problem, problem.b, HalfLine(), again).n_applications, 2u);

    // From close by: not more than from nothing, and the same gaps from wherever.
    auto close = problem.b;
    for (auto &b : close)
      b *= 1. + 1e-6;
    again           = t;
    const auto warm = solve(problem, close, HalfLine(), again);
    EXPECT_LE(warm.n_applications, cold.n_applications);
    again = std::vector<double>(n, 3.);
    ASSERT_TRUE(solve(problem, problem.b, HalfLine(), again).converged);
    const auto w = problem.gaps(t), w_again = problem.gaps(again);
    for (unsigned int i = 0; i < n; ++i)
      EXPECT_NEAR(w[i], w_again[i], 1e-10);
    again = std::vector<double>(n, -3.); // is projected first
    ASSERT_TRUE(solve(problem, problem.b, HalfLine(), again).converged);
  }


  INSTANTIATE_TEST_SUITE_P(Sizes,
                           Complementarity,
                           testing::Values(std::make_pair(1u, 0u),
                                           std::make_pair(2u, 1u),
                                           std::make_pair(5u, 0u),
                                           std::make_pair(8u, 0u),
                                           std::make_pair(8u, 3u),
                                           std::make_pair(10u, 5u)));


  TEST(Complementarity, stops_at_the_limit_and_says_so)
  {
    const Problem problem(10, 0, 3);
    std::vector<double> t(10, 0.);
    const auto result = solve(problem, problem.b, HalfLine(), t, 3);
    EXPECT_FALSE(result.converged);
    EXPECT_GT(result.residual, tolerance);
    EXPECT_LE(result.n_applications, 5u); // a step that meets a bound takes two
    for (const double t_i : t)
      EXPECT_GE(t_i, 0.);
  }


  TEST(Complementarity, of_nothing_is_solved)
  {
    const Problem problem(0, 0, 1);
    std::vector<double> t;
    EXPECT_TRUE(solve(problem, problem.b, HalfLine(), t).converged);
  }


  TEST(Friction, agrees_with_a_plain_projected_gradient)
  {
    unsigned int most = 0;
    for (unsigned int seed = 1; seed <= 30; ++seed)
      {
        const unsigned int n = 6;
        const Problem problem(n, seed % 3, seed);
        std::mt19937 random(seed);
        std::normal_distribution<double> normal;
        std::vector<Vector> b(n);
        Discs discs;
        for (unsigned int i = 0; i < n; ++i)
          {
            // In the plane of x and y, bounded below by the discs; one of no size.
            b[i] = Vector({normal(random), normal(random), 0.});
            discs.radius.push_back(i == 2 ? 0. : std::abs(normal(random)));
          }
        std::vector<Vector> t(n), plain(n), g(n);
        const auto result = solve(problem, b, discs, t);
        EXPECT_TRUE(result.converged) << seed << ": residual " << result.residual;
        most              = std::max(most, result.n_applications);
        const double step = 1. / norm_bound(problem.A);
        for (unsigned int k = 0; k < 100000; ++k)
          {
            problem.apply(plain, g);
            for (unsigned int i = 0; i < n; ++i)
              plain[i] = discs.project(i, plain[i] - step * (g[i] + b[i]));
          }
        std::vector<Vector> y(n), y_plain(n);
        problem.apply(t, y);
        problem.apply(plain, y_plain);
        for (unsigned int i = 0; i < n; ++i)
          {
            const Vector slip = y[i] + b[i];
            EXPECT_LE((y[i] - y_plain[i]).norm(), 1e-8) << seed;
            EXPECT_LE(t[i].norm(), discs.radius[i] * (1. + 1e-14)) << seed;
            if (discs.is_interior(i, t[i])) // sticks
              {
                EXPECT_LE(slip.norm(), 1e-10) << seed;
              }
            else if (discs.radius[i] > 0.) // opposes: |r slip + |slip| t| = 0
              {
                EXPECT_LE((discs.radius[i] * slip + slip.norm() * t[i]).norm(), 1e-9) << seed;
              }
          }
      }
    report("applications, most", most);
  }


  TEST(HalfLine, projects_and_measures)
  {
    const HalfLine set;
    EXPECT_EQ(set.project(0, -2.), 0.);
    EXPECT_EQ(set.project(0, 2.), 2.);
    EXPECT_EQ(set.longest_step(0, 3., 1.5), 2.);
    EXPECT_GT(set.longest_step(0, 3., -1.5), 1e300);
    EXPECT_TRUE(set.is_interior(0, 1e-300));
    EXPECT_FALSE(set.is_interior(0, 0.));
  }


  TEST(Discs, project_and_measure)
  {
    Discs set;
    set.radius = {5., 0.};
    EXPECT_LE((set.project(0, Vector({6., 8., 0.})) - Vector({3., 4., 0.})).norm(), 1e-15);
    EXPECT_EQ(set.project(0, Vector({1., 2., 0.})), Vector({1., 2., 0.}));
    EXPECT_EQ(set.project(1, Vector({1., 2., 0.})).norm(), 0.);
    EXPECT_FALSE(set.is_interior(0, Vector({3., 4., 0.})));
    EXPECT_FALSE(set.is_interior(1, Vector()));
    const Vector t({1., 2., 0.}), p({-1., 0.5, 0.});
    EXPECT_NEAR((t - set.longest_step(0, t, p) * p).norm(), 5., 1e-14);
    EXPECT_GT(set.longest_step(0, t, p), 0.);
    EXPECT_GT(set.longest_step(0, t, Vector()), 1e300);
  }
} // namespace
