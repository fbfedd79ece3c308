#include <gtest/gtest.h>

#include <cmath>

#include "support/kept_run.h"
#include "support/report.h"

// Newton's cradle of five elastic bars of the same acoustic length, with meshes that do not match:
// by one-dimensional waves the last one leaves with all momentum and the others stay at rest.

namespace newtons_cradle
{
  using namespace akmon::test;

  constexpr double v0 = 202.2, mass = 7.337e-4 * 10., length = 10., force = 14999.302;
  const double c = std::sqrt(3.0e7 / 7.337e-4), strike = 0.01 / v0, transit = length / c;


  // The force of an interface while the pulse stands in it: rho c v0 A/2.
  double
  mean_force(const Table &history, const std::string &contact, const double begin, const double end)
  {
    double sum      = 0.;
    const auto rows = history.rows_between(begin, end);
    for (const std::size_t i : rows)
      sum -= history[contact + ".force_x"][i] / rows.size();
    return sum;
  }


  // The impulse of an interface over the whole run, over the striking bar's momentum.
  double
  impulse(const Table &history, const std::string &contact)
  {
    double sum = 0.;
    for (std::size_t i = 1; i < history.n_rows(); ++i)
      sum -= history[contact + ".force_x"][i] * (history["time"][i] - history["time"][i - 1]);
    return sum / (mass * v0);
  }


  TEST(NewtonsCradle, last_bar_leaves_with_all_momentum)
  {
    const auto run      = run_and_keep(shipped("newtons_cradle"));
    const auto &history = run.history;
    const auto v        = velocities_of_bodies(*run.simulation);
    for (unsigned int body = 0; body < 5; ++body)
      report("velocity of bar " + std::to_string(body + 1) + " over v0", v[body][0] / v0);
    // The last layers of nodes of a bar of n cells have 1/(2 n) of its mass each; two meet.
    constexpr double layer = 1. / (2. * 40.), layers = 2. * layer;
    EXPECT_NEAR(v[4][0] / v0, 1., layer);
    for (unsigned int body = 0; body < 4; ++body)
      EXPECT_NEAR(v[body][0] / v0, 0., layers) << body + 1;

    const double momentum = change_of_momentum(history) / (mass * v0),
                 angular  = change_of_momentum(history, "angular_momentum_") / (mass * v0 * length),
                 penetration = largest_of(history["max_penetration_rel"]);
    report("change of momentum", momentum);
    report("change of angular momentum", angular);
    report("penetration over h", penetration);
    report("iterations, mean", mean_iterations(history));
    EXPECT_LE(momentum, 1e-12);
    EXPECT_LE(angular, 1e-12);
    EXPECT_LE(penetration, 1e-9);
    EXPECT_LE(mean_iterations(history), 30.);

    const char *const contacts[] = {"c12", "c23", "c34", "c45"};
    for (unsigned int i = 0; i < 4; ++i)
      {
        SCOPED_TRACE(contacts[i]);
        const double begin = strike + i * transit;
        const double F     = mean_force(history,
                                    contacts[i],
                                    begin + 0.3 * transit,
                                    begin + 1.7 * transit);
        report(std::string("force of ") + contacts[i] + " over the exact one", F / force);
        EXPECT_NEAR(F, force, 0.01 * force);
        EXPECT_NEAR(impulse(history, contacts[i]), 1., layer);
        // It opens when the tail has passed, and not again.
        for (const std::size_t row : history.rows_between(begin + 2.3 * transit, 1.))
          ASSERT_LE(std::abs(history[std::string(contacts[i]) + ".force_x"][row]), 1e-6 * force);
      }
  }
} // namespace newtons_cradle
