#include <gtest/gtest.h>

#include <cmath>

#include "support/kept_run.h"
#include "support/report.h"

// Loads and starts that contact models use, against exact motions: a force history, gravity that
// damping lets settle, velocities by position; and free rigid bodies of several shapes.

namespace load_cases
{
  using namespace akmon::test;

  constexpr double pi = 3.14159265358979323846;

  const std::string sled_file = "Obstacles/sled/File/Name=" AKMON_SOURCE_DIR "/prm/meshes/sled.stl";


  // m v = int_t1 (2000 sin(pi t/2) - mu m g) dt from when the push exceeds friction; after t = 2
  // friction alone is left.
  TEST(PushedSled, follows_coulombs_law)
  {
    constexpr double m = 456., limit = 0.2 * m * 9.81, push = 2000.;
    const double t1     = 2. / pi * std::asin(limit / push);
    const Table history = run_case(shipped("pushed_sled"), {sled_file});
    double worst = 0., fastest = 0.;
    for (std::size_t i = 0; i < history.n_rows(); ++i)
      {
        const double t       = history["time"][i];
        const double impulse = push * 2. / pi *
                                 (std::cos(0.5 * pi * t1) - std::cos(0.5 * pi * std::min(t, 2.))) -
                               limit * (t - t1);
        const double exact = t < t1 ? 0. : std::max(0., impulse / m);
        worst              = std::max(worst, std::abs(history["sled.velocity_x"][i] - exact));
        fastest            = std::max(fastest, exact);
      }
    report("velocity off by, over the largest", worst / fastest);
    report("weight on the floor, off by",
           std::abs(history["floor.force_z"].back() / (m * 9.81) - 1.));
    report("energy error", largest_of(history["energy_error"]));
    EXPECT_LE(worst / fastest, 1e-6);
    EXPECT_NEAR(history["floor.force_z"].back() / (m * 9.81), 1., 1e-12); // mass from the surface
    EXPECT_LE(largest_of(history["energy_error"]), 1e-12);
  }


  // What is wrong with the sled's file is told, and mended.
  TEST(PushedSled, reports_what_was_repaired)
  {
    const ScratchDirectory scratch;
    const auto result = run_program({shipped("pushed_sled"),
                                     "--set",
                                     sled_file,
                                     "--set",
                                     "Time/End=0.01",
                                     "--set",
                                     "Output directory=" + scratch.path});
    EXPECT_EQ(result.status, 0);
    EXPECT_NE(result.output.find("1 triangle of zero area left out"), std::string::npos);
    EXPECT_NE(result.output.find("1 triangle whose normal pointed inward turned round"),
              std::string::npos);
  }


  TEST(SettledColumn, rests_under_its_weight_without_damping)
  {
    const Table history = run_case(shipped("settled_column"));
    for (const std::size_t i : history.rows_between(6.1, 10.))
      {
        EXPECT_NEAR(history["bottom.stress_zz"][i],
                    -10. * 3.875,
                    1e-6); // middle of the lowest cell
        EXPECT_NEAR(history["middle.stress_zz"][i], -10. * 2., 1e-6);
        EXPECT_NEAR(history["floor.force_z"][i], 40., 1e-6);
      }
    report("force on the floor over the weight", history["floor.force_z"].back() / 40.);
    report("energy error", largest_of(history["energy_error"]));
    EXPECT_LE(history["kinetic_energy"].back(), 1e-12 * history["strain_energy"].back());
    EXPECT_LE(largest_of(history["energy_error"]), 1e-6);
  }


  // u = v0/omega sin(omega t) at the end; the spin is on its own.
  TEST(RingingBar, swings_in_its_first_mode)
  {
    constexpr double v0 = 1e-4, omega = pi / 10.;
    const Table history = run_case(shipped("ringing_bar"));
    double worst        = 0.;
    for (std::size_t i = 0; i < history.n_rows(); ++i)
      worst = std::max(worst,
                       std::abs(history["end.displacement_x"][i] -
                                v0 / omega * std::sin(omega * history["time"][i])) /
                         (v0 / omega));
    report("displacement of the end off by, over the largest", worst);
    report("angular momentum off by, relative",
           change_of_momentum(history, "angular_momentum_") / history["angular_momentum_x"][0]);
    EXPECT_LE(worst, 2e-3);
    EXPECT_LE(change_of_momentum(history, "angular_momentum_"),
              1e-12 * history["angular_momentum_x"][0]);
    EXPECT_LE(largest_of(history["energy_error"]), 1e-4);
  }


  // Torus, sphere and mesh body, the last two hitting each other as well.
  TEST(ThrownRigids, keep_momenta_and_energy)
  {
    const Table history = run_case(shipped("thrown_rigids"), {sled_file});
    const double m_v    = 1111. * 3. / 10.; // of the torus alone, kg m/s
    report("change of momentum", change_of_momentum(history) / m_v);
    report("change of angular momentum", change_of_momentum(history, "angular_momentum_") / m_v);
    report("energy error", largest_of(history["energy_error"]));
    report("penetration over cell size", largest_of(history["max_penetration_rel"]));
    for (const char *const body : {"torus", "sphere", "sled"})
      EXPECT_GT(largest_of(history[std::string(body) + ".force_z"]), 100.) << body;
    EXPECT_LE(change_of_momentum(history) / m_v, 1e-12);
    EXPECT_LE(change_of_momentum(history, "angular_momentum_") / m_v, 1e-12);
    EXPECT_LE(largest_of(history["energy_error"]), 1e-5);
    EXPECT_LE(largest_of(history["max_penetration_rel"]), 1e-7);
    EXPECT_GT(history["friction_dissipation"].back(), 1.);
  }
} // namespace load_cases
