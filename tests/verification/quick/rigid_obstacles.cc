#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "support/run_case.h"
#include "support/triangles.h"

// Rigid obstacles and tools: nodes stay out of them, rigid bodies move as mechanics says, and
// energies add up. A soft slab 1 x 1 x 1/2 with its top at z = 0 is what they hit.

namespace rigid_obstacles
{
  using namespace akmon::test;

  constexpr double pi = 3.14159265358979323846, g = 9.81;

  const std::string slab = "subsection Time\n set End = 0.05\n set Step = 1e-4\nend\n"
                           "subsection Materials\n set Names = soft\n subsection soft\n"
                           "  set Density = 1000\n  set Young's modulus = 1e6\n"
                           "  set Poisson's ratio = 0.3\n end\nend\n"
                           "subsection Bodies\n set Names = slab\n subsection slab\n"
                           "  set Material = soft\n  set Shape = box\n"
                           "  set Position = 0, 0, -0.25\n  subsection Box\n"
                           "   set Size = 1, 1, 0.5\n   set Cells = 8, 8, 4\n  end\n end\nend\n";
  const std::string held = "subsection Prescribed motion\n set Names = base\n subsection base\n"
                           "  set Type = displacement\n  set Surfaces = slab:z-\n end\nend\n";
  const std::string every_step = "subsection Output\n set History steps = 1\nend\n";


  std::string
  tool(const std::string &keys)
  {
    return "subsection Obstacles\n set Names = tool\n subsection tool\n"
           "  set Surfaces = slab:z+\n" +
           keys + " end\nend\n";
  }


  Table
  run(const std::string &text, const std::vector<std::string> &overrides = {})
  {
    const ScratchDirectory scratch;
    const std::string file = scratch.path + "/case.prm";
    std::ofstream(file) << text;
    return run_case(file, overrides);
  }


  double
  largest(const std::vector<double> &values)
  {
    double result = 0.;
    for (const double value : values)
      result = std::max(result, std::abs(value));
    return result;
  }


  struct Shape
  {
    std::string name, keys;
  };

  class ShapedTool : public ::testing::TestWithParam<Shape>
  {
  };


  // Pressed in by a tenth of the slab and lifted, with friction, turning: round-off, in both
  // solvers, and the work done is what the energies take.
  TEST_P(ShapedTool, NodesStayOutside)
  {
    for (const char *const solver : {"coupled", "decoupled"})
      {
        const Table
          history = run(slab + held +
                          tool(GetParam().keys +
                               "  set Motion = prescribed\n  set Friction coefficient = 0.3\n"
                               "  subsection Prescribed\n"
                               "   set Displacement = 0.02*t; 0; -0.05*sin(pi*t/0.05)^2\n"
                               "   set Spin = 0; 0; 5\n  end\n") +
                          every_step,
                        {std::string("Contact solver/Type=") + solver});
        std::cout << "  " << GetParam().name << " " << solver << ": penetration "
                  << largest(history["max_penetration_rel"]) << ", energy error "
                  << largest(history["energy_error"]) << ", force "
                  << largest(history["tool.force_z"]) << std::endl;
        EXPECT_GT(largest(history["active_pairs"]), 4.);
        EXPECT_LT(largest(history["max_penetration_rel"]), 1e-14);
        EXPECT_LT(largest(history["energy_error"]), 1e-4);
        EXPECT_NEAR(history["tool.displacement_z"][250], -0.05, 1e-12);
        EXPECT_NEAR(history["tool.spin_z"][250], 5., 1e-5);
      }
  }

