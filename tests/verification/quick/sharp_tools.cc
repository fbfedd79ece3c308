#include <gtest/gtest.h>

#include <cmath>

#include "support/kept_run.h"
#include "support/rank_case.h"
#include "support/report.h"
#include "support/sharp_tool.h"

// Sharp corners and edges of rigid tools against a slab 1 x 1 x 1/2 whose faces, 1/4 wide, are
// larger than the tools or crossed by their edges: no node of the slab sees them.

namespace sharp_tools
{
  using namespace akmon::test;

  // What a tool is pressed in with, drawn along and lifted.
  struct Press
  {
    Tool tool;
    Vector way; ///< sideways and down, at the deepest; length
  };


  void
  PrintTo(const Press &press, std::ostream *out)
  {
    *out << press.tool.name;
  }


  List
  prescribed(const Vector &way)
  {
    const auto of = [&](const unsigned int d) { return akmon::shortest_text(way[d]); };
    return {"Obstacles/tool/Motion=prescribed",
            "Obstacles/tool/Prescribed/Displacement=" + of(0) + "*t/0.025; " + of(1) +
              "*t/0.025; " + of(2) + "*sin(pi*t/0.05)^2"};
  }


  class PressedTool : public testing::TestWithParam<Press>
  {
  };


  TEST_P(PressedTool, stays_out_of_faces)
  {
    const auto &press = GetParam();
    for (const char *const friction : {"0", "0.3"})
      {
        auto keys = prescribed(press.way);
        keys.push_back(std::string("Obstacles/tool/Friction coefficient=") + friction);
        const ToolCase tool(press.tool, keys);
        const auto whole  = tool.run({});
        const double of_h = largest_of(whole.history["max_penetration_rel"]);
        double deepest    = -1.;
        for (const double end : {0.01, 0.0172, 0.025, 0.0304})
          {
            const auto run = tool.run({"Time/End=" + akmon::shortest_text(end)});
            const double u = std::sin(dealii::numbers::PI * end / 0.05);
            const Vector displacement(
              {press.way[0] * end / 0.025, press.way[1] * end / 0.025, press.way[2] * u * u});
            for (const auto &points : {tool.corners(displacement), tool.edge_points(displacement)})
              for (const auto &p : points)
                deepest = std::max(deepest, depth_below_top(*run.simulation, p));
          }
        report("friction " + std::string(friction) + ": penetration over h, of pairs", of_h);
        report("  of points of its edges", deepest / h);
        report("  energy error", largest_of(whole.history["energy_error"]));
        report("  force", largest_of(whole.history["tool.force_z"]));
        report("  iterations", mean_iterations(whole.history));
        EXPECT_LE(of_h, 1e-9);
        EXPECT_LE(deepest / h, 1e-9);
        EXPECT_LE(std::abs(largest_of(whole.history["energy_error"])), 1e-3);
        EXPECT_GT(largest_of(whole.history["tool.force_z"]), 100.);
      }
  }


  const List corner_down = {"Shape=box", "Box/Size=0.2, 0.2, 0.2", "Normal=1, 0.9, 0.8"};
  const List flat_box    = {"Shape=box", "Box/Size=0.1, 0.08, 0.2", "Twist=20"};


  // A box that stands on its long edge, at an angle to the edges of the slab's faces.
  List
  edge_down(const double degrees)
  {
    const double angle = degrees * dealii::numbers::PI / 180.;
    return {"Shape=box",
            "Box/Size=0.7, 0.2, 0.2",
            "Normal=" + akmon::shortest_text(-std::sin(angle)) + ", " +
              akmon::shortest_text(std::cos(angle)) + ", 1"};
  }


