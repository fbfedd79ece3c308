#include <akmon/checkpoint/checkpoint.h>

#include <gtest/gtest.h>

#include <cmath>

#include "support/run_directory.h"

// The state on 1, 2, 3 and 4 ranks: the same hash with the decoupled solver; with the coupled one,
// which sums over ranks to decide when it is done, increments agree to 1e-12 of the largest.

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
                         {"Contact solver/Type=decoupled", "Output/Fields interval=0"});
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


  INSTANTIATE_TEST_SUITE_P(Shipped,
                           DecoupledState,
                           testing::Values(RankCase{"two_bars", {}},
                                           RankCase{"two_bars_rotated", {}},
                                           RankCase{"two_bars", {"Bodies/left/Box/Cells=20, 3, 3"}},
                                           RankCase{"taylor_bar_quarter", {"Time/End=1e-5"}},
                                           RankCase{"sliding_block", {"Time/End=0.1"}},
                                           RankCase{"two_spheres", {"Time/End=0.5"}}),
                           [](const auto &info) {
                             return std::to_string(info.index) + "_" + info.param.name;
                           });


  // Positions and both increments in a run's newest checkpoint.
  std::vector<double>
  state_in(const std::string &directory)
  {
    const akmon::CheckpointReader reader(directory + "/" + checkpoints_in(directory).back());
    std::vector<double> values;
    for (const char *const name : {"dx", "dx_next"})
      reader.rows(name, 0, reader.size(name).first, [&](const auto, const double *const row) {
        values.insert(values.end(), row, row + 3);
      });
    return values;
  }


  class CoupledState : public testing::TestWithParam<RankCase>
  {
  };


  TEST_P(CoupledState, agrees_to_round_off)
  {
    std::vector<double> one;
    for (const unsigned int n_ranks : {1u, 2u, 3u, 4u})
      {
        const ScratchDirectory scratch;
        auto overrides = GetParam().overrides;
        overrides.insert(overrides.end(),
                         {"Contact solver/Type=coupled", "Output/Fields interval=0"});
        const auto result = run_program(arguments_for(shipped(GetParam().name),
                                                      scratch.path,
                                                      overrides),
                                        n_ranks);
        ASSERT_EQ(result.status, 0) << result.output;
        const auto state = state_in(scratch.path);
        if (n_ranks == 1)
          one = state;
        ASSERT_EQ(state.size(), one.size());
        double largest = 0., difference = 0.;
        for (std::size_t i = 0; i < one.size(); ++i)
          {
            largest    = std::max(largest, std::abs(one[i]));
            difference = std::max(difference, std::abs(state[i] - one[i]));
          }
        RecordProperty(std::to_string(n_ranks) + "_ranks",
                       akmon::shortest_text(difference / largest));
        EXPECT_LE(difference, 1e-12 * largest) << n_ranks << " ranks";
      }
  }


  INSTANTIATE_TEST_SUITE_P(
    Shipped,
    CoupledState,
    testing::Values(RankCase{"two_bars",
                             {"Contact/interface/Pass=symmetric", "Checkpoint/Steps=90"}},
                    RankCase{"two_bars",
                             {"Contact/interface/Pass=symmetric",
                              "Bodies/left/Box/Cells=20, 3, 3",
                              "Checkpoint/Steps=90"}},
                    RankCase{"taylor_bar_quarter", {"Time/End=1e-5", "Checkpoint/Steps=80"}},
                    RankCase{"sliding_block", {"Time/End=0.1", "Checkpoint/Steps=450"}}),
    [](const auto &info) { return std::to_string(info.index) + "_" + info.param.name; });
} // namespace
