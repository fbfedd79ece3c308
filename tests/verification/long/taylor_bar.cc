#include "support/taylor_bar.h"

// The copper Taylor bar on the finest mesh of the references, and one finer still against
// published results. Coarser meshes: verification/quick/taylor_bar_coarse.cc.

namespace taylor_bar
{
  using namespace akmon::test;

  TEST(TaylorBar, unilateral)
  {
    const auto bar = run_taylor_bar(taylor_2400);
    expect_taylor_bar(bar, {7.292, 21.473, 3.50});
    expect_taylor_bar_at_rest(bar);
    expect_rim_lifted(bar);
  }


  TEST(TaylorBar, glued)
  {
    const auto bar = run_taylor_bar(taylor_2400, glued_face());
    expect_taylor_bar(bar, {7.155, 21.425, 3.12});
    expect_taylor_bar_at_rest(bar);
    EXPECT_EQ(bar.lift, 0.);
  }


  // The limit of a fine axisymmetric mesh; published: R = 7.22 (Foulk et al. 2021), 7.2259 and
  // L = 21.430 (Carina, extrapolated).
  TEST(TaylorBar, glued_fine)
  {
    const auto bar = run_taylor_bar({12, 6, 72, 7776}, glued_face());
    expect_taylor_bar(bar, {7.227, 21.401, 3.29});
    expect_taylor_bar_at_rest(bar);
  }


  TEST(TaylorBar, full_integration_locks)
  {
    const TaylorReference references[] = {{4.83, 20.22, 0.9}, {5.46, 20.55, 1.4}};
    for (const unsigned int i : {0, 1})
      expect_taylor_bar(run_taylor_bar(i == 0 ? taylor_972 : taylor_2400,
                                       {"Bodies/bar/Integration=full"}),
                        references[i]);
  }


  // The shipped bar is whole: the two planes of symmetry must not matter.
  TEST(TaylorBar, whole_bar)
  {
    const auto bar = run_bar_on_wall("taylor_bar", {});
    EXPECT_EQ(bar.n_cells, 4u * taylor_972.n_cells);
    expect_taylor_bar(bar, {7.240, 21.486, 3.28});
    expect_taylor_bar_at_rest(bar);
    expect_rim_lifted(bar);
    EXPECT_LE(bar.momentum_error, 1e-12);
  }
} // namespace taylor_bar
