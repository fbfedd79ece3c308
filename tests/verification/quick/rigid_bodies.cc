#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/run_case.h"

// Free rigid bodies among themselves: rolling and sliding cylinders, a box that falls.

namespace rigid_bodies
{
  using namespace akmon::test;

  constexpr double g = 9.81, pi = 3.14159265358979323846;
  const double across = g * std::cos(pi / 6.), along = g * std::sin(pi / 6.);


  TEST(RollingCylinder, RollsWithTwoThirds)
  {
    const Table history = run_case(shipped("rolling_cylinder"));
    for (std::size_t i = 0; i < history.n_rows(); ++i)
      {
        const double exact = 2. / 3. * along * history["time"][i];
        EXPECT_NEAR(history["cylinder.velocity_x"][i], exact, 1e-11);
        EXPECT_NEAR(0.5 * history["cylinder.spin_y"][i], exact, 1e-11);
        EXPECT_NEAR(history["cylinder.displacement_z"][i], 0., 1e-13);
        EXPECT_LT(std::abs(history["energy_error"][i]), 1e-12);
      }
    EXPECT_NEAR(history["slope.force_z"].back(), 500. * pi * across, 1e-3); // on the cylinder
  }


  // Below mu = tan/3 it slides: a = g (sin - mu cos), R alpha = 2 mu g cos.
  TEST(RollingCylinder, SlidesWithTooLittleFriction)
  {
    constexpr double mu = 0.1;
    const Table history = run_case(shipped("rolling_cylinder"),
                                   {"Obstacles/slope/Friction coefficient=0.1"});
    EXPECT_NEAR(history["cylinder.velocity_x"].back(), along - mu * across, 1e-8);
    EXPECT_NEAR(0.5 * history["cylinder.spin_y"].back(), 2. * mu * across, 1e-8);
    // What friction takes is its force times the slip.
    EXPECT_NEAR(history["friction_dissipation"].back(),
                500. * pi * mu * across * 0.5 * (along - 3. * mu * across),
                1e-3 * 500. * pi);
  }


  TEST(SpinningBox, EnergiesAddUp)
  {
    const Table history = run_case(shipped("spinning_box"));
    const auto in_air   = history.rows_between(0., 0.3);
    ASSERT_GT(in_air.size(), 10u);
    for (const std::size_t i : in_air)
      {
        EXPECT_NEAR(history["momentum_x"][i], 240., 1e-10);
        EXPECT_NEAR(history["momentum_z"][i], -480. * g * history["time"][i], 1e-9);
      }
    for (std::size_t i = 0; i < history.n_rows(); ++i)
      {
        EXPECT_LT(std::abs(history["energy_error"][i]), 1e-12);
        EXPECT_LT(history["max_penetration_rel"][i], 1e-9);
        EXPECT_NEAR(history["momentum_x"][i], 240., 1e-9); // no friction
      }
    // It rests on its face, its weight on the floor.
    EXPECT_NEAR(history["floor.force_z"].back(), 480. * g, 1e-3);
    EXPECT_NEAR(history["box.displacement_z"].back(), 0.5 - 1.5, 1e-9);
    EXPECT_NEAR(history["box.spin_x"].back(), 0., 1e-9);
  }


  // The largest indentation and force and the time of contact by Hertz, and the force over the
  // indentation on the way to it, with the shipped mesh and a coarser one.
  TEST(SphereOnSlab, FollowsHertz)
  {
    constexpr double d = 0.009982, T = 39.97, F = 4. / 3. / 0.91 * 9.9730e-4; // d^1.5
    double error_before = 1.;
    for (const auto &[cells, allowed] :
         {std::make_pair("10, 10, 10", 0.03), std::make_pair("16, 16, 16", 0.01)})
      {
        const Table history  = run_case(shipped("sphere_on_slab"),
                                       {std::string("Bodies/slab/Box/Cells=") + cells});
        const auto &time     = history["time"];
        const auto &force    = history["sphere.force_z"];
        const auto &place    = history["sphere.displacement_z"];
        const double deepest = -*std::min_element(place.begin(), place.end()),
                     highest = -4. * *std::min_element(force.begin(), force.end());
        const auto touches   = [](const double f) { return f != 0.; };
        const auto first     = std::find_if(force.begin(), force.end(), touches),
                   last      = std::find_if(force.rbegin(), force.rend(), touches).base() - 1;
        const double lasted  = time[last - force.begin()] - time[first - force.begin()];
        std::cout << "  " << cells << ": indentation " << deepest / d << ", force " << highest / F
                  << ", time " << lasted / T << " of Hertz, rebound "
                  << history["sphere.velocity_z"].back() / 7.35e-4 << std::endl;
        EXPECT_NEAR(deepest / d, 1., allowed);
        EXPECT_NEAR(highest / F, 1., allowed);
        EXPECT_NEAR(lasted / T, 1., allowed);
        EXPECT_LT(std::abs(deepest / d - 1.), error_before);
        error_before = std::abs(deepest / d - 1.);
        EXPECT_GT(history["sphere.velocity_z"].back() / 7.35e-4, 0.99);
        EXPECT_LT(history["sphere.velocity_z"].back() / 7.35e-4, 1.);
        EXPECT_EQ(force.back(), 0.);
      }
  }


  // A rigid mass M strikes a bar that is under pressure: both exact solutions add up until the wave
  // comes back from the base, 2 L/c after the impact (de Saint-Venant).
  TEST(PreloadImpact, StressesOfPreloadAndImpactAddUp)
  {
    constexpr double p = 0.01, v = 0.02, M = 4.;
    const Table history = run_case(shipped("preload_impact"));
    const auto &time    = history["time"];
    const auto settled  = history.rows_between(140., 165.); // damped until 150
    ASSERT_GT(settled.size(), 10u);
    for (const std::size_t i : settled)
      {
        EXPECT_NEAR(history["top.stress_zz"][i], -p, 1e-7 * p) << time[i];
        EXPECT_NEAR(history["middle.stress_zz"][i], -p, 1e-5 * p) << time[i];
      }
    const auto &force = history["hammer.force_z"];
    const auto first  = std::find_if(force.begin(), force.end(), [](double f) { return f != 0.; });
    ASSERT_NE(first, force.end());
    const double impact = time[first - force.begin()];
    EXPECT_NEAR(history["hammer.velocity_z"][first - force.begin() - 2], -v, 1e-5 * v);
    // The front is spread over some cells of 0.1: after it, and before it is back.
    for (const std::size_t i : history.rows_between(impact + 1.5, impact + 19.))
      {
        const double speed = v * std::exp(-(time[i] - impact) / M);
        EXPECT_NEAR(history["hammer.velocity_z"][i], -speed, 0.01 * v) << time[i];
        EXPECT_NEAR(history["top.stress_zz"][i], -p - speed, 0.03 * v) << time[i];
      }
    for (std::size_t i = 0; i < history.n_rows(); ++i)
      {
        EXPECT_LT(history["max_penetration_rel"][i], 1e-12);
        EXPECT_LT(std::abs(history["energy_error"][i]), 1e-3);
      }
  }
} // namespace rigid_bodies
