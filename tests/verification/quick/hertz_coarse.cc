#include <gtest/gtest.h>

#include "support/hertz.h"

// Hertz press and impact on a coarse mesh, at three cells under the contact radius. Bounds are what
// this mesh allows; verification/long/hertz.cc converges to doc/verification.md, section 6b.

namespace hertz_coarse
{
  using namespace akmon::test;

  TEST(HertzCoarse, press)
  {
    const auto ratios = press(8, 0.15);
    EXPECT_NEAR(ratios.radius, 1., 0.005);
    EXPECT_NEAR(ratios.pressure, 1., 0.015);
    EXPECT_NEAR(ratios.force, 1., 0.05); // of a half space
  }


  TEST(HertzCoarse, impact)
  {
    const auto ratios = impact(8, 0.3);
    EXPECT_NEAR(ratios.force, 1.073, 0.05 * 1.073);
    EXPECT_NEAR(ratios.time, 0.953, 0.035 * 0.953);
    EXPECT_NEAR(ratios.radius, 1., 0.01);
    EXPECT_NEAR(ratios.pressure, 1., 0.01);
  }
} // namespace hertz_coarse
