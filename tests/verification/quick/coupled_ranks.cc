#include <gtest/gtest.h>

#include "support/rank_case.h"

// The state on 1, 2 and 3 ranks has the same hash with the coupled solver too, wherever the ranks
// cut the bodies and their interfaces.

namespace coupled_ranks
{
  using namespace akmon::test;

  class CoupledState : public testing::TestWithParam<RankCase>
  {
  };


  TEST_P(CoupledState, has_one_hash_on_any_number_of_ranks)
  {
    expect_one_hash(GetParam(),
                    3,
                    {"Contact solver/Type=coupled",
                     "Output/Fields interval=0",
                     "Output/History steps=1"},
                    [](const std::string &directory) {
                      const auto n_active = Table(directory + "/history.csv")["active_pairs"];
                      EXPECT_GT(*std::max_element(n_active.begin(), n_active.end()), 0.);
                    });
  }


  const std::vector<std::string> unlike_bars = {"Time/End=6e-5", // impact at 5e-5
                                                "Time/Step=5e-7",
                                                "Contact/interface/Pass=symmetric",
                                                "Bodies/left/Box/Cells=10, 7, 7",
                                                "Bodies/right/Box/Cells=10, 5, 5"};


  std::vector<std::string>
  with(std::vector<std::string> overrides, const std::vector<std::string> &others)
  {
    overrides.insert(overrides.end(), others.begin(), others.end());
    return overrides;
  }


  INSTANTIATE_TEST_SUITE_P(
    Shipped,
    CoupledState,
    testing::Values(RankCase{"two_bars", unlike_bars},
                    // They slide across each other and stick in parts.
                    RankCase{"two_bars",
                             with(unlike_bars,
                                  {"Contact/interface/Friction coefficient=0.3",
                                   "Bodies/left/Velocity=202.2, 30, 10",
                                   "Bodies/right/Spin=0, 0, 20"})},
                    RankCase{"two_spheres_oblique", {"Time/End=2"}},
                    RankCase{"ironing", {"Time/End=1.5"}},
                    // A free rigid body, whose forces come from all ranks.
                    RankCase{"sphere_on_slab", {"Time/End=2", "Bodies/slab/Box/Cells=6, 6, 6"}},
                    RankCase{"block_tower", {"Time/End=0.01"}}),
    [](const auto &info) { return std::to_string(info.index) + "_" + info.param.name; });
} // namespace coupled_ranks
