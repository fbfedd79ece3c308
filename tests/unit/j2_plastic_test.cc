#include <akmon/simd.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/j2_plastic.h"

// The closed forms below are those of small strain: stress increments C : d_strain without any map,
// then the return to the yield surface. Along a straight path of strain the deviator keeps its
// direction, so the closed-form return is exact for any number of steps.

namespace j2_plastic_test
{
  using namespace akmon;
  using namespace akmon::test;
  using namespace akmon::test::j2_points;

  // ---------------------------------------------------------------------------------------------
  // Closed forms, copper at 5 %
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
} // namespace j2_plastic_test
