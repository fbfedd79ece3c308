#include <akmon/material/arc_end.h>
#include <akmon/material/hypoelastic.h>
#include <akmon/simd.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <iostream>
#include <random>
#include <string>
#include <utility>
#include <vector>

// The exact stresses below solve the Truesdell rate equation with constant moduli,
//
//     d sigma/dt = L sigma + sigma L^T - tr(L) sigma + C : sym(L),   sigma(0) = 0,
//
// with M = lambda + 2 mu and K = lambda + 2/3 mu, for a straining whose path each test names. The
// numbers for N steps are those of the reference solutions (references.md, section 8), independent
// computations of the ARC-end update given to six decimals.

namespace
{
  using namespace akmon;

  using Matrix = Matrix3<double>;
  using Stress = Symmetric3<double>;
  using Path   = std::function<Matrix(double)>; // deformation gradient at 0 <= t <= 1, the identity
                                                // at 0
  using Update = std::function<void(const Matrix &F, Stress &stress)>; // one step

  constexpr double half_a_printed_digit = 0.5e-6;

  // E = 1000, nu = 0.25: lambda = mu = 400, M = 1200, K = 2000/3.
  const double E  = 1000.;
  const double nu = 0.25;
  const Hypoelastic elastic{Elasticity::from_young(E, nu)};


  Matrix
  diagonal(const double x, const double y, const double z)
  {
    return {{{x, 0., 0.}, {0., y, 0.}, {0., 0., z}}};
  }


  Matrix
  transpose(const Matrix &a)
  {
    Matrix result;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        result(i, j) = a(j, i);
    return result;
  }


  double
  determinant(const Matrix &a)
  {
    return akmon::determinant(a, cofactor(a));
  }


  Matrix
  inverse(const Matrix &a)
  {
    const Matrix identity = diagonal(1., 1., 1.);
    return times_inverse(identity, cofactor(a), 1. / determinant(a));
  }


  // a - I
  Matrix
  minus_identity(Matrix a)
  {
    for (unsigned int i = 0; i < 3; ++i)
      a(i, i) -= 1.;
    return a;
  }


  // Rodrigues' formula about the axis (x, y, z), of any length.
  Matrix
  rotation(const double degrees, const double x, const double y, const double z)
  {
    const double length = std::sqrt(x * x + y * y + z * z);
    const double n[3]   = {x / length, y / length, z / length};
    const double angle  = degrees * std::acos(-1.) / 180.;
    const double c = std::cos(angle), s = std::sin(angle);
    const double cross[3][3] = {{0., -n[2], n[1]}, {n[2], 0., -n[0]}, {-n[1], n[0], 0.}};
    Matrix result;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        result(i, j) = (i == j ? c : 0.) + s * cross[i][j] + (1. - c) * n[i] * n[j];
    return result;
  }


  Matrix
  rotation(const double degrees)
  {
    return rotation(degrees, 1., 2., -0.5);
  }


  // Q s Q^T
  Stress
  rotated(const Matrix &Q, const Stress &s)
  {
    return push_forward(Q, s, 1.);
  }


  double
  norm(const Stress &s)
  {
    return std::sqrt(contract(s, s));
  }


  double
  distance(const Stress &a, const Stress &b)
  {
    Stress difference;
    for (unsigned int i = 0; i < 6; ++i)
      difference[i] = a[i] - b[i];
    return norm(difference);
  }


  template <typename Law>
  StressIncrement<double>
  update(const Law &law, const Matrix &F, Stress &stress, double *internals = nullptr)
  {
    return arc_end_update(law, minus_identity(F), determinant(F), stress, internals);
  }


  void
  arc_end(const Matrix &F, Stress &stress)
  {
    update(elastic, F, stress);
  }


  Stress
  one_step(const Update &step, const Matrix &F, Stress stress = {})
  {
    step(F, stress);
    return stress;
  }


  // Stress at the end of the path, in N equal steps of its parameter from no stress.
  Stress
  integrate(const Path &path, const unsigned int N, const Update &step = arc_end)
  {
    Stress stress = {};
    for (unsigned int n = 0; n < N; ++n)
      step(path((n + 1.) / N) * inverse(path(double(n) / N)), stress);
    return stress;
  }


  // Observed order of convergence from the errors with N and 2N steps.
  double
  observed_order(const double error, const double error_half_step)
  {
    return std::log2(error / error_half_step);
  }


  void
  report(const std::string &key, const double value)
  {
    ::testing::Test::RecordProperty(key, std::to_string(value));
    std::cout << "  " << key << " = " << value << '\n';
  }


  Path
  uniaxial_strain(const double stretch)
  {
    return [=](const double t) { return diagonal(1. + (stretch - 1.) * t, 1., 1.); };
  }