  INSTANTIATE_TEST_SUITE_P(
    Shapes,
    ShapedTool,
    ::testing::Values(Shape{"sphere",
                            "  set Shape = sphere\n  set Point = 0, 0, 0.501\n"
                            "  subsection Sphere\n   set Radius = 0.5\n  end\n"},
                      Shape{"lying cylinder",
                            "  set Shape = cylinder\n  set Point = 0, 0, 0.301\n"
                            "  set Normal = 1, 0.2, 0\n"
                            "  subsection Cylinder\n   set Radius = 0.3\n  end\n"},
                      Shape{"rounded punch",
                            "  set Shape = cylinder\n  set Point = 0, 0, 0.101\n"
                            "  subsection Cylinder\n   set Radius = 0.3\n"
                            "   set Length = 0.2\n   set Edge radius = 0.05\n  end\n"},
                      Shape{"rounded box",
                            "  set Shape = box\n  set Point = 0, 0, 0.101\n  set Twist = 20\n"
                            "  subsection Box\n   set Size = 0.6, 0.5, 0.2\n"
                            "   set Edge radius = 0.04\n  end\n"},
                      Shape{"torus",
                            "  set Shape = torus\n  set Point = 0, 0, 0.151\n"
                            "  subsection Torus\n   set Radius = 0.3\n   set Tube radius = 0.15\n"
                            "  end\n"}),
    [](const auto &info) {
      std::string name = info.param.name;
      std::replace(name.begin(), name.end(), ' ', '_');
      return name;
    });


  // A free ball falls on the slab: momentum, energy and one path for any number of ranks.
  TEST(FreeBall, FallsOnASlab)
  {
    const ScratchDirectory scratch;
    const std::string file = scratch.path + "/case.prm";
    std::ofstream(file) << slab
                        << tool("  set Shape = sphere\n  set Point = 0.05, 0.02, 0.501\n"
                                "  set Friction coefficient = 0.2\n  set Motion = free\n"
                                "  subsection Sphere\n   set Radius = 0.5\n  end\n"
                                "  subsection Free\n   set Density = 500\n"
                                "   set Velocity = 0.3, 0, -1\n   set Spin = 1, 2, 3\n"
                                "  end\n")
                        << every_step;
    const Table history = run_case(file);
    EXPECT_LT(largest(history["max_penetration_rel"]), 1e-10);
    EXPECT_LT(largest(history["energy_error"]), 1e-5);
    EXPECT_GT(history["impact_dissipation"].back(), 0.);
    for (const char *const column : {"momentum_", "angular_momentum_"})
      for (const char *const axis : {"x", "y", "z"})
        {
          const auto &values = history[std::string(column) + axis];
          for (const double value : values)
            EXPECT_NEAR(value, values[0], 1e-10 * 261.8);
        }
    const Table on_three = run_case_on_ranks(file, 3, {"Output/Fields interval=0"});
    ASSERT_EQ(on_three.n_rows(), history.n_rows());
    for (std::size_t i = 0; i < history.n_rows(); ++i)
      {
        EXPECT_NEAR(on_three["tool.velocity_z"][i], history["tool.velocity_z"][i], 1e-12);
        EXPECT_NEAR(on_three["tool.spin_x"][i], history["tool.spin_x"][i], 1e-11);
      }
  }


  // A force history pushes a guided tool: v = int F dt / m, along the guide only.
  TEST(FreeTool, ForceHistory)
  {
    const Table history = run(
      slab +
      tool("  set Shape = box\n  set Point = 0, 0, 5\n  set Motion = free\n"
           "  subsection Free\n   set Mass = 4\n   set Inertia = 1, 1, 1\n"
           "   set Force = 7; 0; -200*sin(pi*t/0.05)\n   set Moment = 0; 0; 0.3\n"
           "   set Translations = z\n   set Rotations = z\n  end\n") +
      every_step);
    // The impulse of the trapezoidal rule with n = 500 steps, T cot(pi/(2 n))/n per unit force.
    EXPECT_NEAR(history["tool.velocity_z"].back(),
                -200. * 0.05 / 500. / std::tan(pi / 1000.) / 4.,
                1e-11);
    EXPECT_EQ(history["tool.velocity_x"].back(), 0.);
    EXPECT_NEAR(history["tool.spin_z"].back(), 0.3 * 0.05, 1e-12);
  }


