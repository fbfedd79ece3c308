#include <gtest/gtest.h>

#include "support/run_directory.h"

// Where the motion of two bodies is prescribed no contact force keeps them apart: that is told
// once, with both names and the step. It is not told where one of them can give way.

namespace driven_bodies
{
  using namespace akmon::test;

  const std::string driven = "driven into";

  // Of two bars that hit each other one has a face that moves on, and the other one, if both are
  // driven, one that stays.
  std::vector<std::string>
  bars(const bool both, const std::string &solver)
  {
    return {"Bodies/left/Box/Cells=20, 1, 1",
            "Bodies/right/Box/Cells=20, 1, 1",
            "Bodies/left/Velocity=0, 0, 0",
            "Bodies/right/Velocity=0, 0, 0",
            "Contact solver/Type=" + solver,
            "Prescribed motion/Names=pushed, held",
            "Prescribed motion/pushed/Surfaces=left:x+",
            "Prescribed motion/pushed/Type=velocity",
            "Prescribed motion/pushed/Function=202.2; 0; 0",
            "Prescribed motion/held/Type=displacement",
            std::string("Prescribed motion/held/Surfaces=") + (both ? "right:x-" : "right:x+")};
  }


  std::string
  output_of(const std::vector<std::string> &overrides)
  {
    const ScratchDirectory scratch;
    const auto result = run_program(arguments_for(shipped("two_bars"), scratch.path, overrides));
    EXPECT_EQ(result.status, 0) << result.output;
    const auto summary = file_content(scratch.path + "/summary.json");
    EXPECT_EQ(summary.find(driven) == std::string::npos,
              result.output.find(driven) == std::string::npos);
    return result.output;
  }


  void
  expect_told_once(const std::string &output, const std::string &bodies)
  {
    const auto first = output.find(driven);
    ASSERT_NE(first, std::string::npos) << output;
    EXPECT_EQ(output.find(driven, first + 1), std::string::npos) << output;
    const auto line = output.substr(output.rfind('\n', first) + 1);
    EXPECT_EQ(line.find("Warning: step 1"), 0u) << line; // the gap closes in step 136
    EXPECT_NE(line.find(bodies), std::string::npos) << line;
  }


  TEST(DrivenBodies, are_told_once_with_both_names)
  {
    for (const char *const solver : {"coupled", "decoupled"})
      expect_told_once(output_of(bars(true, solver)), "bodies 'left' and 'right' are driven into");
  }


  TEST(DrivenBodies, are_none_where_one_gives_way)
  {
    EXPECT_EQ(output_of(bars(false, "coupled")).find(driven), std::string::npos);
  }


  TEST(DrivenBodies, may_be_a_body_and_an_obstacle)
  {
    auto overrides = bars(true, "coupled");
    for (const char *const more : {"Contact/interface/Slave=left:x-",
                                   "Contact/interface/Master=right:x+",
                                   "Obstacles/Names=wall",
                                   "Obstacles/wall/Surfaces=left:x+",
                                   "Obstacles/wall/Point=0.01, 0, 0",
                                   "Obstacles/wall/Normal=-1, 0, 0"})
      overrides.emplace_back(more);
    expect_told_once(output_of(overrides), "body 'left' and obstacle 'wall' are driven into");
  }
} // namespace driven_bodies
