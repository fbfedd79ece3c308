#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "support/body_overlap.h"
#include "support/kept_run.h"
#include "support/rank_case.h"
#include "support/report.h"

// Bricks that meet with their edges: neither has a node that sees a face of the other.

namespace edge_contact
{
  using namespace akmon::test;
  using Vector = dealii::Tensor<1, 3>;
  using Matrix = dealii::Tensor<2, 3>;

  const std::string common = R"(
subsection Materials
  set Names = stuff
  subsection stuff
    set Density         = 1
    set Young's modulus = 1
    set Poisson's ratio = 0.3
  end
end
subsection Bodies
  set Names = lower, upper
  subsection lower
    set Material = stuff
    set Shape    = box
  end
  subsection upper
    set Material = stuff
    set Shape    = box
  end
end
subsection Contact
  set Names = touch
  subsection touch
    set Slave  = all
    set Master = all
  end
end
)";

  constexpr double degree = dealii::numbers::PI / 180., speed = 0.02, gap = 0.02;


  std::string
  text(const Vector &v)
  {
    return akmon::shortest_text(v[0]) + ", " + akmon::shortest_text(v[1]) + ", " +
           akmon::shortest_text(v[2]);
  }


  Matrix
  rotation(const unsigned int axis, const double angle)
  {
    const unsigned int a = (axis + 1) % 3, b = (axis + 2) % 3;
    Matrix R;
    R[axis][axis] = 1.;
    R[a][a] = R[b][b] = std::cos(angle);
    R[b][a]           = std::sin(angle);
    R[a][b]           = -R[b][a];
    return R;
  }


  // How a brick is made and moves.
  struct Brick
  {
    Vector size;
    std::array<unsigned int, 3> cells;
    Matrix R;
    Vector place, velocity;
  };


  std::vector<std::string>
  overrides_of(const std::string &name, const Brick &brick)
  {
    const auto &R      = brick.R;
    const double angle = std::acos(std::clamp(0.5 * (trace(R) - 1.), -1., 1.));
    const Vector axis({R[2][1] - R[1][2], R[0][2] - R[2][0], R[1][0] - R[0][1]});
    const std::string section = "Bodies/" + name + "/";
    return {section + "Box/Size=" + text(brick.size),
            section + "Box/Cells=" + std::to_string(brick.cells[0]) + ", " +
              std::to_string(brick.cells[1]) + ", " + std::to_string(brick.cells[2]),
            section + "Rotation axis=" + text(axis.norm() > 0. ? axis : Vector({0., 0., 1.})),
            section + "Rotation angle=" + akmon::shortest_text(angle / degree),
            section + "Position=" + text(brick.place),
            section + "Velocity=" + text(brick.velocity)};
  }


  KeptRun
  collide(const Brick &lower,
          const Brick &upper,
          const double end,
          const std::vector<std::string> &more = {})
  {
    const ScratchDirectory scratch;
    const std::string file = scratch.path + "/cubes.prm";
    std::ofstream(file) << common;
    std::vector<std::string> overrides = {"Time/End=" + akmon::shortest_text(end)};
    for (const auto &of_brick : {overrides_of("lower", lower), overrides_of("upper", upper)})
      overrides.insert(overrides.end(), of_brick.begin(), of_brick.end());
    overrides.insert(overrides.end(), more.begin(), more.end());
    return run_and_keep(file, overrides);
  }


  // What must hold of any impact.
  void
  expect_exact(const Table &history, const std::string &name)
  {
    const double penetration = largest_of(history["max_penetration_rel"]),
                 energy      = largest_of(history["energy_error"]),
                 momentum    = change_of_momentum(history) / (2. * speed),
                 angular     = change_of_momentum(history, "angular_momentum_") / speed;
    report(name + ": penetration over h", penetration);
    report(name + ": energy error", energy);
    report(name + ": momentum", momentum);
    report(name + ": angular momentum", angular);
    report(name + ": iterations, mean", mean_iterations(history));
    EXPECT_LE(penetration, 1e-6) << name;
    EXPECT_LE(energy, 1e-3) << name;
    EXPECT_LE(momentum, 1e-12) << name;
    EXPECT_LE(angular, 1e-12) << name;
  }


  // The lower cube stands on an edge along x and has one on top, the upper one the same, turned.
  const double half_diagonal = std::sqrt(0.5);

  Brick
  lower_cube()
  {
    return {Vector({1., 1., 1.}),
            {{3, 3, 3}},
            rotation(0, 45. * degree),
            Vector(),
            Vector({0., 0., speed})};
  }


  Brick
  upper_cube(const double angle, const Vector &shift, const Vector &drift = Vector())
  {
    return {Vector({1., 1., 1.}),
            {{3, 3, 3}},
            rotation(2, angle * degree) * rotation(0, 45. * degree),
            Vector({0., 0., 2. * half_diagonal + gap}) + shift,
            Vector({0., 0., -speed}) + drift};
  }


  // Central ones are thrown back; the others turn each other away and slide.
  TEST(EdgeContact, crossed_edges_do_not_pass)
  {
    for (const double angle : {90., 60., 45., 30., 20., 15., 10.})
      for (const Vector &shift : {Vector(), Vector({0.1, 0.05, 0.})})
        {
          const auto run         = collide(lower_cube(), upper_cube(angle, shift), 6.);
          const std::string name = std::to_string(int(angle)) + " degrees, off by " +
                                   akmon::shortest_text(shift.norm());
          expect_exact(run.history, name);
          const auto velocity  = velocities_of_bodies(*run.simulation);
          const double rebound = (velocity[1][2] - velocity[0][2]) / (2. * speed);
          report(name + ": rebound", rebound);
          if (angle >= 15.) // below, only the nodes are kept apart
            {
              EXPECT_GT(rebound, shift.norm() > 0. ? 0. : 0.8) << name;
            }
        }
  }


  TEST(EdgeContact, crossed_edges_rub)
  {
    for (const double angle : {90., 60., 45., 30., 20., 15., 10.})
      {
        const auto run         = collide(lower_cube(),
                                 upper_cube(angle, Vector(), Vector({0.01, 0.005, 0.})),
                                 6.,
                                 {"Contact/touch/Friction coefficient=0.3"});
        const std::string name = std::to_string(int(angle)) + " degrees with friction";
        expect_exact(run.history, name);
        const auto &friction = run.history["friction_dissipation"];
        report(name + ": friction dissipation", friction.back());
        EXPECT_GT(friction.back(), 0.);
        for (std::size_t i = 1; i < friction.size(); ++i)
          EXPECT_GE(friction[i], friction[i - 1] - 1e-15) << name << ", row " << i;
      }
  }


  // The largest depth of two bricks in each other at some times, from their cells alone.
  double
  depth_at(const std::vector<double> &times,
           const Brick &lower,
           const Brick &upper,
           const std::vector<std::string> &more)
  {
    double depth = 0.;
    for (const double time : times)
      depth = std::max(depth, depth_of_overlap(*collide(lower, upper, time, more).simulation));
    return depth;
  }


  // Off the centre the edges turn and slide, and dip into faces that are twisted by then.
  TEST(EdgeContact, crossed_edges_are_outside_of_cells)
  {
    for (const double angle : {90., 60., 45., 30., 20., 15.})
      for (const Vector &shift : {Vector(), Vector({0.1, 0.05, 0.})})
        for (const char *const friction : {"0", "0.3"})
          {
            const double depth = depth_at({0.8, 1.6, 2.5, 3.5, 4.5},
                                          lower_cube(),
                                          upper_cube(angle, shift),
                                          {std::string("Contact/touch/Friction coefficient=") +
                                           friction});
            report(std::to_string(int(angle)) + " degrees, off by " +
                     akmon::shortest_text(shift.norm()) + ", friction " + friction +
                     ": depth over h",
                   3. * depth);
            EXPECT_LE(3. * depth, shift.norm() == 0. ? 1e-9 : angle > 30. ? 1e-8 : 0.02);
          }
  }


  // A plank along x, 1/2 thick and one cell wide and thick, and one above it that is turned about
  // the vertical, rolled, shifted and pushed. Its least edges are h long.
  struct Planks
  {
    std::string name;
    double degrees, roll;
    Vector shift, drift;
    std::array<unsigned int, 2> cells;
    double length;
    double pairs, depth; ///< allowed penetrations over h, of pairs and from the cells
  };

  constexpr double h = 0.5;


  Brick
  lower_plank(const Planks &planks)
  {
    return {Vector({planks.length, 1., h}),
            {{planks.cells[0], 1, 1}},
            rotation(2, 0.),
            Vector(),
            Vector({0., 0., speed})};
  }


  Brick
  upper_plank(const Planks &planks)
  {
    return {Vector({planks.length, 1., h}),
            {{planks.cells[1], 1, 1}},
            rotation(2, planks.degrees * degree) * rotation(0, planks.roll * degree) *
              rotation(1, 0.5 * planks.roll * degree),
            Vector({0., 0., h + gap}) + planks.shift,
            Vector({0., 0., -speed}) + planks.drift};
  }


  void
  PrintTo(const Planks &planks, std::ostream *out)
  {
    *out << planks.name;
  }


  class CrossedPlanks : public testing::TestWithParam<Planks>
  {
  };


  // Faces lie flat on each other, and no node of either plank does, or only some do.
  TEST_P(CrossedPlanks, stay_apart)
  {
    const auto &planks = GetParam();
    const auto lower = lower_plank(planks), upper = upper_plank(planks);
    for (const char *const friction : {"0", "0.3"})
      {
        const std::vector<std::string> more = {"Time/Safety factor=0.2",
                                               std::string("Contact/touch/Friction coefficient=") +
                                                 friction};
        const auto run                      = collide(lower, upper, 6., more);
        const double penetration            = largest_of(run.history["max_penetration_rel"]),
                     depth = depth_at({1., 1.2, 1.4, 1.6, 1.8, 2.2, 3.}, lower, upper, more) / h;
        report(std::string("friction ") + friction + ": penetration over h", penetration);
        report("  depth over h", depth);
        report("  energy error", largest_of(run.history["energy_error"]));
        report("  iterations, mean", mean_iterations(run.history));
        EXPECT_LE(penetration, planks.pairs);
        EXPECT_LE(depth, planks.depth);
        EXPECT_LE(largest_of(run.history["energy_error"]), 1e-3);
        EXPECT_LE(change_of_momentum(run.history) / (2. * speed), 1e-12);
        EXPECT_LE(change_of_momentum(run.history, "angular_momentum_") / speed, 1e-12);
        EXPECT_GE(run.history["friction_dissipation"].back(), 0.);
        EXPECT_GT(largest_of(run.history["active_pairs"]), 1.);
      }
  }


  const Vector off({0.13, 0.07, 0.}), further_off({0.21, 0.07, 0.}),
    corner({0.4, 0.9, 0.}), no_drift, along({0.03, 0.02, 0.}), across({0.03, -0.02, 0.});

  // Twisted faces dip into edges that cross them aslant.
  INSTANTIATE_TEST_SUITE_P(
    Angles,
    CrossedPlanks,
    testing::Values(Planks{"square", 90., 0., off, no_drift, {{3, 3}}, 4., 1e-9, 1e-9},
                    Planks{"square_pushed", 90., 0., off, along, {{4, 5}}, 4., 1e-9, 1e-9},
                    Planks{"square_unlike", 90., 0., further_off, across, {{2, 4}}, 4., 1e-9, 1e-9},
                    Planks{"square_fine", 90., 0., off, no_drift, {{4, 4}}, 3.3, 1e-9, 1e-9},
                    Planks{"sixty", 60., 0., off, no_drift, {{3, 3}}, 4., 1e-9, 1e-9},
                    Planks{"sixty_unlike", 60., 0., further_off, across, {{2, 4}}, 4., 1e-9, 0.01},
                    Planks{"aslant", 45., 0., off, no_drift, {{3, 3}}, 4., 2e-7, 0.01},
                    Planks{"aslant_rolled", 45., 2., corner, no_drift, {{3, 3}}, 4., 2e-7, 0.01},
                    Planks{"flat", 30., 0., off, along, {{4, 5}}, 4., 2e-7, 0.01}),
    [](const auto &info) { return info.param.name; });


  TEST(EdgeContact, has_one_hash_on_any_number_of_ranks)
  {
    expect_one_hash({"crossed_bricks", {"Time/End=4"}},
                    3,
                    {"Output/Fields interval=0"},
                    [](const std::string &directory) {
                      const Table history(directory + "/history.csv");
                      expect_exact(history, "crossed bricks");
                      EXPECT_GT(largest_of(history["active_pairs"]), 0.);
                    });
    // The same bricks as planks, flat across each other.
    expect_one_hash({"crossed_bricks",
                     {"Time/End=4",
                      "Bodies/lower/Rotation angle=0",
                      "Bodies/upper/Rotation angle=0",
                      "Bodies/upper/Position=0.2, 0.1, 1.02",
                      "Bodies/lower/Box/Size=4, 1, 1",
                      "Bodies/upper/Box/Size=1, 4, 1",
                      "Bodies/lower/Box/Cells=3, 1, 2",
                      "Bodies/upper/Box/Cells=1, 3, 2"}},
                    3,
                    {"Output/Fields interval=0"},
                    [](const std::string &directory) {
                      const Table history(directory + "/history.csv");
                      report("planks: penetration over h",
                             largest_of(history["max_penetration_rel"]));
                      EXPECT_LE(largest_of(history["max_penetration_rel"]), 1e-9);
                      EXPECT_GT(largest_of(history["active_pairs"]), 3.);
                    });
  }


  TEST(EdgeContact, goes_on_from_a_checkpoint_with_the_same_bits)
  {
    namespace fs = std::filesystem;
    const ScratchDirectory scratch;
    const std::string reference = scratch.path + "/reference", again = scratch.path + "/again";
    const auto first = run_program(
      arguments_for(shipped("crossed_bricks"),
                    reference,
                    {"Time/End=4", "Checkpoint/Steps=8", "Output/Fields interval=0"}));
    ASSERT_EQ(first.status, 0) << first.output;
    fs::copy(reference, again);
    const auto checkpoints = checkpoints_in(again);
    const auto result      = run_program({"--restart", again + "/" + checkpoints[0]});
    EXPECT_EQ(result.status, 0) << result.output;
    expect_same_run(again, reference);
    EXPECT_EQ(file_content(again + "/" + checkpoints[1]),
              file_content(reference + "/" + checkpoints[1]));
  }
} // namespace edge_contact