  // A box as a surface of triangles, from a file with one normal the wrong way round. Nodes stay
  // out of it by rounding; its corners and edges, which the coupled solver sees too, out of faces
  // by its tolerance.
  TEST(MeshedTool, StaysOutside)
  {
    const ScratchDirectory scratch;
    auto box = triangle_box(Vector({0.6, 0.55, 0.2}));
    std::swap(box.triangles[3][0], box.triangles[3][1]);
    std::ofstream(scratch.path + "/box.stl") << ascii_stl(box);
    const std::string path = "  set Motion = prescribed\n  subsection Prescribed\n"
                             "   set Displacement = 0; 0; -0.05*sin(pi*t/0.05)^2\n"
                             "   set Rotation = 200*t; 0; 0\n  end\n"
                             "  set Point = 0.01, 0.02, 0.101\n";
    const std::string file = "  set Shape = file\n  subsection File\n   set Name = " +
                             scratch.path + "/box.stl\n  end\n",
                      shape = "  set Shape = box\n  subsection Box\n"
                              "   set Size = 0.6, 0.55, 0.2\n  end\n";
    for (const std::string solver : {"decoupled", "coupled"})
      {
        const std::vector<std::string> overrides{"Contact solver/Type=" + solver};
        const Table meshed = run(slab + held + tool(path + file) + every_step, overrides),
                    exact  = run(slab + held + tool(path + shape) + every_step, overrides);
        const auto &depths = meshed["max_penetration_rel"];
        std::cout << "  " << solver << ": penetration " << largest(depths) << std::endl;
        EXPECT_LT(largest(depths), solver == "coupled" ? 1e-7 : 1e-14);
        // A node that comes to lie on a sharp edge may be on either side of it.
        EXPECT_LE(std::count_if(depths.begin(),
                                depths.end(),
                                [](const double depth) { return depth > 2e-9; }),
                  5);
        // Later nodes come to lie on sharp edges, whose normal rounding decides. What the tolerance
        // of gaps leaves of a step's force is a millionth of the largest one, if not in the sum.
        const std::string column = solver == "coupled" ? "momentum_z" : "tool.force_z";
        const double tolerance   = solver == "coupled" ? 1e-6 : 1e-8;
        for (const std::size_t i : exact.rows_between(0., 0.0135))
          EXPECT_NEAR(meshed[column][i], exact[column][i], tolerance * largest(exact[column]))
            << exact["time"][i];
      }
  }


  // One clear line, and status 1.
  TEST(MeshedTool, HolesAreRefused)
  {
    const ScratchDirectory scratch;
    auto box = triangle_box(Vector({0.5, 0.5, 0.2}));
    box.triangles.pop_back();
    std::ofstream(scratch.path + "/open.stl") << binary_stl(box);
    const std::string file = scratch.path + "/case.prm";
    std::ofstream(file) << slab
                        << tool("  set Shape = file\n  subsection File\n   set Name = " +
                                scratch.path + "/open.stl\n  end\n");
    const auto result = run_program({file});
    EXPECT_EQ(result.status, 1);
    EXPECT_NE(result.output.find("[Obstacles/tool/File] Name = "), std::string::npos);
    EXPECT_NE(result.output.find("the surface has a hole: 3 edges"), std::string::npos);
    EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1);
  }


  // What cannot be a tool is told with section, key and value.
  TEST(Tool, BadInput)
  {
    const ScratchDirectory scratch;
    const std::string file                                        = scratch.path + "/case.prm";
    const std::vector<std::pair<std::string, std::string>> faults = {
      {"  set Shape = torus\n  subsection Torus\n   set Tube radius = 2\n  end\n", "Tube radius"},
      {"  set Shape = box\n  subsection Box\n   set Edge radius = 0.6\n  end\n", "Edge radius"},
      {"  set Motion = free\n  subsection Free\n   set Density = 1\n  end\n", "Mass"},
      {"  set Shape = box\n  set Motion = free\n  subsection Free\n   set Mass = 1\n"
       "   set Inertia = 1, 1, 3\n  end\n",
       "Inertia"},
      {"  set Motion = prescribed\n  subsection Prescribed\n   set Displacement = 1; 0; 0\n  end\n",
       "Displacement"},
      {"  set Obstacles = nobody\n", "Obstacles"}};
    for (const auto &[keys, key] : faults)
      {
        std::ofstream(file) << slab << tool(keys);
        const auto result = run_program({file});
        EXPECT_EQ(result.status, 1) << key;
        EXPECT_NE(result.output.find(key + " = "), std::string::npos) << result.output;
        EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1);
      }
  }
} // namespace rigid_obstacles
