#include <akmon/contact/coupled/semismooth_newton.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "support/random_contact.h"
#include "support/report.h"

// The solver of the coupled contact problem alone: small problems, regular and singular, with
// normals in all directions. Without friction against the enumeration of all active sets, with
// friction against the conditions of Signorini and Coulomb, and against a plain projected gradient
// run to the end.

namespace semismooth_newton_test
{
  using namespace akmon;
  using namespace akmon::test;

  constexpr double tolerance = 1e-12;

  using Problem = RandomContact;


  // Cholesky's solution of A_nn t_n = -b_n on the set of bits; false if A_nn is singular there.
  bool
  solve_on_set(const Problem &problem, const unsigned int bits, std::vector<Vector> &t)
  {
    std::vector<unsigned int> set;
    for (unsigned int i = 0; i < problem.b.size(); ++i)
      if (bits & (1u << i))
        set.push_back(i);
    const unsigned int m = set.size();
    DenseMatrix L(m, std::vector<double>(m));
    std::vector<double> y(m);
    for (unsigned int i = 0; i < m; ++i)
      {
        for (unsigned int j = 0; j <= i; ++j)
          {
            double sum = problem.S[set[i]][set[j]] *
                         (problem.frame[set[i]][0] * problem.frame[set[j]][0]);
            for (unsigned int k = 0; k < j; ++k)
              sum -= L[i][k] * L[j][k];
            if (i == j && sum < 1e-10)
              return false;
            L[i][j] = i == j ? std::sqrt(sum) : sum / L[j][j];
          }
        y[i] = -problem.b[set[i]][0];
        for (unsigned int k = 0; k < i; ++k)
          y[i] -= L[i][k] * y[k];
        y[i] /= L[i][i];
      }
    t.assign(problem.b.size(), Vector());
    for (unsigned int i = m; i-- > 0;)
      {
        for (unsigned int k = i + 1; k < m; ++k)
          y[i] -= L[k][i] * y[k];
        y[i] /= L[i][i];
        t[set[i]] = Vector({y[i], 0., 0.});
      }
    return true;
  }


  // A solution without friction by trying all active sets: there is one that is regular.
  std::vector<Vector>
  enumerate(const Problem &problem)
  {
    std::vector<Vector> t;
    for (unsigned int set = 0; set < (1u << problem.b.size()); ++set)
      if (solve_on_set(problem, set, t))
        {
          const auto w    = problem.gaps(t);
          bool admissible = true;
          for (std::size_t i = 0; i < t.size(); ++i)
            admissible = admissible && t[i][0] >= -1e-11 && w[i] >= -1e-11;
          if (admissible)
            return t;
        }
    ADD_FAILURE() << "no active set";
    return t;
  }


  struct Diagonal
  {
    void
    reinit(const std::vector<CoulombFace> &new_faces, const double)
    {
      n_changes += !std::equal(new_faces.begin(),
                               new_faces.end(),
                               faces.begin(),
                               faces.end(),
                               alike);
      faces = new_faces;
    }

    void
    apply(const std::vector<Vector> &r, std::vector<Vector> &z) const
    {
      for (std::size_t i = 0; i < r.size(); ++i)
        {
          const auto &face = faces[i];
          z[i] = r[i] - (face.curvature / (1. + face.curvature) * (face.along * r[i])) * face.along;
        }
    }

    static bool
    is_exact()
    {
      return false;
    }

    bool
    is_made_for(const std::vector<CoulombFace> &, const double) const
    {
      return fits;
    }

    bool fits              = false;
    unsigned int n_changes = 0; ///< of faces
    std::vector<CoulombFace> faces;
  };


  struct Result
  {
    unsigned int n_applications;
    double residual;
    bool converged;
  };


