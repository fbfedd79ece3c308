#include <akmon/material/arc_end.h>
#include <akmon/material/hypoelastic.h>
#include <akmon/material/j2_plastic.h>
#include <akmon/simd.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <iostream>
#include <limits>
#include <random>
#include <string>

// The closed forms below are those of small strain: stress increments C : d_strain without any map,
// then the return to the yield surface. Along a straight path of strain the deviator keeps its
// direction, so the closed-form return is exact for any number of steps.

namespace
{
  using namespace akmon;

  using Stress     = Symmetric3<double>;
  using StrainPath = std::function<Stress(double)>; // strain at 0 <= t <= 1, tensor components

  // Copper of the Taylor bar, MPa: E = 117 GPa, nu = 0.35, sigma_y = 400, h' = 100.
  const double E  = 117e3;
  const double nu = 0.35;
  const double H  = 100.;
  const J2Plastic copper{Elasticity::from_young(E, nu), 400., H};
  const double G = copper.elasticity.mu;
  const double K = copper.elasticity.lambda + 2. / 3. * G;


  struct State
  {
    Stress stress       = {};
    double eps_p        = 0.;
    double plastic_work = 0.;
  };


  Stress
  difference(const Stress &a, const Stress &b)
  {
    Stress result;
    for (unsigned int i = 0; i < 6; ++i)
      result[i] = a[i] - b[i];
    return result;
  }


  double
  norm(const Stress &s)
  {
    return std::sqrt(contract(s, s));
  }


  double
  equivalent_stress(const Stress &s)
  {
    return std::sqrt(equivalent_stress_squared(s));
  }


  // One small-strain increment; returns the plastic work.
  double
  strain_by(const J2Plastic &law, const Stress &strain, State &state)
  {
    state.stress      = state.stress + law.elasticity.stress(strain);
    const double work = law.return_to_yield_surface(state.stress, &state.eps_p);
    state.plastic_work += work;
    return work;
  }


  State
  integrate(const StrainPath &path, const unsigned int N)
  {
    State state;
    for (unsigned int n = 0; n < N; ++n)
      strain_by(copper, difference(path((n + 1.) / N), path(double(n) / N)), state);
    return state;
  }


  // The same numbers in every test, run alone or with the others.
  struct Random
  {
    std::mt19937 generator{1};

    double
    between(const double low, const double high)
    {
      return low + (high - low) * (generator() / 4294967296.);
    }

    Stress
    tensor(const double magnitude)
    {
      Stress result;
      for (unsigned int i = 0; i < 6; ++i)
        result[i] = between(-magnitude, magnitude);
      return result;
    }
  };


  // ---------------------------------------------------------------------------------------------
  // Closed forms, copper at 5 % (numbers also in references.md, section 8)
  // ---------------------------------------------------------------------------------------------

  TEST(J2Plastic, UniaxialStressFollowsTheTangentModulus)
  {
    // sigma = sigma_y + E_t (eps - sigma_y/E), E_t = E H/(E + H); eps_p = (sigma - sigma_y)/H. The
    // sides are free where their strain is -nu sigma/E - eps_p/2.
    const double yield_strain = 400. / E;
    const auto axial_stress   = [&](const double strain) {
      return strain <= yield_strain ? E * strain : 400. + E * H / (E + H) * (strain - yield_strain);
    };
    const auto path = [&](const double t) -> Stress {
      const double strain  = 0.05 * t;
      const double sigma   = axial_stress(strain);
      const double lateral = -nu * sigma / E - 0.5 * (strain - sigma / E);
      return {{strain, lateral, lateral, 0., 0., 0.}};
    };
    for (const unsigned int N : {1, 7, 100})
      {
        const State state = integrate(path, N);
        EXPECT_NEAR(state.stress[0], 404.65414, 0.5e-5) << N;
        EXPECT_NEAR(state.stress[0], axial_stress(0.05), 1e-9) << N;
        EXPECT_NEAR(state.eps_p, 0.046541418, 0.5e-9) << N;
        for (unsigned int i = 1; i < 6; ++i)
          EXPECT_NEAR(state.stress[i], 0., 1e-9) << N;
      }
  }


  TEST(J2Plastic, UniaxialStrainFollowsTheBulkModulusAboveYield)
  {
    // eps_p = (2 G eps - sigma_y)/(3 G + H), sigma11 = K eps + 2/3 (sigma_y + H eps_p),
    // sigma22 = K eps - 1/3 (sigma_y + H eps_p)
    const auto path = [](const double t) -> Stress { return {{0.05 * t, 0., 0., 0., 0., 0.}}; };
    for (const unsigned int N : {1, 7, 100})
      {
        const State state = integrate(path, N);
        EXPECT_NEAR(state.stress[0], 6768.6822, 0.5e-4) << N;
        EXPECT_NEAR(state.eps_p, 0.030233154, 0.5e-9) << N;
        EXPECT_NEAR(state.eps_p, (2. * G * 0.05 - 400.) / (3. * G + H), 1e-14) << N;
        const double y = 400. + H * state.eps_p;
        EXPECT_NEAR(state.stress[0], K * 0.05 + 2. / 3. * y, 1e-9) << N;
        EXPECT_NEAR(state.stress[1], K * 0.05 - 1. / 3. * y, 1e-9) << N;
        EXPECT_NEAR(state.stress[2], K * 0.05 - 1. / 3. * y, 1e-9) << N;
      }
  }


