#include <akmon/material/arc_end.h>
#include <akmon/material/hypoelastic.h>
#include <akmon/simd.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <iostream>
#include <string>

#include "support/j2_plastic.h"

// J2 plasticity with the ARC-end update: against the rate equations, in rigid rotation, in lanes.

namespace j2_plastic_arc_end_test
{
  using namespace akmon;
  using namespace akmon::test;
  using namespace akmon::test::j2_points;

  // E = 200, nu = 0.25 (lambda = mu = 80, M = 240), sigma_y = 1, h' = 10.
  const J2Plastic finite_strain_law{Elasticity::from_young(200., 0.25), 1., 10.};


  // Uniaxial strain from stretch 1 to the given one in N steps.
  State
  arc_end_uniaxial_strain(const double stretch, const unsigned int N)
  {
    State state;
    for (unsigned int n = 0; n < N; ++n)
      {
        const double ratio = (1. + (stretch - 1.) * (n + 1.) / N) /
                             (1. + (stretch - 1.) * n / double(N));
        const Matrix3<double> H = {{{ratio - 1., 0., 0.}, {0., 0., 0.}, {0., 0., 0.}}};
        state.plastic_work += arc_end_update(finite_strain_law,
                                             H,
                                             ratio,
                                             state.stress,
                                             &state.eps_p)
                                .plastic_work;
      }
    return state;
  }


  // The same from the rate equations in compression. Up to yield sigma11 = M (l - 1),
  // sigma22 = lambda (1 - 1/l), q = sigma22 - sigma11. Then, with x = ln l, S = sigma11 + sigma22
  // and dev sigma = q (-2, 1, 1)/3, the flow d eps_p/dx = -(S + 2 G)/(3 G + H) keeps q = sigma_y +
  // H eps_p in
  //     d sigma11/dx = sigma11 + M + 2 G d eps_p/dx,   d sigma22/dx = -sigma22 + lambda - G d
  //     eps_p/dx;
  // Runge-Kutta of order four.
  State
  exact_compression(const double stretch)
  {
    const double lambda = 80., mu = 80., M = 240., sigma_y = 1., h = 10.;

    double above = 1., below = stretch; // bisection for q = sigma_y
    for (unsigned int iteration = 0; iteration < 100; ++iteration)
      {
        const double l                = 0.5 * (above + below);
        const double q                = lambda * (1. - 1. / l) - M * (l - 1.);
        (q > sigma_y ? below : above) = l;
      }

    using Vector    = std::array<double, 3>; // sigma11, sigma22, eps_p
    const auto rate = [&](const Vector &y) -> Vector {
      const double flow = -(y[0] + y[1] + 2. * mu) / (3. * mu + h);
      return {{y[0] + M + 2. * mu * flow, -y[1] + lambda - mu * flow, flow}};
    };
    const auto along = [](const Vector &y, const double step, const Vector &k) {
      Vector result = y;
      for (unsigned int i = 0; i < 3; ++i)
        result[i] += step * k[i];
      return result;
    };
    Vector y                 = {{M * (above - 1.), lambda * (1. - 1. / above), 0.}};
    const unsigned int steps = 1000;
    const double dx          = std::log(stretch / above) / steps;
    for (unsigned int n = 0; n < steps; ++n)
      {
        const Vector k1 = rate(y);
        const Vector k2 = rate(along(y, 0.5 * dx, k1));
        const Vector k3 = rate(along(y, 0.5 * dx, k2));
        const Vector k4 = rate(along(y, dx, k3));
        for (unsigned int i = 0; i < 3; ++i)
          y[i] += dx / 6. * (k1[i] + 2. * k2[i] + 2. * k3[i] + k4[i]);
      }
    State state;
    state.stress = {{y[0], y[1], y[1], 0., 0., 0.}};
    state.eps_p  = y[2];
    return state;
  }