  INSTANTIATE_TEST_SUITE_P(
    Tools,
    PressedTool,
    testing::Values(
      Press{{"tip_at_node", {}, 0., 0.}, Vector({0., 0., -0.05})},
      Press{{"tip_at_edge", {}, 0.1, 0.}, Vector({0., 0., -0.05})},
      Press{{"tip_at_face", {}, 0.11, 0.13}, Vector({0., 0., -0.05})},
      Press{{"tip_drawn", {}, -0.2, -0.13}, Vector({0.2, 0.11, -0.04})},
      Press{{"tip_off_the_rim", {}, 0.41, 0.03}, Vector({0.1, 0.01, -0.04})},
      Press{{"corner", corner_down, 0.07, 0.06}, Vector({0.03, 0., -0.05})},
      Press{{"edge", edge_down(0.), 0.03, 0.06}, Vector({0.02, 0.03, -0.05})},
      Press{{"edge_at_2_degrees", edge_down(2.), 0.03, 0.}, Vector({0.02, 0.03, -0.05})},
      Press{{"edge_at_10_degrees", edge_down(10.), 0.03, 0.06}, Vector({0.02, 0.03, -0.05})},
      Press{{"edge_at_40_degrees", edge_down(40.), 0.03, 0.06}, Vector({0.02, 0.03, -0.05})},
      Press{{"flat_box", flat_box, 0.11, 0.12}, Vector({0.05, 0.02, -0.05})}),
    [](const auto &info) { return info.param.tool.name; });


  // The same box on its corner as a shape, as an STL file and as the boundary of a mesh file.
  TEST(PressedBox, is_the_same_from_any_file)
  {
    const ScratchDirectory scratch;
    const auto box = triangle_box(Vector({0.2, 0.2, 0.2}));
    write_file(scratch.path + "/box.stl", ascii_stl(box));
    std::ostringstream mesh;
    mesh << "*NODE\n";
    for (unsigned int i = 0; i < 8; ++i)
      mesh << i + 1 << ", " << box.vertices[i][0] << ", " << box.vertices[i][1] << ", "
           << box.vertices[i][2] << "\n";
    mesh << "*ELEMENT, TYPE=C3D8, ELSET=all\n1, 1, 2, 4, 3, 5, 6, 8, 7\n";
    write_file(scratch.path + "/box.inp", mesh.str());
    std::vector<double> forces;
    for (const std::string shape : {"box", "stl", "inp"})
      {
        List keys = {"Box/Size=0.2, 0.2, 0.2", "Normal=1, 0.9, 0.8", "Shape=box"};
        if (shape != "box")
          keys = {"File/Name=" + scratch.path + "/box." + shape,
                  "Normal=1, 0.9, 0.8",
                  "Shape=file"};
        const ToolCase tool({shape, keys, 0.07, 0.06}, prescribed(Vector({0.03, 0., -0.05})));
        const auto run = tool.run({"Time/End=0.025"});
        forces.push_back(run.history["tool.force_z"].back());
        report(shape + ": force", forces.back());
        EXPECT_LE(largest_of(run.history["max_penetration_rel"]), 1e-9);
      }
    EXPECT_NEAR(forces[1] / forces[0], 1., 1e-6);
    EXPECT_NEAR(forces[2] / forces[0], 1., 1e-6);
  }


  // Largest changes of momentum and of angular momentum over m v and m v times the slab's length.
  void
  expect_kept_momenta(const Table &history, const double momentum)
  {
    const double linear  = change_of_momentum(history) / momentum,
                 angular = change_of_momentum(history, "angular_momentum_") / momentum;
    report("change of momentum", linear);
    report("change of angular momentum", angular);
    EXPECT_LE(linear, 1e-12);
    EXPECT_LE(angular, 1e-12);
  }


  // Nothing holds the slab: it and the box hand on their momenta while the box slides and turns.
  TEST(FreeBox, keeps_momenta_and_energy)
  {
    const ScratchDirectory scratch;
    const std::string file = scratch.path + "/loose.prm";
    write_file(file, without_base(file_content(shipped("dropped_box"))));
    for (const char *const friction : {"0", "0.3"})
      {
        const auto run      = run_and_keep(file,
                                      {"Body force/Acceleration=0; 0; 0",
                                            std::string("Obstacles/box/Friction coefficient=") +
                                              friction});
        const auto &history = run.history;
        expect_kept_momenta(history, 16. * 3.);
        report("energy error", largest_of(history["energy_error"]));
        report("penetration over h", largest_of(history["max_penetration_rel"]));
        report("friction dissipation", history["friction_dissipation"].back());
        EXPECT_GT(history["box.velocity_z"].back(), -2.9);
        EXPECT_LE(largest_of(history["energy_error"]), 1e-4);
        EXPECT_LE(largest_of(history["max_penetration_rel"]), 1e-9);
        EXPECT_EQ(history["friction_dissipation"].back() > 1e-3, std::string(friction) != "0");
      }
  }


