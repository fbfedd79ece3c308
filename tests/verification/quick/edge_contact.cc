#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "support/kept_run.h"
#include "support/rank_case.h"
#include "support/report.h"

// Bricks that meet with their edges: neither has a node that sees a face of the other.

using namespace akmon::test;

namespace
{
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


  // How a unit cube is made and moves.
  struct Cube
  {
    unsigned int cells;
    Matrix R;
    Vector place, velocity;
  };


  std::vector<std::string>
  overrides_of(const std::string &name, const Cube &cube)
  {
    const auto &R      = cube.R;
    const double angle = std::acos(std::clamp(0.5 * (trace(R) - 1.), -1., 1.));
    const Vector axis({R[2][1] - R[1][2], R[0][2] - R[2][0], R[1][0] - R[0][1]});
    const std::string section = "Bodies/" + name + "/", cells = std::to_string(cube.cells);
    return {section + "Box/Size=1, 1, 1",
            section + "Box/Cells=" + cells + ", " + cells + ", " + cells,
            section + "Rotation axis=" + text(axis.norm() > 0. ? axis : Vector({0., 0., 1.})),
            section + "Rotation angle=" + akmon::shortest_text(angle / degree),
            section + "Position=" + text(cube.place),
            section + "Velocity=" + text(cube.velocity)};
  }


  KeptRun
  collide(const Cube &lower,
          const Cube &upper,
          const double end,
          const std::vector<std::string> &more = {})
  {
    const ScratchDirectory scratch;
    const std::string file = scratch.path + "/cubes.prm";
    std::ofstream(file) << common;
    std::vector<std::string> overrides = {"Time/End=" + akmon::shortest_text(end)};
    for (const auto &of_cube : {overrides_of("lower", lower), overrides_of("upper", upper)})
      overrides.insert(overrides.end(), of_cube.begin(), of_cube.end());
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

  Cube
  lower_cube()
  {
    return {3, rotation(0, 45. * degree), Vector(), Vector({0., 0., speed})};
  }


  Cube
  upper_cube(const double angle, const Vector &shift, const Vector &drift = Vector())
  {
    return {3,
            rotation(2, angle * degree) * rotation(0, 45. * degree),
            Vector({0., 0., 2. * half_diagonal + gap}) + shift,
            Vector({0., 0., -speed}) + drift};
  }


  // Central ones are thrown back; the others turn each other away and slide.
  TEST(EdgeContact, crossed_edges_do_not_pass)
  {
    for (const double angle : {90., 60., 30., 10.})
      for (const Vector &shift : {Vector(), Vector({0.1, 0.05, 0.})})
        {
          const auto run         = collide(lower_cube(), upper_cube(angle, shift), 6.);
          const std::string name = std::to_string(int(angle)) + " degrees, off by " +
                                   akmon::shortest_text(shift.norm());
          expect_exact(run.history, name);
          const auto velocity  = velocities_of_bodies(*run.simulation);
          const double rebound = (velocity[1][2] - velocity[0][2]) / (2. * speed);
          report(name + ": rebound", rebound);
          if (angle >= 20.) // below, only the nodes are kept apart
            {
              EXPECT_GT(rebound, shift.norm() > 0. ? 0. : 0.8) << name;
            }
        }
  }


  TEST(EdgeContact, crossed_edges_rub)
  {
    for (const double angle : {90., 60., 30., 10.})
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
} // namespace
