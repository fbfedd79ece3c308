#include <akmon/simd.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "support/arc_end.h"

// The exact stresses below solve the Truesdell rate equation with constant moduli,
//
//     d sigma/dt = L sigma + sigma L^T - tr(L) sigma + C : sym(L),   sigma(0) = 0,
//
// with M = lambda + 2 mu and K = lambda + 2/3 mu, for a straining whose path each test names. The
// numbers for N steps are those of the reference solutions, independent
// computations of the ARC-end update given to six decimals.

namespace arc_end_test
{
  using namespace akmon;
  using namespace akmon::test;
  using namespace akmon::test::arc_end_paths;

  constexpr double half_a_printed_digit = 0.5e-6;


  // ---------------------------------------------------------------------------------------------
  // Exact paths
  // ---------------------------------------------------------------------------------------------

  TEST(ArcEnd, UniaxialStretchReachesTheNumbersForOneFourAndTenSteps)
  {
    // One step by hand: L = 0.5/1.25 = 0.4, F_me = J_me = 1.2, sigma11 = 1.2 * 1200 * 0.4.
    EXPECT_NEAR(integrate(uniaxial_strain(1.5), 1)[0], 576., 1e-10);
    EXPECT_NEAR(integrate(uniaxial_strain(1.5), 4)[0], 598.361678, half_a_printed_digit);
    EXPECT_NEAR(integrate(uniaxial_strain(1.5), 10)[0], 599.736395, half_a_printed_digit);
    // M (l - 1) = 1200 * 0.5
    EXPECT_NEAR(integrate(uniaxial_strain(1.5), 10000)[0], 600., 1e-6);
  }


  TEST(ArcEnd, UniaxialCompressionReachesTheNumbersForOneFourAndTenSteps)
  {
    // One step by hand: L = -0.4/0.8 = -0.5, F_me = J_me = 0.75, sigma11 = -0.75 * 1200 * 0.5.
    EXPECT_NEAR(integrate(uniaxial_strain(0.6), 1)[0], -450., 1e-10);
    EXPECT_NEAR(integrate(uniaxial_strain(0.6), 4)[0], -477.846574, half_a_printed_digit);
    EXPECT_NEAR(integrate(uniaxial_strain(0.6), 10)[0], -479.652191, half_a_printed_digit);
    // M (l - 1) = -1200 * 0.4
    EXPECT_NEAR(integrate(uniaxial_strain(0.6), 10000)[0], -480., 1e-6);
  }


  TEST(ArcEnd, UniaxialStrainHasTheExactLateralStressForAnyStep)
  {
    // d sigma22/dl = (lambda - sigma22)/l, hence lambda (1 - 1/l)
    for (const double stretch : {0.6, 1.5})
      for (const unsigned int N : {1, 4, 10})
        {
          const Stress stress = integrate(uniaxial_strain(stretch), N);
          EXPECT_NEAR(stress[1], 400. * (1. - 1. / stretch), 1e-10);
          EXPECT_NEAR(stress[2], 400. * (1. - 1. / stretch), 1e-10);
          for (unsigned int i = 3; i < 6; ++i)
            EXPECT_EQ(stress[i], 0.);
        }
  }


  TEST(ArcEnd, HydrostaticStretchIsExactForAnyStep)
  {
    // d sigma/dl = (3 K - sigma)/l, hence 3 K (1 - 1/l) = 2000/3 at l = 1.5
    const Path path = [](const double t) {
      return diagonal(1. + 0.5 * t, 1. + 0.5 * t, 1. + 0.5 * t);
    };
    for (const unsigned int N : {1, 4, 10})
      {
        const Stress stress = integrate(path, N);
        for (unsigned int i = 0; i < 3; ++i)
          EXPECT_NEAR(stress[i], 2000. / 3., 1e-10);
      }
  }


  TEST(ArcEnd, SimpleShearIsExactForAnyStep)
  {
    // sigma12 = G g = 400 * 2, sigma11 = G g^2 = 400 * 4, all others 0
    const Path path = [](const double t) {
      return Matrix{{{1., 2. * t, 0.}, {0., 1., 0.}, {0., 0., 1.}}};
    };
    for (const unsigned int N : {1, 4, 10})
      {
        const Stress stress = integrate(path, N);
        EXPECT_LT(distance(stress, {{1600., 0., 0., 800., 0., 0.}}), 1e-10);
      }
  }