  // It tumbles over the slab until it has slid off it; no step may lose it.
  TEST(FreeBox, stays_outside_while_it_tumbles_over_the_rim)
  {
    const auto run      = run_and_keep(shipped("dropped_box"),
                                  {"Time/End=1.5", "Obstacles/box/Friction coefficient=0"});
    const auto &history = run.history;
    report("penetration over h", largest_of(history["max_penetration_rel"]));
    report("energy error", largest_of(history["energy_error"]));
    EXPECT_LT(history["box.displacement_z"].back(), -0.3); // it has fallen past the slab
    EXPECT_LE(largest_of(history["max_penetration_rel"]), 1e-8);
    EXPECT_LE(largest_of(history["energy_error"]), 1e-4);
  }


  TEST(FreeBox, has_one_hash_on_any_number_of_ranks)
  {
    expect_one_hash({"dropped_box", {"Time/End=0.06"}},
                    3,
                    {"Output/Fields interval=0"},
                    [](const std::string &directory) {
                      EXPECT_GT(largest_of(Table(directory + "/history.csv")["active_pairs"]), 0.);
                    });
  }


  // The slab is thrown on a tip that stands still, upside down: the tip's history is a wall's.
  TEST(FixedTip, is_hit_by_a_thrown_slab)
  {
    const ToolCase tool({"tip", {}, 0.09, -0.08},
                        {"Bodies/slab/Velocity=0.3, -0.2, 2",
                         "Obstacles/tool/Friction coefficient=0.2"},
                        without_base(slab));
    const auto run      = tool.run({});
    const auto &history = run.history;
    double deepest      = -1.;
    for (const auto &p : tool.edge_points({}))
      deepest = std::max(deepest, depth_below_top(*run.simulation, p));
    report("penetration over h", largest_of(history["max_penetration_rel"]));
    report("energy error", largest_of(history["energy_error"]));
    EXPECT_GT(largest_of(history["tool.force_z"]), 100.);
    EXPECT_LE(largest_of(history["max_penetration_rel"]), 1e-9);
    EXPECT_LE(deepest / h, 1e-9);
    EXPECT_LE(largest_of(history["energy_error"]), 1e-4);
  }


  // Shot at the slab faster than a face per step, straight and aslant, into a face and at the rim:
  // it is caught in the step that would carry it through. It is guided: it would turn by a radian.
  TEST(FastTip, does_not_pass_through_a_face)
  {
    for (const auto &[place, velocity] :
         {std::pair<const char *, const char *>{"0.11, 0.13, 0.4", "0, 0, -1500"},
          {"-0.5, -0.4, 0.71", "1100, 900, -1500"},
          {"0.43, 0.02, 0.5", "0, 0, -2000"}})
      {
        const ToolCase tool({"tip", {}, 0., 0.},
                            {"Obstacles/tool/Motion=free",
                             "Obstacles/tool/Free/Mass=1e-3",
                             "Obstacles/tool/Free/Rotations=",
                             std::string("Obstacles/tool/Free/Velocity=") + velocity},
                            without_base(slab));
        const auto run = tool.run({"Time/End=4e-3", std::string("Obstacles/tool/Point=") + place});
        const auto &history = run.history;
        report("penetration over h", largest_of(history["max_penetration_rel"]));
        report("its velocity after the impact", history["tool.velocity_z"].back());
        EXPECT_GT(largest_of(history["active_pairs"]), 0.);
        EXPECT_LE(largest_of(history["max_penetration_rel"]), 1e-9);
        EXPECT_GT(history["tool.velocity_z"].back(), -1.);
        EXPECT_LE(change_of_momentum(history) / (1e-3 * 2000.), 1e-12);
      }
  }
} // namespace sharp_tools
