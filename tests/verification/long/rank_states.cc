#include <gtest/gtest.h>

#include "support/run_directory.h"

// The state on 1, 2, 3 and 4 ranks has the same hash with the decoupled solver.

using namespace akmon::test;

namespace
{
  struct RankCase
  {
    std::string name;
    std::vector<std::string> overrides;
  };


  void
  PrintTo(const RankCase &rank_case, std::ostream *out)
  {
    *out << rank_case.name;
  }


  class DecoupledState : public testing::TestWithParam<RankCase>
  {
  };


  TEST_P(DecoupledState, has_one_hash_on_any_number_of_ranks)
  {
    std::string hash;
    for (const unsigned int n_ranks : {1u, 2u, 3u, 4u})
      {
        const ScratchDirectory scratch;
        auto overrides = GetParam().overrides;
        overrides.insert(overrides.end(),
                         {"Contact solver/Type=decoupled",
                          "Output/Fields interval=0",
                          "Output/History steps=0"});
        const auto result = run_program(arguments_for(shipped(GetParam().name),
                                                      scratch.path,
                                                      overrides),
                                        n_ranks);
        ASSERT_EQ(result.status, 0) << result.output;
        if (n_ranks == 1)
          hash = summary_value(scratch.path, "state_hash");
        EXPECT_EQ(summary_value(scratch.path, "state_hash"), hash) << n_ranks << " ranks";
      }
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
} // namespace
