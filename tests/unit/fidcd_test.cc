#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/oscillator.h"
#include "support/report.h"

// FIDCD (28)-(35) on single masses: exact solutions of the motion, and exact solutions of the
// difference equation where there are any.

namespace fidcd_test
{
  using akmon::test::report;
  using namespace akmon::test::oscillator;


  TEST(Fidcd, MassesOfTheCubeAreOne)
  {
    const Oscillator cube(0., 0., no_force, constant(1.));
    for (unsigned int node = 0; node < 8; ++node)
      EXPECT_NEAR(cube.discretization.mass[node], 1., 1e-15);
  }


  TEST(Fidcd, SolvesTheDifferenceEquationExactly)
  {
    // u_{n+1} - 2 u_n + u_{n-1} = -omega^2 dt^2 u_n with u_1 = u_0 + dt v_0 - (omega dt)^2 u_0/2:
    // u_n = u_0 cos(n a) + v_0 dt/sin(a) sin(n a), sin(a/2) = omega dt/2.
    const double omega = 2., u_0 = 0.7, v_0 = -1.1;
    for (const double courant : {0.01, 0.3, 1., 1.7, 1.99})
      {
        const double dt = courant / omega, a = 2. * std::asin(0.5 * courant);
        const auto exact = [&](const double n) {
          return u_0 * std::cos(n * a) + v_0 * dt / std::sin(a) * std::sin(n * a);
        };
        Oscillator oscillator(
          u_0, v_0, [&](double u, double) { return -omega * omega * u; }, constant(dt));
        const double size = std::abs(u_0) + std::abs(v_0 * dt / std::sin(a));
        EXPECT_NEAR(oscillator.velocity(), v_0, 1e-14 / dt);
        for (unsigned int n = 1; n <= 1000; ++n)
          {
            oscillator.advance();
            ASSERT_NEAR(oscillator.displacement(), exact(n), 1e-10 * size) << courant << " " << n;
            ASSERT_NEAR(oscillator.velocity(),
                        (exact(n + 1.) - exact(n - 1.)) / (2. * dt),
                        1e-10 * size / dt);
            ASSERT_EQ(oscillator.unrest(), 0.);
            for (const unsigned int node : {1, 2})
              ASSERT_NEAR(oscillator.displacement(node), exact(n), 1e-10 * size);
          }
      }
  }


  // Largest error of displacement and velocity until t = 3 against u_0 cos + v_0/omega sin.
  double
  error_of_oscillation(const Steps &steps)
  {
    const double omega = 2., u_0 = 0.7, v_0 = -1.1;
    Oscillator oscillator(
      u_0, v_0, [&](double u, double) { return -omega * omega * u; }, steps);
    double worst = 0.;
    while (oscillator.time() < 3.)
      {
        oscillator.advance();
        const double phase = omega * oscillator.time();
        const double u     = u_0 * std::cos(phase) + v_0 / omega * std::sin(phase);
        const double v     = v_0 * std::cos(phase) - u_0 * omega * std::sin(phase);
        worst              = std::max(
          {worst, std::abs(oscillator.displacement() - u), std::abs(oscillator.velocity() - v)});
      }
    return worst;
  }


  double
  order(const double coarse, const double fine)
  {
    return std::log2(coarse / fine);
  }


  TEST(Fidcd, IsOfSecondOrderWithConstantAndSmoothlyVaryingSteps)
  {
    for (const double dt : {0.02, 0.01, 0.005})
      {
        const double constant_order = order(error_of_oscillation(constant(dt)),
                                            error_of_oscillation(constant(0.5 * dt)));
        const double smooth_order   = order(error_of_oscillation(smooth(dt)),
                                          error_of_oscillation(smooth(0.5 * dt)));
        report("order with constant steps", constant_order);
        report("order with varying steps", smooth_order);
        EXPECT_NEAR(constant_order, 2., 0.05);
        EXPECT_NEAR(smooth_order, 2., 0.1);
      }
  }


