#pragma once

#include <gtest/gtest.h>

#include "support/bar_on_wall.h"

namespace akmon::test
{
  // The bar of AIAA 2003-1599 section 9.2 at 264 microseconds, against independent codes with the
  // same stress update (an axisymmetric one, and hexes on quarters of 192, 1536 and 12288 cells).

  struct RigidBaseReference
  {
    double length, radius, plastic_strain, kinetic_left;
  };


  inline std::vector<std::string>
  quarter_of_rigid_base_bar(const unsigned int refinement)
  {
    return {"Bodies/bar/Cylinder/Sector=quarter",
            "Bodies/bar/Cylinder/Cells axial=16",
            "Bodies/bar/Refinement=" + std::to_string(refinement),
            "Prescribed motion/Names=symmetry",
            "Prescribed motion/symmetry/Surfaces=bar:x-, bar:y-"};
  }


  /// The base is never penetrated, and what it stops lies on it.
  inline void
  expect_gap_closed(const BarOnWall &bar)
  {
    EXPECT_LE(bar.max_penetration, 1e-12);
    EXPECT_GE(bar.lowest, -1e-12);
    EXPECT_GE(bar.n_closed, bar.n_active);
  }


  inline void
  expect_rigid_base_bar(const BarOnWall &bar, const RigidBaseReference &reference)
  {
    expect_gap_closed(bar);
    EXPECT_GT(bar.n_active, 0u);
    EXPECT_NEAR(bar.length, reference.length, 0.005 * reference.length);
    EXPECT_NEAR(bar.radius, reference.radius, 0.01 * reference.radius);
    EXPECT_NEAR(bar.plastic_strain, reference.plastic_strain, 0.03 * reference.plastic_strain);
    EXPECT_NEAR(bar.kinetic_left, reference.kinetic_left, 0.05 * reference.kinetic_left);

    // Known to 5 microseconds, resolved to a step.
    const double resolution = 5e-6 + 264e-6 / bar.n_steps;
    EXPECT_NEAR(bar.t_least_kinetic, 250e-6, resolution);
    EXPECT_NEAR(bar.t_least_length, 245e-6, resolution);
    EXPECT_NEAR(bar.least_length, 0.589, 0.005 * 0.589);
  }
} // namespace akmon::test
