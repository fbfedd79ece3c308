#include <akmon/simd.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>

#include "support/critical_step.h"

// The critical step 2/omega_max of a cell against its closed form and against an
// independent stiffness matrix (support/critical_step.h).

namespace critical_step_test
{
  using namespace akmon;
  using namespace akmon::test;

  // A free brick: n = (1/a, 1/b, 1/c), omega_max^2 =
  // max( lambda_max[(4/rho)(lambda n n^T + 2G diag(n_i^2))], (4G/rho)(n_i^2 + n_j^2) ), rho = 1.
  double
  closed_form(const std::array<double, 3> &edges, const Elasticity &elasticity)
  {
    dealii::SymmetricTensor<2, 3> matrix;
    double shear = 0.;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = i; j < 3; ++j)
        {
          const double n_i = 1. / edges[i], n_j = 1. / edges[j];
          matrix[i][j] = 4. * (elasticity.lambda * n_i * n_j +
                               (i == j ? 2. * elasticity.mu * n_i * n_i : 0.));
          if (i != j)
            shear = std::max(shear, 4. * elasticity.mu * (n_i * n_i + n_j * n_j));
        }
    return std::max(eigenvalues(matrix)[0], shear);
  }


  TEST(ClosedForm, GivesThePublishedNumbers)
  {
    // Cube: dt = (a/c_d) {1, .7746, .7338, .6939, .6159}.
    const std::array<std::array<double, 2>, 5> published = {
      {{{0., 1.}}, {{.25, .7746}}, {{.3, .7338}}, {{.35, .6939}}, {{.45, .6159}}}};
    for (const auto &[nu, dt] : published)
      {
        const auto elasticity = Elasticity::from_young(1., nu);
        const double c_d      = std::sqrt(elasticity.lambda + 2. * elasticity.mu);
        EXPECT_NEAR(2. / std::sqrt(closed_form({{1., 1., 1.}}, elasticity)) * c_d, dt, 0.5e-4);
      }
    EXPECT_NEAR(std::sqrt(closed_form({{1., .5, .25}}, Elasticity::from_young(1., .3))),
                9.60382015,
                0.5e-8);
  }


  TEST(CellEigenvalue, IsTheClosedFormOnBricks)
  {
    Range range;
    for (const auto integration : integrations)
      for (const double nu : {0., .25, .3, .35, .45})
        for (const auto &edges : {std::array<double, 3>{{1., 1., 1.}},
                                  std::array<double, 3>{{1., 2., 4.}},
                                  std::array<double, 3>{{1., .5, .25}},
                                  std::array<double, 3>{{.25, 1., .25}},
                                  std::array<double, 3>{{10., 1., .1}}})
          {
            const auto elasticity = Elasticity::from_young(1., nu);
            const Nodes x         = brick(edges[0], edges[1], edges[2]);
            const Masses mass     = lumped_masses(x, 1.);
            const double exact    = closed_form(edges, elasticity);
            EXPECT_NEAR(exact_eigenvalue(x, mass, elasticity, integration), exact, 1e-10 * exact);

            const double ratio = ratio_of_steps(estimate(x, mass, elasticity, integration), exact);
            range.add(ratio);
            EXPECT_LE(ratio, 1. + rounding) << nu << " " << edges[1] << " " << edges[2];
            EXPECT_GE(ratio, 1. - allowed_loss) << nu << " " << edges[1] << " " << edges[2];
          }
    report("bricks: least ratio of steps", range.low);
    report("bricks: largest ratio of steps", range.high);
  }


  TEST(CellEigenvalue, HoldsForAuxeticMaterials)
  {
    // Shear patterns govern for nu < 0.
    for (const auto integration : integrations)
      for (const double nu : {-.1, -.3, -.6})
        for (const auto &edges :
             {std::array<double, 3>{{1., 1., 1.}}, std::array<double, 3>{{1., .5, .25}}})
          {
            const auto elasticity = Elasticity::from_young(1., nu);
            const Nodes x         = brick(edges[0], edges[1], edges[2]);
            const double exact    = closed_form(edges, elasticity);
            const double ratio    = ratio_of_steps(estimate(x,
                                                         lumped_masses(x, 1.),
                                                         elasticity,
                                                         integration),
                                                exact);
            EXPECT_LE(ratio, 1. + rounding) << nu << " " << edges[1];
            EXPECT_GE(ratio, 1. - allowed_loss) << nu << " " << edges[1];
          }
  }


  Nodes
  mapped(const Nodes &reference, const Tensor<2, 3> &F)
  {
    Nodes x;
    for (unsigned int v = 0; v < 8; ++v)
      for (unsigned int i = 0; i < 3; ++i)
        x[v][i] = F[i][0] * reference[v][0] + F[i][1] * reference[v][1] + F[i][2] * reference[v][2];
    return x;
  }


  void
  expect_close_to_dense(const Nodes &x, const std::string &name, Range &range)
  {
    ASSERT_TRUE(valid(x)) << name;
    const Masses mass = lumped_masses(x, 1.);
    for (const auto integration : integrations)
      for (const double nu : {0., .3, .45})
        {
          const auto elasticity = Elasticity::from_young(1., nu);
          const double ratio    = ratio_of_steps(estimate(x, mass, elasticity, integration),
                                              exact_eigenvalue(x, mass, elasticity, integration));
          range.add(ratio);
          const std::string which = name + ", nu " + std::to_string(nu) +
                                    (integration == CellIntegration::full ? " full" : " mean");
          EXPECT_LE(ratio, 1. + rounding) << which;
          EXPECT_GE(ratio, 1. - allowed_loss) << which;
        }
  }


  TEST(CellEigenvalue, IsThatOfTheDenseMatrixOnSkewedCells)
  {
    Range range;
    for (const double shear : {.25, .5, 1., 2.})
      for (const auto &edges :
           {std::array<double, 3>{{1., 1., 1.}}, std::array<double, 3>{{1., .5, .25}}})
        {
          const Nodes reference = brick(edges[0], edges[1], edges[2]);
          const Tensor<2, 3> plane({{1., shear, 0.}, {0., 1., 0.}, {0., 0., 1.}});
          const Tensor<2, 3> space({{1., shear, .5 * shear}, {0., 1., shear}, {0., 0., 1.}});
          expect_close_to_dense(mapped(reference, plane), "plane " + std::to_string(shear), range);
          expect_close_to_dense(mapped(reference, space), "space " + std::to_string(shear), range);
        }
    report("skewed: least ratio of steps", range.low);
    report("skewed: largest ratio of steps", range.high);
  }


  TEST(CellEigenvalue, IsThatOfTheDenseMatrixOnTaperedCells)
  {
    // The face z = 1 is a factor smaller in one or both directions; a wedge turns it too.
    Range range;
    for (const double taper : {.75, .5, .25, .1})
      for (const bool both : {false, true})
        for (const double angle : {0., .5})
          {
            Nodes x = brick(1., 1., 1.);
            for (unsigned int v = 4; v < 8; ++v)
              {
                const double p = taper * (x[v][0] - .5), q = (both ? taper : 1.) * (x[v][1] - .5);
                x[v][0] = .5 + std::cos(angle) * p - std::sin(angle) * q;
                x[v][1] = .5 + std::sin(angle) * p + std::cos(angle) * q;
              }
            expect_close_to_dense(x, "taper " + std::to_string(taper), range);
          }
    report("tapered: least ratio of steps", range.low);
    report("tapered: largest ratio of steps", range.high);
  }


  TEST(CellEigenvalue, IsThatOfTheDenseMatrixOnDistortedCells)
  {
    std::mt19937 generator(1);
    std::uniform_real_distribution<double> uniform(-1., 1.);
    Range range;
    unsigned int n_cells = 0;
    while (n_cells < 400)
      {
        const double amplitude = 0.35 * std::abs(uniform(generator));
        Nodes x                = brick(1., std::pow(4., uniform(generator)), 1.);
        const double least     = std::min(1., x[2][1]);
        for (auto &node : x)
          for (auto &component : node)
            component += amplitude * least * uniform(generator);
        if (!valid(x))
          continue;
        ++n_cells;
        expect_close_to_dense(x, "random " + std::to_string(n_cells), range);
      }
    report("distorted: least ratio of steps", range.low);
    report("distorted: largest ratio of steps", range.high);
  }


  TEST(CellEigenvalue, IsTheSameInEveryLane)
  {
    const auto elasticity = Elasticity::from_young(1., .3);
    // The same cells in every rotation of the lanes: the same bits. The scalar version agrees to
    // what the bisection resolves (2^-20 of the eigenvalue bounds).
    const auto in_lanes = [&](const unsigned int shift) {
      alignas(lane_alignment) double mass_lanes[8][n_lanes], x_lanes[8][3][n_lanes];
      Lanes masses[8], positions[8][3];
      for (unsigned int k = 0; k < n_lanes; ++k)
        {
          const unsigned int lane = (k + shift) % n_lanes;
          const Nodes x           = brick(1., .5 + k, 2. - .1 * k);
          const Masses mass       = lumped_masses(x, 1. + k);
          for (unsigned int v = 0; v < 8; ++v)
            {
              mass_lanes[v][lane] = mass[v];
              for (unsigned int d = 0; d < 3; ++d)
                x_lanes[v][d][lane] = x[v][d];
            }
        }
      for (unsigned int v = 0; v < 8; ++v)
        {
          masses[v] = Lanes::load_aligned(mass_lanes[v]);
          for (unsigned int d = 0; d < 3; ++d)
            positions[v][d] = Lanes::load_aligned(x_lanes[v][d]);
        }
      return largest_eigenvalue(positions, masses, elasticity, CellIntegration::mean_dilatation);
    };
    const Lanes unshifted = in_lanes(0);
    for (unsigned int shift = 0; shift < n_lanes; ++shift)
      {
        const Lanes shifted = in_lanes(shift);
        for (unsigned int k = 0; k < n_lanes; ++k)
          EXPECT_EQ(shifted.get((k + shift) % n_lanes), unshifted.get(k));
      }
    for (unsigned int k = 0; k < n_lanes; ++k)
      {
        const Nodes x      = brick(1., .5 + k, 2. - .1 * k);
        const double alone = estimate(x,
                                      lumped_masses(x, 1. + k),
                                      elasticity,
                                      CellIntegration::mean_dilatation);
        EXPECT_NEAR(unshifted.get(k), alone, 2e-6 * alone);
      }
  }
} // namespace critical_step_test