  Result
  solve(const Problem &problem,
        const std::vector<double> &friction,
        std::vector<Vector> &t,
        Diagonal &diagonal,
        const unsigned int limit = 2000,
        const double compliance  = 1e-7)
  {
    SemismoothNewton<const Problem, Diagonal> solver;
    std::vector<CoulombFace> faces;
    const auto result = solver.solve({problem.b,
                                      friction,
                                      std::vector<double>(t.size(), 1.),
                                      norm_bound(problem.S),
                                      compliance,
                                      tolerance,
                                      tolerance,
                                      limit,
                                      false},
                                     problem,
                                     diagonal,
                                     t,
                                     faces);
    return {result.n_applications, result.residual, result.converged};
  }


  Result
  solve(const Problem &problem,
        const std::vector<double> &friction,
        std::vector<Vector> &t,
        const unsigned int limit = 2000,
        const double compliance  = 1e-7)
  {
    Diagonal diagonal;
    return solve(problem, friction, t, diagonal, limit, compliance);
  }


  Result
  solve(const Problem &problem, std::vector<Vector> &t, const unsigned int limit = 2000)
  {
    return solve(problem, std::vector<double>(t.size(), 0.), t, limit);
  }


  // Number of pairs and how many of them repeat others.
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
        std::vector<Vector> t(n);
        const auto result = solve(problem, t);
        ASSERT_TRUE(result.converged) << seed << ": residual " << result.residual;
        const auto w = problem.gaps(t), expected = problem.gaps(enumerate(problem));
        for (unsigned int i = 0; i < n; ++i)
          {
            const double t_n = t[i][0];
            EXPECT_GE(t_n, 0.) << seed;
            EXPECT_EQ(std::hypot(t[i][1], t[i][2]), 0.) << seed;
            EXPECT_GE(w[i], -2. * tolerance) << seed;
            EXPECT_LE(std::min(t_n, w[i]), 1e-10) << seed;
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
    std::vector<Vector> t(n);
    const auto cold = solve(problem, t);

    // From the solution: not more than from nothing.
    std::vector<Vector> again = t;
    EXPECT_LE(solve(problem, again).n_applications, cold.n_applications);

    // From close by: not more than from nothing, and the same gaps from wherever.
    auto close = problem;
    for (auto &b : close.b)
      b *= 1. + 1e-6;
    again           = t;
    const auto warm = solve(close, again);
    EXPECT_LE(warm.n_applications, cold.n_applications);
    for (const double start : {3., -3.})
      {
        for (unsigned int i = 0; i < n; ++i)
          again[i] = Vector({start, 0., 0.});
        ASSERT_TRUE(solve(problem, again).converged);
        const auto w = problem.gaps(t), w_again = problem.gaps(again);
        for (unsigned int i = 0; i < n; ++i)
          EXPECT_NEAR(w[i], w_again[i], 1e-10);
      }
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
    std::vector<Vector> t(10);
    const auto result = solve(problem, t, 3);
    EXPECT_FALSE(result.converged);
    EXPECT_GT(result.residual, tolerance);
    EXPECT_LE(result.n_applications, 5u); // the gradient at the end of a step comes on top
    for (unsigned int i = 0; i < 10; ++i)
      EXPECT_GE(t[i][0], 0.);
  }


  // What is stiff enough for a few references is not for such a compliance, nor for a stiffer one.
  TEST(Complementarity, counts_what_the_compliance_leaves)
  {
    constexpr unsigned int n = 5;

    const Problem problem(n, 0, 3);
    std::vector<Vector> t(n);
    const auto result = solve(problem, std::vector<double>(n, 0.), t, 2000, 10.);
    EXPECT_FALSE(result.converged);
    const auto w = problem.gaps(t);
    double wrong = 0.;
    for (unsigned int i = 0; i < n; ++i)
      wrong = std::max(wrong, std::abs(std::min(t[i][0], w[i])));
    EXPECT_GT(wrong, tolerance);
    EXPECT_GE(result.residual, 0.1 * wrong);
  }


  TEST(Complementarity, of_nothing_is_solved)
  {
    const Problem problem(0, 0, 1);
    std::vector<Vector> t;
    EXPECT_TRUE(solve(problem, t).converged);
  }