  TEST(J2PlasticArcEnd, UniaxialCompressionReachesTheNumbersForOneTenAndAHundredSteps)
  {
    // Stretch 0.9: reference solutions, an independent computation.
    EXPECT_NEAR(arc_end_uniaxial_strain(0.9, 1).stress[0], -14.944955, 0.5e-6);
    EXPECT_NEAR(arc_end_uniaxial_strain(0.9, 10).stress[0], -15.254046, 0.5e-6);
    EXPECT_NEAR(arc_end_uniaxial_strain(0.9, 100).stress[0], -15.283552, 0.5e-6);
  }


  TEST(J2PlasticArcEnd, ConvergesToTheRateEquationsWithOrderOne)
  {
    // The return uses the normal at the end of the step and no map: backward Euler, first order.
    const State exact   = exact_compression(0.9);
    const double coarse = std::abs(arc_end_uniaxial_strain(0.9, 400).stress[0] - exact.stress[0]);
    const double fine   = std::abs(arc_end_uniaxial_strain(0.9, 800).stress[0] - exact.stress[0]);
    const double order  = std::log2(coarse / fine);
    RecordProperty("exact_sigma11", std::to_string(exact.stress[0]));
    RecordProperty("order", std::to_string(order));
    std::cout << "  exact sigma11 = " << std::to_string(exact.stress[0]) << ", order = " << order
              << '\n';
    EXPECT_NEAR(order, 1., 0.05);
    EXPECT_NEAR(equivalent_stress(exact.stress), 1. + 10. * exact.eps_p, 1e-9);
    EXPECT_NEAR(arc_end_uniaxial_strain(0.9, 100000).stress[0], exact.stress[0], 1e-5);
    EXPECT_NEAR(arc_end_uniaxial_strain(0.9, 100000).eps_p, exact.eps_p, 1e-6);
  }


  TEST(J2PlasticArcEnd, IsHypoelasticityBelowYield)
  {
    Random random;
    const Hypoelastic elastic{copper.elasticity};
    const J2Plastic strong{copper.elasticity, 1e9, H};
    const Matrix3<double> gradient{{{0.1, -0.2, 0.05}, {0.3, -0.1, 0.}, {0.02, 0.1, 0.2}}};
    const Matrix3<double> F = identity_plus(1., gradient);
    const double J          = determinant(F, cofactor(F));
    Stress first            = random.tensor(300.);
    Stress second           = first;
    double eps_p            = 0.125;
    arc_end_update(elastic, gradient, J, first, &eps_p);
    const auto step = arc_end_update(strong, gradient, J, second, &eps_p);
    EXPECT_LT(norm(difference(first, second)), 1e-14 * norm(first));
    EXPECT_EQ(step.plastic_work, 0.);
    EXPECT_EQ(eps_p, 0.125);
  }


  TEST(J2PlasticArcEnd, RigidRotationKeepsTheStateOnTheYieldSurface)
  {
    State state;
    strain_by(copper, {{0.02, 0., 0., 0.01, 0., 0.}}, state);
    const double eps_p = state.eps_p;
    const double q     = equivalent_stress(state.stress);
    const double c = std::cos(1.), s = std::sin(1.);
    const Matrix3<double> gradient{{{c - 1., -s, 0.}, {s, c - 1., 0.}, {0., 0., 0.}}};
    arc_end_update(copper, gradient, 1., state.stress, &state.eps_p);
    EXPECT_NEAR(equivalent_stress(state.stress), q, 1e-12 * q);
    EXPECT_NEAR(state.eps_p, eps_p, 1e-15);
  }


  // ---------------------------------------------------------------------------------------------
  // Lanes
  // ---------------------------------------------------------------------------------------------

  struct Point
  {
    Matrix3<double> gradient;
    Stress stress;
    double eps_p;
    double plastic_work;
  };


