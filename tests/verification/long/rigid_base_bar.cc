#include "support/rigid_base_bar.h"

// The bar on a rigid base on the finest mesh of the references, and the whole bar refined as the
// shipped case suggests. Coarser meshes: verification/quick/rigid_base_bar_coarse.cc.

namespace rigid_base_bar
{
  using namespace akmon::test;

  TEST(RigidBaseBar, quarter_of_12288_cells)
  {
    const auto bar = run_bar_on_wall("rigid_base_bar", quarter_of_rigid_base_bar(2));
    expect_rigid_base_bar(bar, {0.5914, 0.2470, 0.418, 0.026});
  }


  TEST(RigidBaseBar, half_the_step)
  {
    auto overrides = quarter_of_rigid_base_bar(2);
    overrides.emplace_back("Time/Safety factor=0.45");
    const auto bar = run_bar_on_wall("rigid_base_bar", overrides);
    expect_rigid_base_bar(bar, {0.5914, 0.2470, 0.418, 0.026});
    EXPECT_LE(bar.max_energy_error, 1e-3);
  }


  TEST(RigidBaseBar, whole_bar_refined)
  {
    const RigidBaseReference references[] = {{0.5902, 0.2460, 0.360, 0.026},
                                             {0.5911, 0.2468, 0.393, 0.026},
                                             {0.5914, 0.2470, 0.418, 0.026}};
    for (const unsigned int refinement : {1, 2})
      {
        const auto bar = run_bar_on_wall("rigid_base_bar",
                                         {"Bodies/bar/Refinement=" + std::to_string(refinement)});
        expect_rigid_base_bar(bar, references[refinement]);
        EXPECT_LE(bar.momentum_error, 1e-12);
      }
  }
} // namespace rigid_base_bar