  TEST(J2Plastic, ShearFollowsTheYieldStressOverTheRootOfThree)
  {
    // Shear angle g = 0.05: eps_p = (sqrt(3) G g - sigma_y)/(3 G + H), tau = (sigma_y + H
    // eps_p)/sqrt(3); the same in each of the three planes.
    for (unsigned int component = 3; component < 6; ++component)
      for (const unsigned int N : {1, 7, 100})
        {
          const auto path = [&](const double t) {
            Stress strain     = {};
            strain[component] = 0.5 * 0.05 * t;
            return strain;
          };
          const State state = integrate(path, N);
          EXPECT_NEAR(state.stress[component], 232.42798, 0.5e-5) << N;
          EXPECT_NEAR(state.eps_p, 0.025770767, 0.5e-9) << N;
          EXPECT_NEAR(state.stress[component], (400. + H * state.eps_p) / std::sqrt(3.), 1e-9) << N;
          EXPECT_NEAR(trace(state.stress), 0., 1e-12);
        }
  }


  // ---------------------------------------------------------------------------------------------
  // With the ARC-end update
  // ---------------------------------------------------------------------------------------------

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
    // Stretch 0.9: reference solutions (references.md, section 8), an independent computation.
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
  // The return to the yield surface
  // ---------------------------------------------------------------------------------------------

  TEST(J2Plastic, ReturnEndsOnTheYieldSurface)
  {
    Random random;
    // F = q - (sigma_y + h' eps_p) = 0 after plastic flow, including with no hardening.
    for (const double hardening : {0., 100., 1e5})
      {
        const J2Plastic law{copper.elasticity, 400., hardening};
        for (unsigned int trial = 0; trial < 100; ++trial)
          {
            Stress stress       = random.tensor(5000.);
            const double before = random.between(0., 0.01);
            double eps_p        = before;
            ASSERT_GT(equivalent_stress(stress), 400. + hardening * before);
            law.return_to_yield_surface(stress, &eps_p);
            const double y = 400. + hardening * eps_p;
            EXPECT_GT(eps_p, before);
            EXPECT_NEAR(equivalent_stress(stress), y, 1e-12 * y);
          }
      }
  }


  TEST(J2Plastic, ReturnFollowsTheNormalOfTheYieldSurface)
  {
    Random random;
    // (25): sigma_trial - sigma = C : (d_eps dF/dsigma), dF/dsigma = 3/2 dev sigma/q at the end;
    // the flow has no trace, so the pressure stays.
    for (unsigned int trial = 0; trial < 100; ++trial)
      {
        const Stress trial_stress = random.tensor(5000.);
        Stress stress             = trial_stress;
        double eps_p              = 0.01;
        copper.return_to_yield_surface(stress, &eps_p);
        const double d_eps = eps_p - 0.01;
        EXPECT_GT(d_eps, 0.);
        const double q = equivalent_stress(stress);
        Stress flow    = add_to_diagonal(stress, -trace(stress) / 3.);
        for (unsigned int i = 0; i < 6; ++i)
          flow[i] *= 1.5 / q * d_eps;
        EXPECT_LT(norm(
                    difference(difference(trial_stress, stress), copper.elasticity.stress(flow))),
                  1e-12 * norm(trial_stress));
        EXPECT_NEAR(trace(stress), trace(trial_stress), 1e-12 * norm(trial_stress));
      }
  }


  TEST(J2Plastic, PressureAloneNeverYields)
  {
    Stress stress = {{-1e5, -1e5, -1e5, 0., 0., 0.}};
    double eps_p  = 0.;
    EXPECT_EQ(copper.return_to_yield_surface(stress, &eps_p), 0.);
    EXPECT_EQ(eps_p, 0.);
    for (unsigned int i = 0; i < 3; ++i)
      EXPECT_NEAR(stress[i], -1e5, 1e-9);
  }


  TEST(J2Plastic, YieldsFromTheYieldStressOn)
  {
    // Pure shear: q = sqrt(3) tau
    for (const double factor : {1. - 1e-9, 1. + 1e-9})
      {
        Stress stress = {{0., 0., 0., 0., factor * 400. / std::sqrt(3.), 0.}};
        double eps_p  = 0.;
        copper.return_to_yield_surface(stress, &eps_p);
        EXPECT_EQ(eps_p > 0., factor > 1.);
      }
  }