  // Elastic and plastic steps side by side: every other lane hardly deforms.
  std::array<Point, n_lanes>
  random_points(Random &random)
  {
    std::array<Point, n_lanes> points;
    for (unsigned int p = 0; p < n_lanes; ++p)
      {
        const double size = p % 2 ? 0.3 : 1e-5;
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = 0; j < 3; ++j)
            points[p].gradient(i, j) = random.between(-size, size);
        points[p].stress       = random.tensor(100.);
        points[p].eps_p        = random.between(0., 0.5);
        points[p].plastic_work = 0.;
      }
    return points;
  }


  // All points, point (lane + shift) modulo the number of lanes standing in each lane.
  std::array<Point, n_lanes>
  update_in_lanes(std::array<Point, n_lanes> points, const unsigned int shift)
  {
    const auto gather = [&](const auto &member) {
      alignas(lane_alignment) double values[n_lanes];
      for (unsigned int lane = 0; lane < n_lanes; ++lane)
        values[lane] = member(points[(lane + shift) % n_lanes]);
      return Lanes::load_aligned(values);
    };
    const auto scatter = [&](const Lanes &lanes, const auto &member) {
      alignas(lane_alignment) double values[n_lanes];
      lanes.store_aligned(values);
      for (unsigned int lane = 0; lane < n_lanes; ++lane)
        member(points[(lane + shift) % n_lanes]) = values[lane];
    };

    Matrix3<Lanes> gradient;
    Symmetric3<Lanes> stress;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        gradient(i, j) = gather([&](const Point &point) { return point.gradient(i, j); });
    for (unsigned int i = 0; i < 6; ++i)
      stress[i] = gather([&](const Point &point) { return point.stress[i]; });
    Lanes eps_p = gather([](const Point &point) { return point.eps_p; });

    const Matrix3<Lanes> F = identity_plus(1., gradient);
    const auto step = arc_end_update(copper, gradient, determinant(F, cofactor(F)), stress, &eps_p);

    for (unsigned int i = 0; i < 6; ++i)
      scatter(stress[i], [&](Point &point) -> double & { return point.stress[i]; });
    scatter(eps_p, [](Point &point) -> double & { return point.eps_p; });
    scatter(step.plastic_work, [](Point &point) -> double & { return point.plastic_work; });
    return points;
  }


  TEST(J2PlasticLanes, EveryLaneAgreesWithOneNumber)
  {
    Random random;
    // Relative to the trial stress, whose rounding the return inherits.
    for (unsigned int trial = 0; trial < 20; ++trial)
      {
        const auto points  = random_points(random);
        const auto results = update_in_lanes(points, 0);
        for (unsigned int p = 0; p < n_lanes; ++p)
          {
            Point point             = points[p];
            const Matrix3<double> F = identity_plus(1., point.gradient);
            const double J          = determinant(F, cofactor(F));

            Stress trial_stress = point.stress;
            arc_end_update(Hypoelastic{copper.elasticity},
                           point.gradient,
                           J,
                           trial_stress,
                           &point.eps_p);

            const auto step = arc_end_update(copper, point.gradient, J, point.stress, &point.eps_p);
            EXPECT_EQ(point.eps_p > points[p].eps_p, p % 2 == 1);
            EXPECT_LT(norm(difference(results[p].stress, point.stress)),
                      1e-14 * norm(trial_stress));
            EXPECT_NEAR(results[p].eps_p, point.eps_p, 1e-14 * point.eps_p);
            EXPECT_NEAR(results[p].plastic_work, step.plastic_work, 1e-14 * step.plastic_work);
          }
      }
  }


  TEST(J2PlasticLanes, PointHasTheSameBitsInWhicheverLaneItStands)
  {
    Random random;
    const auto points = random_points(random);
    const auto first  = update_in_lanes(points, 0);
    for (unsigned int shift = 1; shift < n_lanes; ++shift)
      {
        const auto results = update_in_lanes(points, shift);
        EXPECT_EQ(std::memcmp(results.data(), first.data(), sizeof(first)), 0) << shift;
      }
  }
} // namespace j2_plastic_arc_end_test