  // Turns by 90 degrees while it stretches.
  Matrix
  rotating_stretch(const double t)
  {
    return rotation(90. * t, 0., 0., 1.) * diagonal(1. + 0.3 * t, 1. - 0.1 * t, 1. + 0.1 * t);
  }

  // Exact at t = 1: the Truesdell rate does not see the rotation, so the stretch alone may be
  // integrated (d sigma_i/dt = (2 l_i'/l_i - sum l_k'/l_k) sigma_i + lambda sum l_k'/l_k + 2 mu
  // l_i'/l_i, by quadrature) and turned by 90 degrees at the end.
  const Stress rotating_stretch_exact = {{12.021976, 358.185785, 172.621651, 0., 0., 0.}};


  // As above with Simpson's rule over the integrating factor J/l_i^2, for orders at small errors.
  Stress
  rotating_stretch_by_quadrature()
  {
    const double rates[3] = {0.3, -0.1, 0.1};
    const auto stretch    = [&](const unsigned int i, const double t) { return 1. + rates[i] * t; };
    const auto volume     = [&](const double t) {
      return stretch(0, t) * stretch(1, t) * stretch(2, t);
    };
    const auto integrand = [&](const unsigned int i, const double t) {
      double volumetric = 0.;
      for (unsigned int k = 0; k < 3; ++k)
        volumetric += rates[k] / stretch(k, t);
      return volume(t) / (stretch(i, t) * stretch(i, t)) *
             (elastic.elasticity.lambda * volumetric +
              2. * elastic.elasticity.mu * rates[i] / stretch(i, t));
    };
    double principal[3];
    const unsigned int intervals = 1000;
    for (unsigned int i = 0; i < 3; ++i)
      {
        double sum = 0.;
        for (unsigned int k = 0; k < intervals; ++k)
          sum += (integrand(i, double(k) / intervals) + 4. * integrand(i, (k + 0.5) / intervals) +
                  integrand(i, (k + 1.) / intervals)) /
                 (6. * intervals);
        principal[i] = sum * stretch(i, 1.) * stretch(i, 1.) / volume(1.);
      }
    return {{principal[1], principal[0], principal[2], 0., 0., 0.}};
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

    // I + entries up to 0.3: 50 % strains and 20 degree turns, no inversion.
    Matrix
    deformation()
    {
      Matrix F = diagonal(1., 1., 1.);
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          F(i, j) += between(-0.3, 0.3);
      return F;
    }

    Stress
    stress()
    {
      Stress result;
      for (unsigned int i = 0; i < 6; ++i)
        result[i] = between(-300., 300.);
      return result;
    }
  };


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
  // Objectivity
  // ---------------------------------------------------------------------------------------------

  TEST(ArcEnd, RigidRotationInOneStepTurnsTheStress)
  {
    // E = 0 for F = Q, so sigma_{n+1} = Q sigma_n Q^T; at 180 degrees F_m is singular.
    const Stress before = {{120., -340., 55., 210., -75., 33.}};
    for (const double degrees : {10., 90., 170.})
      {
        const Matrix Q  = rotation(degrees);
        Stress after    = before;
        const auto step = update(elastic, Q, after);
        EXPECT_LT(distance(after, rotated(Q, before)), 1e-12 * norm(before)) << degrees;
        EXPECT_LT(norm(step.strain), 1e-13) << degrees;
      }
  }


  TEST(ArcEnd, ChangeOfFrameChangesNothing)
  {
    Random random;
    // Both configurations turned by the same Q: F -> Q F Q^T, sigma_n -> Q sigma_n Q^T. C is
    // isotropic, so sigma_{n+1} -> Q sigma_{n+1} Q^T and E_mid likewise.
    for (const double degrees : {10., 90., 170.})
      for (unsigned int trial = 0; trial < 20; ++trial)
        {
          const Matrix Q       = rotation(degrees);
          const Matrix F       = random.deformation();
          Stress fixed         = random.stress();
          Stress turned        = rotated(Q, fixed);
          const auto in_fixed  = update(elastic, F, fixed);
          const auto in_turned = update(elastic, Q * F * transpose(Q), turned);
          EXPECT_LT(distance(turned, rotated(Q, fixed)), 1e-12 * norm(fixed));
          EXPECT_LT(distance(in_turned.strain, rotated(Q, in_fixed.strain)), 1e-13);
        }
  }


  TEST(ArcEnd, OldStressIsCarriedObjectivelyWhateverTheStepDoes)
  {
    Random random;
    // sigma_hat = J^{-1} F sigma_n F^T (18), seen by a law without stiffness: for F -> Q F exactly
    // Q sigma_hat Q^T.
    const Hypoelastic no_stiffness{};
    const Matrix F{{{1.3, 0.2, -0.1}, {-0.05, 0.8, 0.15}, {0.1, 0.05, 1.1}}};
    const Stress before = random.stress();
    Stress straight     = before;
    update(no_stiffness, F, straight);
    EXPECT_LT(distance(straight, push_forward(F, before, 1. / determinant(F))),
              1e-12 * norm(straight));
    for (const double degrees : {10., 90., 150.})
      {
        const Matrix Q = rotation(degrees);
        Stress turned  = before;
        update(no_stiffness, Q * F, turned);
        EXPECT_LT(distance(turned, rotated(Q, straight)), 1e-12 * norm(straight)) << degrees;
      }
  }


