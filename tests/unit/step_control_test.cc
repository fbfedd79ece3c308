#include <akmon/time/step_control.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

// The choice of time steps.

namespace step_control_test
{
  using namespace akmon;

  // Steps end at the end, and none is much shorter than the one before.
  TEST(StepControl, LastStepsShareTheRest)
  {
    StepControl control;
    control.safety_factor = 1.;
    for (const double end : {2.3, 10., 517.07, 1000.0001})
      {
        control.end = end;
        double t = 0., before = 1.;
        unsigned int n = 0;
        for (; !control.finished(t); ++n)
          {
            const double step = control.choose(t, 4.); // critical: 1
            ASSERT_LE(step, 1.);
            EXPECT_GT(step, before * (1. - 1. / std::min(end, 99.)));
            t += before = step;
          }
        EXPECT_NEAR(t, end, 1e-11 * end);
        EXPECT_EQ(n, std::ceil(end));
      }
  }


  // A given step is kept to; what is left at the end is the last one.
  TEST(StepControl, FixedStepIsKept)
  {
    StepControl control;
    control.end        = 1.;
    control.fixed_step = 0.3;
    EXPECT_EQ(control.choose(0., 1e9), 0.3);
    EXPECT_EQ(control.choose(0.6, 1e9), 0.3);
    EXPECT_NEAR(control.choose(0.9, 1e9), 0.1, 1e-15);
  }
} // namespace step_control_test
