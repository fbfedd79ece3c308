#include "support/hertz.h"

#include <gtest/gtest.h>

#include <cmath>

// Hertz press and impact on three meshes of a quarter of a sphere, graded towards the contact:
// force, contact radius, largest pressure and contact time of doc/verification.md, section 6b,
// within 2 % on the finest, converging.

namespace hertz
{
  using namespace akmon::test;

  TEST(Hertz, press)
  {
    double change = 1., last = 0.;
    for (const unsigned int n : {8, 12, 16})
      {
        const auto ratios = press(n, 0.15);
        EXPECT_NEAR(ratios.radius, 1., 0.005) << n;
        EXPECT_NEAR(ratios.pressure, 1., 0.01) << n;
        if (last > 0.)
          {
            // No exact value: the sphere is none half space, and held at its upper half.
            EXPECT_LT(std::abs(ratios.force - last), change) << n;
            change = std::abs(ratios.force - last);
          }
        last = ratios.force;
      }
    EXPECT_LE(change, 0.005);
    EXPECT_NEAR(last, 1., 0.05);
  }


  TEST(Hertz, impact)
  {
    constexpr double force = 1.073, time = 0.953, restitution = .9984;
    HertzRatios last{};
    double force_error = 1., time_error = 1.;
    for (const unsigned int n : {8, 12, 16})
      {
        last = impact(n, 0.3);
        EXPECT_LT(std::abs(last.force / force - 1.), force_error) << n;
        EXPECT_LT(std::abs(last.time / time - 1.), time_error) << n;
        force_error = std::abs(last.force / force - 1.);
        time_error  = std::abs(last.time / time - 1.);
      }
    EXPECT_LE(force_error, 0.02);
    EXPECT_LE(time_error, 0.02);
    EXPECT_NEAR(last.radius, 1., 0.02);
    EXPECT_NEAR(last.pressure, 1., 0.02);
    EXPECT_NEAR(last.restitution, restitution, 0.02);
  }
} // namespace hertz
