#include "support/rigid_base_bar.h"

// The bar on a rigid base on meshes small enough for every build; the finest mesh and the whole bar
// are in verification/long/rigid_base_bar.cc.

namespace rigid_base_bar_coarse
{
  using namespace akmon::test;

  TEST(RigidBaseBarCoarse, quarter_of_192_cells)
  {
    expect_rigid_base_bar(run_bar_on_wall("rigid_base_bar", quarter_of_rigid_base_bar(0)),
                          {0.5902, 0.2460, 0.360, 0.026});
  }


  TEST(RigidBaseBarCoarse, quarter_of_1536_cells)
  {
    expect_rigid_base_bar(run_bar_on_wall("rigid_base_bar", quarter_of_rigid_base_bar(1)),
                          {0.5911, 0.2468, 0.393, 0.026});
  }


  TEST(RigidBaseBarCoarse, full_integration)
  {
    const RigidBaseReference references[] = {{0.5899, 0.2437, 0.354, 0.026},
                                             {0.5910, 0.2455, 0.386, 0.026}};
    for (const unsigned int refinement : {0, 1})
      {
        auto overrides = quarter_of_rigid_base_bar(refinement);
        overrides.emplace_back("Bodies/bar/Integration=full");
        expect_rigid_base_bar(run_bar_on_wall("rigid_base_bar", overrides), references[refinement]);
      }
  }


  // The shipped bar has 17 cells along its length where the references have 16.
  TEST(RigidBaseBarCoarse, shipped_case)
  {
    const auto bar = run_bar_on_wall("rigid_base_bar", {});
    EXPECT_EQ(bar.n_cells, 816u);
    expect_rigid_base_bar(bar, {0.5902, 0.2460, 0.360, 0.026});
    EXPECT_LE(bar.momentum_error, 1e-12);
  }


  TEST(RigidBaseBarCoarse, quarter_is_a_quarter_of_the_whole)
  {
    const auto quarter = run_bar_on_wall("rigid_base_bar", quarter_of_rigid_base_bar(0));
    const auto whole   = run_bar_on_wall("rigid_base_bar", {"Bodies/bar/Cylinder/Cells axial=16"});
    EXPECT_EQ(whole.n_cells, 4 * quarter.n_cells);
    EXPECT_EQ(whole.n_steps, quarter.n_steps);
    EXPECT_NEAR(whole.length, quarter.length, 1e-10);
    EXPECT_NEAR(whole.radius, quarter.radius, 1e-10);
    EXPECT_NEAR(whole.plastic_strain, quarter.plastic_strain, 1e-9);
  }


  // A hit at 1000 m/s strains the first cells by 11 % in one step of the critical size: the energy
  // error is one of the step size, and of second order.
  TEST(RigidBaseBarCoarse, energy_error_vanishes_with_the_step)
  {
    std::vector<double> errors;
    for (const char *const factor : {"0.9", "0.45", "0.225"})
      {
        auto overrides = quarter_of_rigid_base_bar(0);
        overrides.push_back(std::string("Time/Safety factor=") + factor);
        errors.push_back(run_bar_on_wall("rigid_base_bar", overrides).max_energy_error);
      }
    EXPECT_LE(errors[1], errors[0] / 3.);
    EXPECT_LE(errors[2], errors[1] / 3.);
    EXPECT_LE(errors[1], 1e-3);
  }
} // namespace rigid_base_bar_coarse
