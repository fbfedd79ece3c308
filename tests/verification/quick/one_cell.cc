#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>

#include "support/cell_body.h"
#include "support/report.h"
#include "support/run_case.h"

// One cell driven through the program's own force pass: closed forms of the Truesdell rate
// (E = 1000, nu = 0.25: lambda = mu = 400, lambda + 2 mu = 1200), free flight and
// fall of the shipped case one_cell.

namespace one_cell
{
  using namespace akmon;
  using namespace akmon::test;
  using Matrix = dealii::Tensor<2, 3>;
  using Path   = std::function<Matrix(double)>; // deformation gradient at 0 <= t <= 1


  // A brick whose nodes are led along x = F(t) X.
  class DrivenCell
  {
  public:
    explicit DrivenCell(const CellIntegration integration)
      : discretization({body_of(box(Vector({1., .8, .6})), integration)},
                       {elastic()},
                       MPI_COMM_SELF)
      , forces(discretization)
      , x(discretization.reference)
      , dx(discretization.make_vector())
      , force(discretization.make_vector())
    {
    }

    void
    go_to(const Matrix &F)
    {
      attempt(F);
      EXPECT_FALSE(forces.fault().occurred());
    }

    void
    attempt(const Matrix &F)
    {
      for (unsigned int node = 0; node < 8; ++node)
        {
          const Vector target = F * at_node(discretization.reference, node);
          for (unsigned int d = 0; d < 3; ++d)
            {
              dx.local_element(3 * node + d) = target[d] - x.local_element(3 * node + d);
              x.local_element(3 * node + d)  = target[d];
            }
        }
      force = 0.;
      forces.update(x, dx, force);
    }

    void
    follow(const Path &path, const unsigned int n_steps)
    {
      for (unsigned int step = 1; step <= n_steps; ++step)
        go_to(path(double(step) / n_steps));
    }

    Matrix
    stress(const unsigned int q) const
    {
      static constexpr unsigned int row[] = {0, 1, 2, 0, 0, 1}, column[] = {0, 1, 2, 1, 2, 2};
      const auto &batches          = forces.batches()[0];
      const double *const at_point = batches.state_at(0) + q * batches.n_components * n_lanes;
      Matrix sigma;
      for (unsigned int c = 0; c < 6; ++c)
        sigma[row[c]][column[c]] = sigma[column[c]][row[c]] = at_point[c * n_lanes];
      return sigma;
    }

    // Largest difference at any Gauss point from a stress.
    double
    error(const Matrix &expected) const
    {
      double worst = 0.;
      for (unsigned int q = 0; q < 8; ++q)
        worst = std::max(worst, (stress(q) - expected).norm());
      return worst;
    }

    // Force on a node that the stress of a cell with homogeneous deformation F makes:
    // f_a = - sigma J F^{-T} int dN_a/dX dV, the integral being +-(A_x, A_y, A_z)/4 of the brick.
    Vector
    nodal_force(const unsigned int node, const Matrix &F, const Matrix &sigma) const
    {
      const Vector X = at_node(discretization.reference, node);
      const Vector area(
        {std::copysign(.12, X[0]), std::copysign(.15, X[1]), std::copysign(.2, X[2])});
      return -determinant(F) * (sigma * (transpose(invert(F)) * area));
    }

    Discretization discretization;
    InternalForces forces;
    NodalVector x, dx, force;
  };


  Matrix
  diagonal(const double a, const double b, const double c)
  {
    return Matrix({{a, 0., 0.}, {0., b, 0.}, {0., 0., c}});
  }


  Matrix
  shear(const double g)
  {
    return Matrix({{1., g, 0.}, {0., 1., 0.}, {0., 0., 1.}});
  }


  // Rodrigues' formula about (1, 2, 2)/3.
  Matrix
  rotation(const double angle)
  {
    const Vector n({1. / 3., 2. / 3., 2. / 3.});
    const Matrix K({{0., -n[2], n[1]}, {n[2], 0., -n[0]}, {-n[1], n[0], 0.}});
    return diagonal(1., 1., 1.) + std::sin(angle) * K + (1. - std::cos(angle)) * (K * K);
  }


  class OneCell : public testing::TestWithParam<CellIntegration>
  {
  };

  INSTANTIATE_TEST_SUITE_P(Integrations,
                           OneCell,
                           testing::Values(CellIntegration::full,
                                           CellIntegration::mean_dilatation));