  TEST(Fidcd, DrivenMotionIsOfSecondOrderToo)
  {
    // u'' = sin(5 t) from rest: u = t/5 - sin(5 t)/25.
    const auto error = [](const Steps &steps) {
      Oscillator mass(
        0., 0., [](double, const double t) { return std::sin(5. * t); }, steps);
      double worst = 0.;
      while (mass.time() < 3.)
        {
          mass.advance();
          worst = std::max(worst,
                           std::abs(mass.displacement() - mass.time() / 5. +
                                    std::sin(5. * mass.time()) / 25.));
        }
      return worst;
    };
    EXPECT_NEAR(order(error(constant(0.01)), error(constant(0.005))), 2., 0.05);
    EXPECT_NEAR(order(error(smooth(0.01)), error(smooth(0.005))), 2., 0.1);
  }


  TEST(Fidcd, FreeFlightIsExactWithAnySteps)
  {
    for (const auto &steps : {constant(0.1), smooth(0.1), erratic(0.1)})
      {
        Oscillator mass(0., 1.3, no_force, steps);
        for (unsigned int n = 0; n < 1000; ++n)
          {
            mass.advance();
            ASSERT_NEAR(mass.displacement(), 1.3 * mass.time(), 1e-12 * (1. + mass.time()));
            ASSERT_NEAR(mass.velocity(), 1.3, 1e-12);
            ASSERT_NEAR(mass.kinetic_energy(), 0.5 * 1.3 * 1.3, 1e-12);
          }
      }
  }


  TEST(Fidcd, FallUnderAConstantForceIsExactWithAnySteps)
  {
    // The velocity between the levels, v_0 + g (t + dt'/2), is exact, hence so are the positions;
    // the velocity at a level is the mean of two: off by g (dt' - dt)/4.
    const double g = -9.81, v_0 = 3.;
    for (const auto &steps : {constant(0.1), smooth(0.1), erratic(0.1)})
      {
        Oscillator mass(
          0.2, v_0, [&](double, double) { return g; }, steps);
        for (unsigned int n = 0; n < 300; ++n)
          {
            mass.advance();
            const double t = mass.time();
            ASSERT_NEAR(mass.displacement(),
                        0.2 + v_0 * t + 0.5 * g * t * t,
                        1e-12 * (1. + t * t * 9.));
            ASSERT_NEAR(mass.velocity(),
                        v_0 + g * t + 0.25 * g * (mass.state.dt_next - mass.state.dt),
                        1e-11 * (1. + t));
          }
      }
  }


  TEST(Fidcd, StartingStepGivesTheFirstIncrementAndTheInitialVelocity)
  {
    // (28)(29): dx_0 = dt v_0 + dt^2/2 (F_0/m - eta v_0), and v at n = 0 is v_0.
    const double dt = 0.1, v_0 = 2., eta = 3., F = 5.;
    Oscillator mass(
      0., v_0, [&](double, double) { return F; }, constant(dt), eta);
    EXPECT_NEAR(mass.velocity(), v_0, 1e-13);
    EXPECT_NEAR(mass.kinetic_energy(), 0.5 * v_0 * v_0, 1e-12);
    mass.integrator.predict();
    EXPECT_NEAR(mass.displacement(), dt * v_0 + 0.5 * dt * dt * (F - eta * v_0), 1e-15);
  }