  // |sigma(Q F) - Q sigma(F) Q^T| / |sigma(F)|, from no stress
  double
  lack_of_objectivity(const Update &step, const Matrix &F, const Matrix &Q)
  {
    const Stress straight = one_step(step, F);
    return distance(one_step(step, Q * F), rotated(Q, straight)) / norm(straight);
  }


  // A step of relative size h that stretches by up to 20 % h and turns by 40 degrees h.
  double
  lack_of_objectivity(const Update &step, const double h)
  {
    return lack_of_objectivity(step,
                               diagonal(1. + 0.2 * h, 1. - 0.1 * h, 1. + 0.1 * h),
                               rotation(40. * h));
  }


  TEST(ArcEnd, StretchAndTurnInOneStepIsObjectiveToSecondOrderOnly)
  {
    // Turning x_{n+1} alone, F -> Q F, turns the new stress exactly if F is a rotation, not if it
    // stretches: F_me E_mid F_me^T = Q F C_m^{-1} E C_m^{-1} F^T Q^T, and
    // C_m = F_m^T F_m = (I + F^T F + Q F + F^T Q^T)/4 depends on Q. Its change is O(h^2) for
    // stretch and turn of O(h), as is the error of the method.
    const double order = observed_order(lack_of_objectivity(arc_end, 0.1),
                                        lack_of_objectivity(arc_end, 0.05));
    report("order_of_objectivity_arc_end", order);
    EXPECT_GT(order, 1.95);
    EXPECT_LT(order, 2.05);

    // For a vanishing stretch, in the plane of the rotation F_m = c R(theta/2) with c =
    // cos(theta/2), so F_me = R(theta/2)/c, J_me = 1/c^2 and E_mid = E/c^2; along the axis both
    // maps are 1. Strain e along the axis then gives M e c^2 instead of M e ...
    const double e     = 1e-7;
    const double angle = 40. * std::acos(-1.) / 180.;
    const double c2    = std::pow(std::cos(angle / 2.), 2);
    const Matrix Q     = rotation(40., 0., 0., 1.);
    const Stress along = one_step(arc_end, Q * diagonal(1., 1., 1. + e));
    EXPECT_NEAR(along[2], 1200. * e * c2, 1e-5 * 1200. * e);
    // ... and e in all directions of the plane 2 (lambda + mu) e/c^2 instead of 2 (lambda + mu) e.
    const Stress across = one_step(arc_end, Q * diagonal(1. + e, 1. + e, 1.));
    EXPECT_NEAR(across[0], 1600. * e / c2, 1e-5 * 1600. * e);
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
  // The paper as printed
  // ---------------------------------------------------------------------------------------------

  Matrix
  mid_map(const Matrix &F)
  {
    return identity_plus(0.5, minus_identity(F));
  }


  // Problem 1, (13) with (18)-(24) to the letter: J^t_mid F^mid_t (C : E_mid) F^mid_t^T, where
  // F^mid_t is the inverse of F^t_mid = (I + F)/2 (22), and E_mid from the Green-Lagrange strain
  // (19)(20).
  void
  printed_problem_1(const Matrix &F, Stress &stress)
  {
    const Matrix F_m         = mid_map(F);
    const Matrix inverse_F_m = inverse(F_m);
    const Matrix twice_E_mid = transpose(inverse_F_m) * minus_identity(transpose(F) * F) *
                               inverse_F_m;
    Stress E_mid = symmetric_part(twice_E_mid);
    for (unsigned int i = 0; i < 6; ++i)
      E_mid[i] *= 0.5;
    stress = push_forward(F, stress, 1. / determinant(F)) +
             push_forward(inverse_F_m, elastic.elasticity.stress(E_mid), determinant(F_m));
  }


  // Algorithm 1, step 3 to the letter: the same map, and E_mid = (F_m^T F_m - (F_m F_m^T)^{-1})/2,
  // which is (19) for F = F_m F_m.
  void
  printed_algorithm_1(const Matrix &F, Stress &stress)
  {
    const Matrix F_m         = mid_map(F);
    const Matrix inverse_F_m = inverse(F_m);
    const Stress right       = symmetric_part(transpose(F_m) * F_m);
    const Stress left        = symmetric_part(transpose(inverse_F_m) * inverse_F_m);
    Stress E_mid;
    for (unsigned int i = 0; i < 6; ++i)
      E_mid[i] = 0.5 * (right[i] - left[i]);
    stress = push_forward(F, stress, 1. / determinant(F)) +
             push_forward(inverse_F_m, elastic.elasticity.stress(E_mid), determinant(F_m));
  }


  // A push-forward after all, but with both half maps (I + F)/2 (22).
  void
  equal_half_maps(const Matrix &F, Stress &stress)
  {
    const Matrix F_m         = mid_map(F);
    const Matrix inverse_F_m = inverse(F_m);
    const Matrix L           = minus_identity(F) * inverse_F_m;
    stress                   = push_forward(F, stress, 1. / determinant(F)) +
             push_forward(F_m, elastic.elasticity.stress(symmetric_part(L)), 1. / determinant(F_m));
  }


  struct Reading
  {
    std::string name;
    Update step;
    double order;
  };

  const std::vector<Reading> readings = {{"problem_1", printed_problem_1, 1.},
                                         {"algorithm_1", printed_algorithm_1, 1.},
                                         {"equal_half_maps", equal_half_maps, 2.},
                                         {"arc_end", arc_end, 2.}};


  double
  rotating_error(const Reading &reading, const unsigned int N)
  {
    const Stress exact = rotating_stretch_by_quadrature();
    return distance(integrate(rotating_stretch, N, reading.step), exact) / norm(exact);
  }


  // The lateral stress belongs to it: with equal half maps sigma11 happens to be exact.
  double
  uniaxial_error(const Reading &reading, const unsigned int N)
  {
    const Stress exact{{600., 400. / 3., 400. / 3., 0., 0., 0.}};
    return distance(integrate(uniaxial_strain(1.5), N, reading.step), exact) / norm(exact);
  }


  TEST(ArcEndAsPrinted, InverseMidMapIsOfFirstOrderAndEqualHalfMapsOfSecond)
  {
    for (const auto &reading : readings)
      {
        for (const unsigned int N : {1, 4, 10, 100})
          {
            report(reading.name + "_rotating_error_" + std::to_string(N),
                   rotating_error(reading, N));
            report(reading.name + "_uniaxial_error_" + std::to_string(N),
                   uniaxial_error(reading, N));
          }
        const double rotating = observed_order(rotating_error(reading, 200),
                                               rotating_error(reading, 400));
        const double uniaxial = observed_order(uniaxial_error(reading, 200),
                                               uniaxial_error(reading, 400));
        report(reading.name + "_rotating_order", rotating);
        report(reading.name + "_uniaxial_order", uniaxial);
        EXPECT_NEAR(rotating, reading.order, 0.05) << reading.name;
        EXPECT_NEAR(uniaxial, reading.order, 0.05) << reading.name;
      }
  }


  TEST(ArcEndAsPrinted, InverseMidMapIsObjectiveToFirstOrderAndEqualHalfMapsToSecond)
  {
    for (const auto &reading : readings)
      {
        for (const double degrees : {1., 10., 40., 90.})
          report(reading.name + "_lack_of_objectivity_" + std::to_string(int(degrees)),
                 lack_of_objectivity(reading.step, diagonal(1.02, 0.99, 1.01), rotation(degrees)));
        const double order = observed_order(lack_of_objectivity(reading.step, 0.02),
                                            lack_of_objectivity(reading.step, 0.01));
        report(reading.name + "_objectivity_order", order);
        EXPECT_NEAR(order, reading.order, 0.05) << reading.name;
      }
  }


  TEST(ArcEndAsPrinted, StrainOfAlgorithmOneMakesStressInRigidRotation)
  {
    // All readings but this one have E = 0 for F = Q. With F_m = c R(theta/2) in the plane,
    // c = cos(theta/2), the strain of Algorithm 1 is (c^2 - 1/c^2)/2 there and 0 along the axis;
    // the map c^2 F_m^{-1} (.) F_m^{-T} leaves (lambda + mu)(c^2 - 1/c^2) in the plane and
    // multiplies lambda (c^2 - 1/c^2) along the axis by c^2.
    for (const double degrees : {1., 10., 90.})
      {
        const double c2     = std::pow(std::cos(degrees / 360. * std::acos(-1.)), 2);
        const double strain = c2 - 1. / c2;
        const Matrix Q      = rotation(degrees, 0., 0., 1.);
        const Stress stress = one_step(printed_algorithm_1, Q);
        report("algorithm_1_rigid_rotation_pressure_over_E_" + std::to_string(int(degrees)),
               stress[0] / E);
        EXPECT_LT(distance(stress,
                           {{800. * strain, 800. * strain, 400. * c2 * strain, 0., 0., 0.}}),
                  1e-12 * E);
        for (const auto &step : {printed_problem_1, equal_half_maps, arc_end})
          EXPECT_LT(norm(one_step(step, Q)), 1e-12 * E);
      }
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
} // namespace