  TEST(ArcEnd, RotatingStretchReachesTheNumbersForOneFourAndTenSteps)
  {
    const auto expect = [](const unsigned int N, const std::array<double, 3> &expected) {
      const Stress stress = integrate(rotating_stretch, N);
      for (unsigned int i = 0; i < 3; ++i)
        EXPECT_NEAR(stress[i], expected[i], half_a_printed_digit) << "N = " << N << ", " << i;
    };
    expect(1, {{3.050020, 669.429541, 116.402116}});
    expect(4, {{11.356612, 370.222911, 168.378820}});
    expect(10, {{11.916270, 360.069013, 171.935753}});

    // The exact solution: the number given and the quadrature here agree, and the update goes
    // there.
    const Stress exact = rotating_stretch_by_quadrature();
    for (unsigned int i = 0; i < 6; ++i)
      EXPECT_NEAR(exact[i], rotating_stretch_exact[i], half_a_printed_digit);
    EXPECT_LT(distance(integrate(rotating_stretch, 3000), exact), 1e-4);
  }


  // Stress and lateral stretch of a bar pulled in N steps, its sides free: the lateral stretch of
  // each step is the root of sigma22 = 0 (Newton with a difference quotient; sigma22 is nearly
  // linear).
  std::pair<double, double>
  free_bar(const double final_stretch, const unsigned int N)
  {
    Stress stress  = {};
    double axial   = 1.;
    double lateral = 1.;
    for (unsigned int n = 0; n < N; ++n)
      {
        const double next = 1. + (final_stretch - 1.) * (n + 1.) / N;
        const auto after  = [&](const double ratio) {
          return one_step(arc_end, diagonal(next / axial, ratio, ratio), stress);
        };
        double ratio = 1.;
        for (unsigned int iteration = 0; iteration < 20; ++iteration)
          {
            const double slope = (after(ratio + 1e-6)[1] - after(ratio - 1e-6)[1]) / 2e-6;
            ratio -= after(ratio)[1] / slope;
          }
        stress = after(ratio);
        EXPECT_NEAR(stress[1], 0., 1e-10);
        lateral *= ratio;
        axial = next;
      }
    return {stress[0], lateral};
  }


  TEST(ArcEnd, UniaxialStressConvergesToTheClosedFormWithOrderTwo)
  {
    // sigma22 = 0 gives lateral stretch l^-nu and d sigma/dl = (E + (1 + 2 nu) sigma)/l, hence
    // E (l^(1 + 2 nu) - 1)/(1 + 2 nu).
    for (const double stretch : {0.7, 1.5})
      {
        const double exact         = E * (std::pow(stretch, 1. + 2. * nu) - 1.) / (1. + 2. * nu);
        const double exact_lateral = std::pow(stretch, -nu);
        const auto coarse          = free_bar(stretch, 20);
        const auto fine            = free_bar(stretch, 40);
        const double order         = observed_order(std::abs(coarse.first - exact),
                                            std::abs(fine.first - exact));
        const double order_lateral = observed_order(std::abs(coarse.second - exact_lateral),
                                                    std::abs(fine.second - exact_lateral));
        report("order_uniaxial_stress_" + std::to_string(stretch), order);
        EXPECT_GT(order, 1.95);
        EXPECT_LT(order, 2.05);
        EXPECT_GT(order_lateral, 1.95);
        EXPECT_LT(order_lateral, 2.05);
        EXPECT_NEAR(fine.first, exact, 2e-4 * std::abs(exact));
      }
  }


  TEST(ArcEnd, ConvergesWithOrderTwo)
  {
    const auto order = [](const std::string &name, const Path &path, const Stress &exact) {
      const double value = observed_order(distance(integrate(path, 20), exact),
                                          distance(integrate(path, 40), exact));
      report("order_" + name, value);
      EXPECT_GT(value, 1.95) << name;
      EXPECT_LT(value, 2.05) << name;
    };
    // Exact: M (l - 1), lambda (1 - 1/l)
    order("uniaxial_strain_1.5", uniaxial_strain(1.5), {{600., 400. / 3., 400. / 3., 0., 0., 0.}});
    order("uniaxial_strain_0.6",
          uniaxial_strain(0.6),
          {{-480., -800. / 3., -800. / 3., 0., 0., 0.}});
    order("rotating_stretch", rotating_stretch, rotating_stretch_by_quadrature());
  }


  // ---------------------------------------------------------------------------------------------
  // Algebra of the header
  // ---------------------------------------------------------------------------------------------