  TEST(Fidcd, DampedFlightSolvesTheDifferenceEquationAndIsOfSecondOrder)
  {
    // v_{n+1/2} = v_{n-1/2} (1 - eta dt/2)/(1 + eta dt/2), v_{1/2} = v_0 (1 - eta dt/2); the motion
    // itself is v_0 exp(-eta t).
    const double eta = 2., v_0 = 1.5;
    const double dt = 0.01;
    Oscillator mass(0., v_0, no_force, constant(dt), eta);
    double v = v_0 * (1. - 0.5 * eta * dt), u = 0.;
    for (unsigned int n = 0; n < 300; ++n)
      {
        mass.advance();
        u += dt * v;
        ASSERT_NEAR(mass.displacement(), u, 1e-13);
        v *= (1. - 0.5 * eta * dt) / (1. + 0.5 * eta * dt);
      }

    const auto error = [&](const Steps &steps) {
      Oscillator damped(0., v_0, no_force, steps, eta);
      double worst = 0.;
      while (damped.time() < 2.)
        {
          damped.advance();
          const double decay = std::exp(-eta * damped.time());
          worst              = std::max({worst,
                                         std::abs(damped.velocity() - v_0 * decay),
                                         std::abs(damped.displacement() - v_0 / eta * (1. - decay))});
        }
      return worst;
    };
    report("damping error at dt = 0.01", error(constant(0.01)));
    const double constant_order = order(error(constant(0.01)), error(constant(0.005)));
    const double smooth_order   = order(error(smooth(0.01)), error(smooth(0.005)));
    report("order of damping with constant steps", constant_order);
    report("order of damping with varying steps", smooth_order);
    EXPECT_NEAR(constant_order, 2., 0.05);
    EXPECT_NEAR(smooth_order, 2., 0.1);
    EXPECT_LE(error(constant(0.01)), v_0 * std::pow(eta * 0.01, 2));
  }


  TEST(Fidcd, DampedOscillationIsOfSecondOrder)
  {
    // u'' + eta u' + omega^2 u = 0 from rest at u_0.
    const double eta = 0.8, omega = 2., u_0 = 1., a = 0.5 * eta;
    const double b   = std::sqrt(omega * omega - a * a);
    const auto error = [&](const Steps &steps) {
      Oscillator damped(
        u_0, 0., [&](double u, double) { return -omega * omega * u; }, steps, eta);
      double worst = 0.;
      while (damped.time() < 3.)
        {
          damped.advance();
          const double t = damped.time();
          const double u = u_0 * std::exp(-a * t) * (std::cos(b * t) + a / b * std::sin(b * t));
          worst          = std::max(worst, std::abs(damped.displacement() - u));
        }
      return worst;
    };
    EXPECT_NEAR(order(error(constant(0.02)), error(constant(0.01))), 2., 0.05);
    EXPECT_NEAR(order(error(smooth(0.02)), error(smooth(0.01))), 2., 0.1);
  }


  TEST(Fidcd, IsStableUpToTwoOverOmega)
  {
    const double omega = 3.;
    for (const double courant : {1.9, 1.999, 2.001, 2.1})
      {
        Oscillator oscillator(
          1., 0., [&](double u, double) { return -omega * omega * u; }, constant(courant / omega));
        double largest = 0.;
        for (unsigned int n = 0; n < 2000; ++n)
          {
            oscillator.advance();
            largest = std::max(largest, std::abs(oscillator.displacement()));
          }
        if (courant < 2.)
          EXPECT_LE(largest, 1. + 1e-9) << courant;
        else
          EXPECT_GE(largest, 1e3) << courant;
      }
  }


  TEST(Fidcd, KineticEnergyAnswersToTheWorkOfTheForcesExactly)
  {
    // (1/2) m v_{n-1/2} v_{n+1/2} + k u_n^2/2 is constant from the first full step on.
    const double omega = 2.;
    Oscillator oscillator(
      0.7, -1.1, [&](double u, double) { return -omega * omega * u; }, constant(0.4));
    const auto energy = [&]() {
      return oscillator.kinetic_energy() + 0.5 * std::pow(omega * oscillator.displacement(), 2);
    };
    oscillator.advance();
    const double first = energy();
    for (unsigned int n = 0; n < 1000; ++n)
      {
        oscillator.advance();
        ASSERT_NEAR(energy(), first, 1e-12 * first);
      }
  }


  TEST(Fidcd, DampingWorkIsThatOfTheDampingForce)
  {
    const double eta = 2., dt = 0.01;
    Oscillator mass(0., 1.5, no_force, constant(dt), eta);
    mass.advance();
    // Three equal masses: - m eta v . dx each.
    const double dx = mass.state.dx_next.local_element(0);
    EXPECT_NEAR(mass.integrator.damping_work(mass.state.dx_next),
                -3. * eta * mass.velocity() * dx,
                1e-15);
  }
} // namespace fidcd_test
