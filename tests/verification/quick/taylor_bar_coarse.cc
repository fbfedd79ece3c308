#include "support/taylor_bar.h"

// The copper Taylor bar on meshes small enough for every build; finer ones are in
// verification/long/taylor_bar.cc.

namespace taylor_bar_coarse
{
  using namespace akmon::test;

  TEST(TaylorBarCoarse, unilateral)
  {
    const auto bar = run_taylor_bar(taylor_972);
    expect_taylor_bar(bar, {7.240, 21.486, 3.28});
    expect_taylor_bar_at_rest(bar);
    expect_rim_lifted(bar);
  }


  TEST(TaylorBarCoarse, glued)
  {
    const auto bar = run_taylor_bar(taylor_972, glued_face());
    expect_taylor_bar(bar, {7.113, 21.439, 3.02});
    expect_taylor_bar_at_rest(bar);
    EXPECT_EQ(bar.lift, 0.);
  }


  // So coarse, the rim lifts by .15 mm only, and the glued bar keeps 6.1e-4 of its energy, whatever
  // the time step: both are outside of what is asked of finer meshes.
  TEST(TaylorBarCoarse, coarsest)
  {
    const auto bar = run_taylor_bar(taylor_288);
    expect_taylor_bar(bar, {7.149, 21.516, 3.07});
    expect_taylor_bar_at_rest(bar);
    EXPECT_GT(bar.lift, 0.);
    expect_taylor_bar(run_taylor_bar(taylor_288, glued_face()), {7.044, 21.471, 2.82});
  }


  // An independent one-point code with Flanagan-Belytschko stiffness on the same mesh.
  TEST(TaylorBarCoarse, one_point)
  {
    expect_taylor_bar(run_taylor_bar(taylor_288, {"Bodies/bar/Integration=one point"}),
                      {7.122, 21.518, 2.50});
  }


  TEST(TaylorBarCoarse, full_integration_locks)
  {
    expect_taylor_bar(run_taylor_bar(taylor_288, {"Bodies/bar/Integration=full"}),
                      {4.63, 20.26, 0.8});
  }
} // namespace taylor_bar_coarse
