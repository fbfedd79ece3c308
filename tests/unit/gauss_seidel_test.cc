#include <akmon/contact/coupled/gauss_seidel.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "support/random_contact.h"
#include "support/report.h"

// Sweeps lead to forces that solve the contact problem: no gap is negative and no force is outside
// Coulomb's cone, forces only where gaps are closed, and slip against friction on the cone.

namespace gauss_seidel_test
{
  using namespace akmon;
  using namespace akmon::test;

  // Largest |t - P(t - w)|.
  double
  residual(const RandomContact &problem, const double mu, const std::vector<Vector> &t)
  {
    const auto w   = problem.relative_motion(t);
    double largest = 0.;
    for (std::size_t i = 0; i < t.size(); ++i)
      largest = std::max(largest,
                         (t[i] - CoulombFace::project(t[i] - w[i], mu * std::max(t[i][0], 0.)))
                           .norm());
    return largest;
  }


  class Sweeps : public testing::TestWithParam<double>
  {
  };


  TEST_P(Sweeps, lead_to_a_solution)
  {
    constexpr unsigned int n = 4;

    double worst = 0.;
    for (unsigned int seed = 1; seed <= 20; ++seed)
      {
        const RandomContact contact(n, 0, seed);
        FrictionalProblem problem{};
        problem.b        = contact.b;
        problem.friction = std::vector<double>(n, GetParam());
        std::vector<Vector> t(n);
        sweep(matrix_of(contact), problem, 20000, t);
        worst = std::max(worst, residual(contact, GetParam(), t));
      }
    report("residual, of 1", worst);
    EXPECT_LE(worst, 1e-8);
  }


  INSTANTIATE_TEST_SUITE_P(Friction, Sweeps, testing::Values(0., 0.3));
} // namespace gauss_seidel_test