  TEST(ArcEnd, MidpointStrainIsTheGreenLagrangeStrainPushedToTheMidConfiguration)
  {
    Random random;
    // sym((F - I) F_m^{-1}) = F_m^{-T} (F^T F - I)/2 F_m^{-1}
    for (unsigned int trial = 0; trial < 100; ++trial)
      {
        const Matrix F           = random.deformation();
        const Matrix inverse_F_m = inverse(identity_plus(0.5, minus_identity(F)));
        const Matrix twice_E     = minus_identity(transpose(F) * F);
        const Matrix twice_E_mid = transpose(inverse_F_m) * twice_E * inverse_F_m;
        Stress half              = symmetric_part(twice_E_mid);
        for (unsigned int i = 0; i < 6; ++i)
          half[i] *= 0.5;

        Stress stress   = random.stress();
        const auto step = update(elastic, F, stress);
        EXPECT_LT(distance(step.strain, half), 1e-14);
      }
  }


  TEST(ArcEnd, TrialStressIsTheSumOfTheCarriedAndTheNewStress)
  {
    Random random;
    // J^{-1} F sigma_n F^T + J_me^{-1} F_me (C : E_mid) F_me^T, F_me = F F_m^{-1}
    for (unsigned int trial = 0; trial < 100; ++trial)
      {
        const Matrix F    = random.deformation();
        const Matrix F_me = F * inverse(identity_plus(0.5, minus_identity(F)));
        const Stress old  = random.stress();

        Stress stress         = old;
        const auto step       = update(elastic, F, stress);
        const Stress expected = push_forward(F, old, 1. / determinant(F)) +
                                push_forward(F_me,
                                             elastic.elasticity.stress(step.strain),
                                             1. / determinant(F_me));
        EXPECT_LT(distance(stress, expected), 1e-13 * norm(expected));
      }
  }


  TEST(ArcEnd, HypoelasticityDissipatesNothing)
  {
    Random random;
    Stress stress = random.stress();
    EXPECT_EQ(update(elastic, random.deformation(), stress).plastic_work, 0.);
  }


  TEST(ArcEnd, StepWithoutDeformationKeepsTheStressToTheBit)
  {
    Random random;
    const Stress before = random.stress();
    Stress after        = before;
    update(elastic, diagonal(1., 1., 1.), after);
    for (unsigned int i = 0; i < 6; ++i)
      EXPECT_EQ(after[i], before[i]);
  }


  // ---------------------------------------------------------------------------------------------
  // Lanes
  // ---------------------------------------------------------------------------------------------

  struct Point
  {
    Matrix H;
    Stress stress;
  };


  // A point of its own in each lane.
  std::array<Point, n_lanes>
  random_points(Random &random)
  {
    std::array<Point, n_lanes> points;
    for (auto &point : points)
      point = {minus_identity(random.deformation()), random.stress()};
    return points;
  }


  struct Result
  {
    Stress stress;
    Stress strain;
  };


  // Point (lane + shift) modulo the number of lanes stands in each lane; results by point.
  std::array<Result, n_lanes>
  update_in_lanes(const std::array<Point, n_lanes> &points, const unsigned int shift)
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
        member((lane + shift) % n_lanes) = values[lane];
    };

    Matrix3<Lanes> H;
    Symmetric3<Lanes> stress;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        H(i, j) = gather([&](const Point &point) { return point.H(i, j); });
    for (unsigned int i = 0; i < 6; ++i)
      stress[i] = gather([&](const Point &point) { return point.stress[i]; });

    const Matrix3<Lanes> F = identity_plus(1., H);
    const auto step        = arc_end_update(elastic,
                                     H,
                                     akmon::determinant(F, cofactor(F)),
                                     stress,
                                     (Lanes *)nullptr);

    std::array<Result, n_lanes> results;
    for (unsigned int i = 0; i < 6; ++i)
      {
        scatter(stress[i], [&](const unsigned int p) -> double & { return results[p].stress[i]; });
        scatter(step.strain[i],
                [&](const unsigned int p) -> double & { return results[p].strain[i]; });
      }
    return results;
  }


  TEST(ArcEndLanes, EveryLaneAgreesWithOneNumber)
  {
    Random random;
    // Only the contraction of multiplications and additions may differ.
    for (unsigned int trial = 0; trial < 20; ++trial)
      {
        const auto points  = random_points(random);
        const auto results = update_in_lanes(points, 0);
        for (unsigned int p = 0; p < n_lanes; ++p)
          {
            Stress stress   = points[p].stress;
            const auto step = update(elastic, identity_plus(1., points[p].H), stress);
            EXPECT_LT(distance(results[p].stress, stress), 1e-14 * norm(stress));
            EXPECT_LT(distance(results[p].strain, step.strain), 1e-14 * norm(step.strain));
          }
      }
  }


  TEST(ArcEndLanes, PointHasTheSameBitsInWhicheverLaneItStands)
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
} // namespace arc_end_test
