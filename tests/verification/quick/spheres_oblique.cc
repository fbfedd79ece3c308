#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/kept_run.h"
#include "support/report.h"
#include "support/run_case.h"

// Two elastic spheres collide obliquely with friction: momentum and angular momentum to round-off,
// friction never gives. Rebound laws on finer meshes: verification/long/two_spheres.cc.

namespace spheres_oblique
{
  using namespace akmon::test;

  TEST(SpheresOblique, keep_momenta_and_lose_energy_by_friction)
  {
    constexpr double v = 0.01, v_t = 0.005, mu = 0.3;
    const auto run       = run_and_keep(shipped("two_spheres_oblique"));
    const auto &history  = run.history;
    const double mass    = history["kinetic_energy"][0] / (v * v + v_t * v_t); // of one sphere
    const double linear  = change_of_momentum(history) / (mass * v),
                 angular = change_of_momentum(history, "angular_momentum_") / (mass * v),
                 energy  = history["kinetic_energy"][0];
    report("change of momentum", linear);
    report("change of angular momentum", angular);
    report("penetration over h", largest_of(history["max_penetration_rel"]));
    report("energy error", largest_of(history["energy_error"]));
    report("iterations, mean", mean_iterations(history));
    EXPECT_LE(linear, 1e-12);
    EXPECT_LE(angular, 1e-12);
    EXPECT_LE(largest_of(history["max_penetration_rel"]), 1e-6);
    EXPECT_LE(largest_of(history["energy_error"]), 1e-3);
    EXPECT_LE(mean_iterations(history), 30.);

    const auto &friction = history["friction_dissipation"];
    double least         = 0.;
    for (std::size_t i = 1; i < friction.size(); ++i)
      least = std::min(least, (friction[i] - friction[i - 1]) / energy);
    report("least friction dissipation of a step over the energy", least);
    EXPECT_GE(least, -1e-12);
    EXPECT_GT(friction.back(), 0.01 * energy);

    // No more than full slip takes, v_t' = v_t - mu (v_n + v_n').
    const auto velocity = velocities_of_bodies(*run.simulation);
    report("tangential velocity after, over before", velocity[0][1] / v_t);
    report("normal velocity after, over before", -velocity[0][0] / v);
    EXPECT_NEAR((velocity[0] + velocity[1]).norm(), 0., 1e-12 * v);
    EXPECT_LT(velocity[0][1], v_t);
    EXPECT_GE(velocity[0][1], v_t - mu * (v - velocity[0][0]));
  }


  // Maw, Barber and Fawcett (Wear 38, 1976): at psi = 2 part of the contact slips, J_t/(mu J_n) =
  // .4922; waves and the mesh add to it.
  TEST(SpheresOblique, partial_slip_approaches_maw_barber_and_fawcett)
  {
    constexpr double mu = 0.3, reference = 0.4922;
    const auto off_by = [](const unsigned int n) {
      std::vector<std::string> overrides;
      for (const std::string body : {"upper", "lower"})
        {
          overrides.push_back("Bodies/" + body + "/Sphere/Cells across=" + std::to_string(n));
          overrides.push_back("Bodies/" + body + "/Sphere/Cells radial=" + std::to_string(n / 2));
        }
      const Table history = run_case(shipped("oblique_spheres"), overrides);
      EXPECT_LE(largest_of(history["energy_error"]), 1e-3);
      double J_n = 0., J_t = 0.;
      for (std::size_t i = 1; i < history.n_rows(); ++i)
        {
          const double dt = history["time"][i] - history["time"][i - 1];
          J_n += history["touch.force_z"][i] * dt;
          J_t += history["touch.force_y"][i] * dt;
        }
      const double ratio = std::abs(J_t) / (mu * std::abs(J_n));
      report("J_t/(mu J_n), " + std::to_string(n) + " cells across", ratio);
      return ratio - reference;
    };
    const double coarse = off_by(8), fine = off_by(12);
    EXPECT_LE(fine, 0.75 * coarse);
    EXPECT_LE(std::abs(fine), 0.1 * reference);
  }
} // namespace spheres_oblique
