#pragma once

#include <gtest/gtest.h>

#include "support/bar_on_wall.h"

namespace akmon::test
{
  // The copper Taylor bar at 80 microseconds on quarters of 288, 972 and 2400 cells, against an
  // independent hex code on meshes of that size, with the face sliding on the wall (glued) or free
  // to lift off (unilateral), with mean dilatation (does not lock) or full integration (does).

  struct TaylorMesh
  {
    unsigned int across, radial, axial, n_cells;
  };

  constexpr TaylorMesh taylor_288 = {4, 2, 24, 288}, taylor_972 = {6, 3, 36, 972},
                       taylor_2400 = {8, 4, 50, 2400};

  struct TaylorReference
  {
    double radius, length, plastic_strain; ///< mm, mm, 1
  };


  inline std::vector<std::string>
  glued_face()
  {
    return {"Prescribed motion/Names=symmetry, glue",
            "Prescribed motion/glue/Type=displacement",
            "Prescribed motion/glue/Surfaces=bar:bottom",
            "Prescribed motion/glue/Components=z"};
  }


  inline BarOnWall
  run_taylor_bar(const TaylorMesh &mesh, std::vector<std::string> overrides = {})
  {
    const std::string cylinder = "Bodies/bar/Cylinder/Cells ";
    overrides.push_back(cylinder + "across=" + std::to_string(mesh.across));
    overrides.push_back(cylinder + "radial=" + std::to_string(mesh.radial));
    overrides.push_back(cylinder + "axial=" + std::to_string(mesh.axial));
    const BarOnWall bar = run_bar_on_wall("taylor_bar_quarter", overrides);
    EXPECT_EQ(bar.n_cells, mesh.n_cells);
    return bar;
  }


  inline void
  expect_taylor_bar(const BarOnWall &bar, const TaylorReference &reference)
  {
    EXPECT_LE(bar.max_penetration, 1e-12);
    EXPECT_GE(bar.lowest, -1e-12);
    EXPECT_GE(bar.n_closed, bar.n_active);
    EXPECT_LE(bar.max_energy_error, 1e-3);
    EXPECT_NEAR(1e3 * bar.length, reference.length, 0.003 * reference.length);
    EXPECT_NEAR(1e3 * bar.radius, reference.radius, 0.015 * reference.radius);
    EXPECT_NEAR(bar.plastic_strain, reference.plastic_strain, 0.1 * reference.plastic_strain);
  }


  /// What is left after 80 microseconds; bars that lock bounce earlier.
  inline void
  expect_taylor_bar_at_rest(const BarOnWall &bar)
  {
    EXPECT_GE(bar.kinetic_left, 3e-4);
    EXPECT_LE(bar.kinetic_left, 6e-4);
  }


  inline void
  expect_rim_lifted(const BarOnWall &bar)
  {
    EXPECT_GT(bar.n_active, 0u);
    EXPECT_GE(bar.lift, 0.2e-3);
    EXPECT_LE(bar.lift, 0.3e-3);
  }
} // namespace akmon::test
