#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "support/run_case.h"

// A run that must not go on says so in one line, leaves its last state to look at, and fails.

using namespace akmon::test;

namespace
{
  std::string
  content(const std::string &path)
  {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }


  void
  expect_stop(const std::vector<std::string> &overrides,
              const std::string &reason,
              const int status)
  {
    const ScratchDirectory scratch;
    std::vector<std::string> arguments = {shipped("two_bars"),
                                          "--set",
                                          "Output directory=" + scratch.path,
                                          "--set",
                                          "Output/Fields interval=0"};
    for (const auto &entry : overrides)
      {
        arguments.emplace_back("--set");
        arguments.push_back(entry);
      }
    const auto result = run_program(arguments);
    EXPECT_EQ(result.status, status);
    EXPECT_NE(result.output.find("akmon: error: "), std::string::npos) << result.output;
    EXPECT_NE(result.output.find(reason), std::string::npos) << result.output;
    EXPECT_NE(result.output.find("step "), std::string::npos);
    // The initial state and the one at which it stopped.
    EXPECT_TRUE(std::filesystem::exists(scratch.path + "/fields_00000.vtu"));
    EXPECT_TRUE(std::filesystem::exists(scratch.path + "/fields_00001.vtu"));
    EXPECT_NE(content(scratch.path + "/summary.json").find("\"completed\": false"),
              std::string::npos);
  }


  TEST(Run, stops_on_an_energy_error_beyond_the_bound)
  {
    expect_stop({"Output/Energy error bound=1e-9"}, "energy error", 4);
  }


  TEST(Run, stops_on_inverted_cells)
  {
    expect_stop({"Time/Step=4e-6", "Output/Energy error bound=1e300"},
                "is inverted or not a number",
                2);
  }


  TEST(Run, warns_of_a_step_above_the_critical_one)
  {
    const ScratchDirectory scratch;
    const auto result = run_program({shipped("two_bars"),
                                     "--set",
                                     "Output directory=" + scratch.path,
                                     "--set",
                                     "Time/Step=4e-6"});
    EXPECT_NE(result.output.find("above the critical step"), std::string::npos) << result.output;
  }
} // namespace