  TEST(J2Plastic, UnloadingIsElastic)
  {
    State state;
    strain_by(copper, {{0.02, -0.01, 0., 0.01, 0., 0.005}}, state);
    const State loaded = state;
    const Stress back{{-1e-3, 0.5e-3, 0., -0.5e-3, 0., -0.25e-3}};
    EXPECT_EQ(strain_by(copper, back, state), 0.);
    EXPECT_EQ(state.eps_p, loaded.eps_p);
    EXPECT_LT(norm(difference(state.stress, loaded.stress + copper.elasticity.stress(back))),
              1e-12 * norm(loaded.stress));
  }


  TEST(J2Plastic, ReversedLoadingYieldsAtTheHardenedStress)
  {
    // Isotropic hardening: after shear to tau_1 = y_1/sqrt(3) the elastic range is 2 tau_1.
    State state;
    strain_by(copper, {{0., 0., 0., 0.05, 0., 0.}}, state);
    const double eps_p = state.eps_p;
    const double range = (400. + H * eps_p) / std::sqrt(3.) / G; // tensor strain of 2 tau_1/(2 G)
    EXPECT_EQ(strain_by(copper, {{0., 0., 0., -range * (1. - 1e-9), 0., 0.}}, state), 0.);
    EXPECT_GT(strain_by(copper, {{0., 0., 0., -range * 2e-9, 0., 0.}}, state), 0.);
  }


  TEST(J2Plastic, NoStressMakesNoNaN)
  {
    Stress stress = {};
    double eps_p  = 0.;
    EXPECT_EQ(copper.return_to_yield_surface(stress, &eps_p), 0.);
    EXPECT_EQ(eps_p, 0.);
    for (unsigned int i = 0; i < 6; ++i)
      EXPECT_EQ(stress[i], 0.);

    Symmetric3<Lanes> lanes;
    for (unsigned int i = 0; i < 6; ++i)
      lanes[i] = Lanes(0.);
    Lanes eps_p_lanes(0.);
    const Lanes work = copper.return_to_yield_surface(lanes, &eps_p_lanes);
    for (unsigned int lane = 0; lane < n_lanes; ++lane)
      {
        EXPECT_EQ(work.get(lane), 0.);
        EXPECT_EQ(eps_p_lanes.get(lane), 0.);
        for (unsigned int i = 0; i < 6; ++i)
          EXPECT_EQ(lanes[i].get(lane), 0.);
      }

    // The smallest numbers, whose square underflows
    Stress small = {{std::numeric_limits<double>::denorm_min(), 1e-300, -1e-200, 1e-160, 0., 0.}};
    EXPECT_EQ(copper.return_to_yield_surface(small, &eps_p), 0.);
    for (unsigned int i = 0; i < 6; ++i)
      EXPECT_TRUE(std::isfinite(small[i]));
  }


  // ---------------------------------------------------------------------------------------------
  // Dissipation
  // ---------------------------------------------------------------------------------------------

  TEST(J2Plastic, PlasticWorkOfAUniaxialTestIsTheAreaUnderTheCurveWithoutTheElasticTriangle)
  {
    // Bilinear curve: the work of the stress up to 5 % is the triangle up to yield and the
    // trapezium above it; sigma^2/(2 E) of it is stored. It is also the integral of the yield
    // stress over eps_p, sigma_y eps_p + H eps_p^2/2, in however many steps.
    const double yield_strain = 400. / E;
    const double final_stress = 400. + E * H / (E + H) * (0.05 - yield_strain);
    const double work         = 0.5 * 400. * yield_strain +
                        0.5 * (400. + final_stress) * (0.05 - yield_strain);
    const double dissipated = work - 0.5 * final_stress * final_stress / E;
    const auto path         = [&](const double t) -> Stress {
      const double strain  = 0.05 * t;
      const double sigma   = strain <= yield_strain ?
                                       E * strain :
                                       400. + E * H / (E + H) * (strain - yield_strain);
      const double lateral = -nu * sigma / E - 0.5 * (strain - sigma / E);
      return {{strain, lateral, lateral, 0., 0., 0.}};
    };
    for (const unsigned int N : {1, 7, 100})
      {
        const State state = integrate(path, N);
        EXPECT_NEAR(state.plastic_work, dissipated, 1e-12 * dissipated) << N;
        EXPECT_NEAR(state.plastic_work,
                    400. * state.eps_p + 0.5 * H * state.eps_p * state.eps_p,
                    1e-12 * dissipated)
          << N;
      }
  }


  TEST(J2Plastic, PlasticWorkIsNeverNegative)
  {
    Random random;
    State state;
    unsigned int plastic_steps = 0;
    for (unsigned int step = 0; step < 1000; ++step)
      {
        const double before = state.eps_p;
        const double work   = strain_by(copper, random.tensor(2e-3), state);
        EXPECT_GE(work, 0.);
        EXPECT_EQ(work > 0., state.eps_p > before);
        plastic_steps += work > 0.;
      }
    EXPECT_GT(plastic_steps, 100u);
    EXPECT_LT(plastic_steps, 900u);
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
} // namespace
