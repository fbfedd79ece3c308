#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/kept_run.h"
#include "support/report.h"
#include "support/run_case.h"

// All surfaces in one contact, no pairs listed: a tower that settles under gravity, a ring that
// is crushed until it touches itself, soft spheres poured into a box (fewer than in the shipped
// case). Run to the end on the default parameters.

namespace many_contacts
{
  using namespace akmon::test;

  // At every step.
  Table
  run_and_check(const std::string &name, std::vector<std::string> changes = {})
  {
    changes.emplace_back("Output/History steps=1");
    const Table history = run_case(shipped(name), changes);
    report("penetration over h", largest_of(history["max_penetration_rel"]));
    report("energy error", largest_of(history["energy_error"]));
    report("iterations, mean", mean_iterations(history));
    EXPECT_LE(largest_of(history["max_penetration_rel"]), 1e-6);
    EXPECT_LE(largest_of(history["energy_error"]), 1e-3);
    EXPECT_LE(mean_iterations(history), 30.);
    const double rounding = 1e-15 * std::abs(history["external_work"].back());
    for (const double dissipated : history["friction_dissipation"])
      EXPECT_GE(dissipated, -rounding);
    return history;
  }


  TEST(BlockTower, stands_on_the_ground_with_its_weight)
  {
    const Table history    = run_and_check("block_tower");
    constexpr double force = 98100.; // ten blocks of 1000, g = 9.81
    EXPECT_NEAR(history["ground.force_z"].back(), force, 1e-6 * force);
    EXPECT_LE(history["kinetic_energy"].back(), 1e-12 * history["strain_energy"].back());
    const auto &friction = history["friction_dissipation"];
    for (std::size_t i = 1; i < friction.size(); ++i)
      EXPECT_GE(friction[i] - friction[i - 1], -1e-9 * std::abs(history["external_work"].back()));
  }


  TEST(CrushedRing, yields_and_keeps_its_surfaces_apart)
  {
    const Table history = run_and_check("crushed_ring");
    EXPECT_GE(history["plastic_dissipation"].back(), 0.5 * history["external_work"].back());
  }


  TEST(PouredSpheres, pile_up_in_the_box)
  {
    const Table history = run_and_check("poured_spheres",
                                        {"Bodies/ball/Copies/Count=3, 3, 3",
                                         "Bodies/ball/Position=-0.023, -0.023, 0.013",
                                         "Obstacles/left/Point=-0.036, 0, 0",
                                         "Obstacles/right/Point=0.036, 0, 0",
                                         "Obstacles/front/Point=0, -0.036, 0",
                                         "Obstacles/back/Point=0, 0.036, 0",
                                         "Time/End=0.3"});
    const auto &weight  = history["floor.force_z"];
    EXPECT_GT(weight.back(), 0.);
    EXPECT_GE(history["friction_dissipation"].back(), 0.01 * history["external_work"].back());
  }
} // namespace many_contacts
