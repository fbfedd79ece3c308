#include <gtest/gtest.h>

#include <string>

#include "support/kept_run.h"
#include "support/report.h"

// An elastic die pressed into a slab and drawn over it, with friction and meshes that do not match:
// no exact solution, but no pair may be lost, the energies must add up and friction never gives.

namespace ironing
{
  using namespace akmon::test;

  class Ironing : public testing::TestWithParam<const char *>
  {
  };


  TEST_P(Ironing, runs_to_the_end_and_energies_add_up)
  {
    const std::string pass = GetParam();
    // The pressing and a third of the way.
    const Table history       = run_case(shipped("ironing"),
                                   {"Contact/press/Pass=" + pass, "Time/End=22"});
    const double penetration  = largest_of(history["max_penetration_rel"]),
                 energy_error = largest_of(history["energy_error"]),
                 work         = history["external_work"].back();
    report("penetration over h", penetration);
    report("energy error", energy_error);
    report("iterations, mean", mean_iterations(history));
    EXPECT_LE(mean_iterations(history), 30.);
    EXPECT_LE(energy_error, 0.01);
    EXPECT_LE(penetration, 1e-6);

    // Sticking pairs rest to the solver's tolerance.
    const auto &friction = history["friction_dissipation"];
    for (std::size_t i = 1; i < friction.size(); ++i)
      ASSERT_GE(friction[i] - friction[i - 1], -1e-9 * work) << i;
    EXPECT_GT(friction.back(), 0.1 * work);

    // Drawing takes friction, and little from the slab's slopes ahead and behind.
    const std::size_t last = history.n_rows() - 1;
    const double pull      = -history["press.force_x"][last] / history["press.force_z"][last];
    report("pull over pressing force", pull);
    EXPECT_NEAR(pull, 0.3, 0.03);
  }


  INSTANTIATE_TEST_SUITE_P(Pass,
                           Ironing,
                           testing::Values("symmetric", "single"),
                           [](const auto &info) { return std::string(info.param); });
} // namespace ironing