  // Too few applications for the true problem: friction may be too little, gaps are right.
  TEST_P(Complementarity, without_a_solution_closes_gaps_within_the_cones)
  {
    const auto [n, n_repeated] = GetParam();
    unsigned int n_unconverged = 0;
    for (unsigned int seed = 1; seed <= 50; ++seed)
      {
        const Problem problem(n, n_repeated, seed);
        const auto friction = coefficients(n, seed);
        std::vector<Vector> t(n);
        n_unconverged += !solve(problem, friction, t, 2).converged;
        const auto w = problem.relative_motion(t);
        for (unsigned int i = 0; i < n; ++i)
          {
            EXPECT_GE(t[i][0], 0.) << seed;
            EXPECT_GE(w[i][0], -1e-10) << seed;
            EXPECT_LE(std::min(t[i][0], w[i][0]), 1e-10) << seed;
            EXPECT_LE(std::hypot(t[i][1], t[i][2]), friction[i] * t[i][0] * (1. + 1e-12) + 1e-14)
              << seed;
          }
      }
    report("without a solution", n_unconverged);
    EXPECT_GT(n_unconverged, n > 2 ? 5u : 0u);
  }


  TEST_P(Complementarity, with_friction_satisfies_signorini_and_coulomb)
  {
    const auto [n, n_repeated] = GetParam();
    unsigned int most = 0, sum = 0;
    for (unsigned int seed = 1; seed <= 50; ++seed)
      for (const bool flat : {true, false})
        {
          const Problem problem(n, n_repeated, seed, flat);
          const auto friction = coefficients(n, seed);
          std::vector<Vector> t(n);
          const auto result = solve(problem, friction, t, 10000);
          ASSERT_TRUE(result.converged)
            << seed << (flat ? " flat" : "") << ": residual " << result.residual;
          expect_conditions(problem, friction, t, seed);
          most = std::max(most, result.n_applications);
          sum += result.n_applications;
        }
    report("applications, mean", sum / 100.);
    report("applications, most", most);
  }


  // Gradient steps before the first Newton step, where there are no factors that fit.
  TEST(Friction, of_many_pairs_takes_fewer_new_factors)
  {
    unsigned int n_changes = 0, n_changes_without = 0;
    for (unsigned int seed = 1; seed <= 5; ++seed)
      {
        const unsigned int n = 100;
        const Problem problem(n, 10, seed, true);
        const auto friction = coefficients(n, seed);
        std::vector<Vector> t(n), t_without(n);
        Diagonal diagonal, fitting;
        fitting.fits = true;
        ASSERT_TRUE(solve(problem, friction, t, diagonal, 20000).converged) << seed;
        ASSERT_TRUE(solve(problem, friction, t_without, fitting, 20000).converged) << seed;
        expect_conditions(problem, friction, t, seed);
        n_changes += diagonal.n_changes;
        n_changes_without += fitting.n_changes;
      }
    report("changes of faces", n_changes);
    report("changes of faces without gradient steps", n_changes_without);
    EXPECT_LT(n_changes, 0.9 * n_changes_without);
  }


  TEST(Friction, agrees_with_a_plain_projected_gradient)
  {
    for (unsigned int seed = 1; seed <= 10; ++seed)
      {
        const unsigned int n = 6;
        const Problem problem(n, seed % 3, seed, true);
        const auto friction = coefficients(n, seed);
        std::vector<Vector> t(n), plain(n), g(n);
        ASSERT_TRUE(solve(problem, friction, t).converged);
        const double step = 1. / norm_bound(problem.S);
        for (unsigned int k = 0; k < 100000; ++k)
          {
            problem.apply(plain, g);
            for (unsigned int i = 0; i < n; ++i)
              {
                const double limit = friction[i] * plain[i][0];
                plain[i] = CoulombFace::project(plain[i] - step * (g[i] + problem.b[i]), limit);
              }
          }
        const auto w = problem.relative_motion(t), w_plain = problem.relative_motion(plain);
        for (unsigned int i = 0; i < n; ++i)
          EXPECT_LE((w[i] - w_plain[i]).norm(), 1e-8) << seed;
      }
  }
} // namespace semismooth_newton_test
