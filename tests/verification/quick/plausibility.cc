#include <gtest/gtest.h>

#include <fstream>

#include "support/run_directory.h"

// What looks like a mistake is told once at the start; the shipped cases have none.

namespace plausibility
{
  using namespace akmon::test;

  struct Oddity
  {
    std::string name, file;
    std::vector<std::string> overrides;
    std::string warning;
  };


  void
  PrintTo(const Oddity &oddity, std::ostream *out)
  {
    *out << oddity.name;
  }


  class Plausibility : public testing::TestWithParam<Oddity>
  {
  };


  TEST_P(Plausibility, is_doubted_in_one_line)
  {
    std::vector<std::string> arguments{"--validate", shipped(GetParam().file)};
    for (const auto &entry : GetParam().overrides)
      {
        arguments.emplace_back("--set");
        arguments.push_back(entry);
      }
    const auto result = run_program(arguments);
    EXPECT_EQ(result.status, 0) << result.output;
    EXPECT_NE(result.output.find("Warning: " + GetParam().warning), std::string::npos)
      << result.output;
    EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 2) << result.output;
  }


  INSTANTIATE_TEST_SUITE_P(
    Cases,
    Plausibility,
    testing::Values(Oddity{"modulus_in_gigapascal",
                           "taylor_bar_quarter",
                           {"Materials/copper/Young's modulus=117",
                            "Materials/copper/Yield stress=0.4",
                            "Materials/copper/Hardening modulus=0.1"},
                           "body 'bar' starts at "},
                    Oddity{"yield_stress_in_other_units",
                           "taylor_bar_quarter",
                           {"Materials/copper/Yield stress=400e9"},
                           "material 'copper' yields at "},
                    Oddity{"size_in_other_units",
                           "one_cell",
                           {"Bodies/cell/Box/Size=1e6, 1e6, 1e6",
                            "Bodies/cell/Spin=0,0,0",
                            "Probes/corner/Point=5e5,5e5,5e5"},
                           "body 'cell' of size 1.73e+06 is crossed by no wave"},
                    Oddity{"weight_in_other_units",
                           "sliding_block",
                           {"Body force/Acceleration=0; 0; -9.81e6"},
                           "body 'block' is strained by its own weight"},
                    Oddity{"too_far_apart",
                           "two_bars",
                           {"Bodies/left/Position=-500, 0, 0",
                            "Probes/left_face/Point=-495,0,0",
                            "Probes/left_middle/Point=-500,0,0",
                            "Probes/left_end/Point=-505,0,0"},
                           "contact 'interface' can never close: its surfaces are 495 apart"},
                    Oddity{"at_rest_alone",
                           "one_cell",
                           {"Bodies/cell/Velocity=0,0,0", "Bodies/cell/Spin=0,0,0"},
                           "body 'cell' never moves"},
                    Oddity{"falls",
                           "one_cell",
                           {"Body force/Acceleration=0; 0; -9.81"},
                           "body 'cell' falls for ever"},
                    Oddity{"yield_stress_of_an_elastic_law",
                           "taylor_bar_quarter",
                           {"Materials/copper/Law=hypoelastic",
                            "Materials/copper/Hardening modulus=0"},
                           "[Materials/copper] Yield stress = 400e6 has no effect: it needs "
                           "[Materials/copper] Law = j2"},
                    Oddity{"motion_of_a_fixed_tool",
                           "rounded_punch",
                           {"Obstacles/punch/Motion=fixed"},
                           "[Obstacles/punch/Prescribed] Displacement = "},
                    Oddity{"strength_of_what_only_touches",
                           "two_bars",
                           {"Contact/interface/Shear strength=1e6"},
                           "[Contact/interface] Shear strength = 1e6 has no effect"},
                    Oddity{"radius_of_a_box",
                           "one_cell",
                           {"Bodies/cell/Sphere/Radius=2"},
                           "[Bodies/cell/Sphere] Radius = 2 has no effect: it needs [Bodies/cell] "
                           "Shape = sphere"},
                    Oddity{"penalty_scale_of_exact_contact",
                           "two_bars",
                           {"Contact solver/Penalty scale=1"},
                           "[Contact solver] Penalty scale = 1 has no effect"},
                    // In Latin-1, which is no UTF-8.
                    Oddity{"penalty_scale_under_a_title_in_other_letters",
                           "two_bars",
                           {"Title=Sto\xdf", "Contact solver/Penalty scale=1"},
                           "[Contact solver] Penalty scale = 1 has no effect"},
                    Oddity{"probe_beside_the_body",
                           "two_bars",
                           {"Probes/left_face/Point=0.05, 0, 0"},
                           "probe 'left_face' lies outside body 'left'"}),
    [](const auto &info) { return info.param.name; });


  // A tool may push a body at rest against what is out of its own reach.
  TEST(Plausible, what_a_tool_pushes)
  {
    const ScratchDirectory scratch;
    const std::string file = scratch.path + "/pushed.prm";
    std::ofstream(file) << R"(
      subsection Time
        set End = 0.1
      end
      subsection Materials
        set Names = rubber
        subsection rubber
          set Density         = 1000
          set Young's modulus = 1e6
        end
      end
      subsection Bodies
        set Names = block
        subsection block
          set Material = rubber
        end
      end
      subsection Obstacles
        set Names = floor, ram
        subsection floor
          set Surfaces = block:z-
          set Point    = 0, 0, -0.51
        end
        subsection ram
          set Surfaces = block:z+
          set Shape    = box
          set Point    = 0, 0, 1.01
          set Motion   = prescribed
          subsection Prescribed
            set Velocity = 0; 0; -1
          end
        end
      end)";
    const auto pushed = run_program({"--validate", file});
    EXPECT_EQ(pushed.output, file + " is valid\n");
    const auto alone = run_program({"--validate", file, "--set", "Obstacles/ram/Motion=fixed"});
    EXPECT_NE(alone.output.find("obstacle 'floor' can never be touched"), std::string::npos)
      << alone.output;
  }


  TEST(ShippedCases, are_plausible)
  {
    unsigned int n = 0;
    for (const auto &entry :
         std::filesystem::directory_iterator(std::string(AKMON_SOURCE_DIR) + "/prm"))
      if (entry.path().extension() == ".prm")
        {
          const auto result = run_program({"--validate", entry.path().string()});
          EXPECT_EQ(result.status, 0) << result.output;
          EXPECT_EQ(result.output, entry.path().string() + " is valid\n");
          ++n;
        }
    EXPECT_GT(n, 10u);
  }
} // namespace plausibility