  TEST_P(OneCell, StressTurnsWithARigidRotation)
  {
    // Each step is a finite rotation about an oblique axis, by 1 to 120 degrees.
    for (const double degrees : {1., 10., 45., 120.})
      {
        DrivenCell cell(GetParam());
        const Matrix F({{1.1, .2, -.05}, {.03, .9, .1}, {-.02, .04, 1.05}});
        cell.go_to(F);
        const Matrix sigma = cell.stress(0);
        ASSERT_GT(sigma.norm(), 50.);
        EXPECT_LE(cell.error(sigma), 1e-12 * sigma.norm());
        const double work = cell.forces.internal_work();
        for (unsigned int step = 1; step <= 12; ++step)
          {
            const Matrix R = rotation(step * degrees * pi / 180.);
            cell.go_to(R * F);
            const Matrix turned = R * sigma * transpose(R);
            ASSERT_LE(cell.error(turned), 1e-12 * sigma.norm()) << degrees << " " << step;
            for (unsigned int node = 0; node < 8; ++node)
              ASSERT_LE((at_node(cell.force, node) - cell.nodal_force(node, R * F, turned)).norm(),
                        1e-12 * sigma.norm());
          }
        EXPECT_NEAR(cell.forces.internal_work(), work, 1e-12 * work);
      }
  }


  TEST_P(OneCell, SimpleShearAndDilatationAreExactInAnyNumberOfSteps)
  {
    for (const unsigned int n : {1, 4, 10, 100})
      {
        // sigma12 = G g, sigma11 = G g^2: 800 and 1600 at g = 2.
        DrivenCell sheared(GetParam());
        sheared.follow([](const double t) { return shear(2. * t); }, n);
        EXPECT_LE(sheared.error(Matrix({{1600., 800., 0.}, {800., 0., 0.}, {0., 0., 0.}})), 1e-9)
          << n;
        // 3 K (1 - 1/l) = 666.666667 at l = 1.5.
        DrivenCell dilated(GetParam());
        dilated
          .follow([](const double t) { return diagonal(1. + .5 * t, 1. + .5 * t, 1. + .5 * t); },
                  n);
        EXPECT_LE(dilated.error(diagonal(2000. / 3., 2000. / 3., 2000. / 3.)), 1e-9) << n;
      }
  }


  TEST_P(OneCell, UniaxialStrainHasTheKnownNumbersAndSecondOrder)
  {
    struct Known
    {
      double stretch;
      unsigned int n;
      double sigma_11;
    };
    for (const auto &known : {Known{1.5, 1, 576.},
                              Known{1.5, 4, 598.361678},
                              Known{1.5, 10, 599.736395},
                              Known{.6, 1, -450.},
                              Known{.6, 4, -477.846574},
                              Known{.6, 10, -479.652191}})
      {
        DrivenCell cell(GetParam());
        cell.follow([&](const double t) { return diagonal(1. + (known.stretch - 1.) * t, 1., 1.); },
                    known.n);
        const double lateral = 400. * (1. - 1. / known.stretch); // lambda (1 - 1/l), for any steps
        EXPECT_LE(cell.error(diagonal(known.sigma_11, lateral, lateral)), 1e-6) << known.n;
      }
    const auto error = [](const unsigned int n) {
      DrivenCell cell(GetParam());
      cell.follow([](const double t) { return diagonal(1. + .5 * t, 1., 1.); }, n);
      return cell.error(diagonal(600., 400. / 3., 400. / 3.)); // M (l - 1)
    };
    const double order = std::log2(error(50) / error(100));
    report("order under uniaxial strain", order);
    EXPECT_NEAR(order, 2., 0.02);
  }


  TEST_P(OneCell, StretchAndTurnHasTheKnownNumbersAndSecondOrder)
  {
    // R_z(90 degrees t) diag(1 + .3t, 1 - .1t, 1 + .1t).
    const Path path = [](const double t) {
      const double c = std::cos(.5 * pi * t), s = std::sin(.5 * pi * t);
      return Matrix({{c, -s, 0.}, {s, c, 0.}, {0., 0., 1.}}) *
             diagonal(1. + .3 * t, 1. - .1 * t, 1. + .1 * t);
    };
    const std::vector<std::pair<unsigned int, std::array<double, 3>>> known =
      {{1, {{3.050020, 669.429541, 116.402116}}},
       {4, {{11.356612, 370.222911, 168.378820}}},
       {10, {{11.916270, 360.069013, 171.935753}}}};
    for (const auto &[n, sigma] : known)
      {
        DrivenCell cell(GetParam());
        cell.follow(path, n);
        for (unsigned int q = 0; q < 8; ++q)
          for (unsigned int d = 0; d < 3; ++d)
            EXPECT_NEAR(cell.stress(q)[d][d], sigma[d], 1e-6) << n;
      }
    const auto error = [&](const unsigned int n) {
      DrivenCell cell(GetParam());
      cell.follow(path, n);
      return std::abs(cell.stress(0)[1][1] - 358.185785);
    };
    const double order = std::log2(error(10) / error(20));
    report("order under stretch and turn", order);
    EXPECT_NEAR(order, 2., 0.05);
  }


