#include <gtest/gtest.h>

#include "support/rank_case.h"

// The state on 1, 2, 3 and 4 ranks has the same hash with the decoupled solver.

namespace rank_states
{
  using namespace akmon::test;

  class DecoupledState : public testing::TestWithParam<RankCase>
  {
  };


  TEST_P(DecoupledState, has_one_hash_on_any_number_of_ranks)
  {
    expect_one_hash(GetParam(),
                    4,
                    {"Contact solver/Type=decoupled",
                     "Output/Fields interval=0",
                     "Output/History steps=0"},
                    [](const std::string &) {});
  }


  INSTANTIATE_TEST_SUITE_P(
    Shipped,
    DecoupledState,
    testing::Values(RankCase{"two_bars", {"Time/End=1e-4"}},
                    RankCase{"two_bars_rotated", {"Time/End=1e-4"}},
                    RankCase{"two_bars", {"Time/End=1e-4", "Bodies/left/Box/Cells=20, 3, 3"}},
                    RankCase{"taylor_bar_quarter", {"Time/End=5e-6"}},
                    RankCase{"sliding_block", {"Time/End=0.1"}},
                    RankCase{"two_spheres", {"Time/End=0.5"}}),
    [](const auto &info) { return std::to_string(info.index) + "_" + info.param.name; });
} // namespace rank_states