  TEST_P(OneCell, InsideOutIsFoundAlongTwoAxesAtOnceToo)
  {
    // The Jacobian of the last three is positive; in the last one the middle configuration is flat.
    for (const Matrix &F : {diagonal(-.5, 1., 1.),
                            diagonal(-.5, -.6, 1.),
                            diagonal(1., -2., -.9),
                            diagonal(-1., 1., -1.)})
      {
        DrivenCell cell(GetParam());
        cell.attempt(F);
        EXPECT_TRUE(cell.forces.fault().occurred()) << F;
      }
    // What is far beyond any step of a run is not.
    DrivenCell stretched(GetParam());
    stretched.go_to(diagonal(3., 3., 3.));
    DrivenCell flattened(GetParam());
    flattened.go_to(diagonal(.05, 1.5, 1.5));
  }


  TEST_P(OneCell, InternalWorkIsTheIntegralOfForceTimesWay)
  {
    // Uniaxial strain: P = M (l - 1) (the Truesdell rate gives it exactly), W = M (l - 1)^2/2 V.
    DrivenCell cell(GetParam());
    cell.follow([](const double t) { return diagonal(1. + .2 * t, 1., 1.); }, 1000);
    EXPECT_NEAR(cell.forces.internal_work(), .48 * .5 * 1200. * .04, 1e-5);
    EXPECT_EQ(cell.forces.plastic_work(), 0.);
  }


  // ---------------------------------------------------------------------------------------------
  // Free flight
  // ---------------------------------------------------------------------------------------------

  constexpr double cell_mass = 8. * .48;


  TEST(FreeFlight, KeepsMomentaAndEnergy)
  {
    for (const char *const integration : {"full", "mean dilatation"})
      {
        const Table history = run_case(shipped("one_cell"),
                                       {std::string("Bodies/cell/Integration=") + integration});
        ASSERT_GT(history.n_rows(), 1000u);
        // Lumped inertia of a brick: m/4 (b^2 + c^2) about x.
        const std::array<double, 3> velocity = {{.5, -.3, .2}};
        const std::array<double, 3> spin = {{.6 * (.64 + .36), .8 * (1. + .36), 1.2 * (1. + .64)}};
        const char axis[]                = {'x', 'y', 'z'};
        double turned = 0., drift = 0., energy = 0., strain = 0.;
        for (std::size_t i = 0; i < history.n_rows(); ++i)
          {
            for (unsigned int d = 0; d < 3; ++d)
              {
                drift  = std::max(drift,
                                 std::abs(history[std::string("momentum_") + axis[d]][i] -
                                          cell_mass * velocity[d]));
                turned = std::max(turned,
                                  std::abs(history[std::string("angular_momentum_") + axis[d]][i] -
                                           cell_mass / 4. * spin[d]));
              }
            energy = std::max(energy, std::abs(history["energy_error"][i]));
            strain = std::max(strain, history["strain_energy"][i]);
          }
        report("linear momentum, largest change", drift);
        report("angular momentum, largest change", turned);
        report("energy error", energy);
        EXPECT_LE(drift, 1e-12);
        EXPECT_LE(turned, 1e-10);
        EXPECT_LE(energy, 1e-3);
        EXPECT_GT(strain, 0.); // it does strain
      }
  }


  TEST(FreeFlight, FallIsExact)
  {
    const Table history           = run_case(shipped("one_cell"),
                                   {"Body force/Acceleration=1; -2; -9.81",
                                              "Bodies/cell/Spin=0, 0, 0",
                                              "Time/End=2"});
    const std::array<double, 3> g = {{1., -2., -9.81}}, v = {{.5, -.3, .2}};
    const char axis[] = {'x', 'y', 'z'};
    for (std::size_t i = 0; i < history.n_rows(); ++i)
      {
        const double t = history["time"][i];
        for (unsigned int d = 0; d < 3; ++d)
          {
            ASSERT_NEAR(history[std::string("corner.displacement_") + axis[d]][i],
                        v[d] * t + .5 * g[d] * t * t,
                        1e-11);
            ASSERT_NEAR(history[std::string("momentum_") + axis[d]][i],
                        cell_mass * (v[d] + g[d] * t),
                        1e-11);
          }
        ASSERT_LE(std::abs(history["energy_error"][i]), 1e-12);
        ASSERT_NEAR(history["strain_energy"][i], 0., 1e-12);
      }
  }
} // namespace one_cell
