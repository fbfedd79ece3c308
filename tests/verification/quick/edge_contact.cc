#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "support/kept_run.h"
#include "support/report.h"

// Cubes that meet with their edges: neither has a node that sees a face of the other.

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
  collide(const Cube &lower, const Cube &upper, const double end)
  {
    const ScratchDirectory scratch;
    const std::string file = scratch.path + "/cubes.prm";
    std::ofstream(file) << common;
    std::vector<std::string> overrides = {"Time/End=" + akmon::shortest_text(end)};
    for (const auto &of_cube : {overrides_of("lower", lower), overrides_of("upper", upper)})
      overrides.insert(overrides.end(), of_cube.begin(), of_cube.end());
    return run_and_keep(file, overrides);
  }


  // What must hold of any impact without friction.
  void
  expect_exact(const KeptRun &run, const std::string &name)
  {
    const double penetration = largest_of(run.history["max_penetration_rel"]),
                 energy      = largest_of(run.history["energy_error"]),
                 momentum    = change_of_momentum(run.history) / (2. * speed),
                 angular     = change_of_momentum(run.history, "angular_momentum_") / speed;
    report(name + ": penetration over h", penetration);
    report(name + ": energy error", energy);
    report(name + ": momentum", momentum);
    report(name + ": angular momentum", angular);
    report(name + ": iterations, mean", mean_iterations(run.history));
    EXPECT_LE(penetration, 1e-9) << name;
    EXPECT_LE(energy, 1e-3) << name;
    EXPECT_LE(momentum, 1e-12) << name;
    EXPECT_LE(angular, 1e-12) << name;
  }


  // The lower cube stands on an edge along x and has one on top, the upper one the same, turned.
  const double half_diagonal = std::sqrt(0.5);

  Cube
  lower_cube(const unsigned int cells)
  {
    return {cells, rotation(0, 45. * degree), Vector(), Vector({0., 0., speed})};
  }


  Cube
  upper_cube(const unsigned int cells, const double angle)
  {
    return {cells,
            rotation(2, angle * degree) * rotation(0, 45. * degree),
            Vector({0., 0., 2. * half_diagonal + gap}),
            Vector({0., 0., -speed})};
  }


  // In the middle of both edges: between their nodes, or on a node of the lower one's.
  TEST(EdgeContact, crossed_edges_do_not_pass)
  {
    for (const double angle : {90., 60., 20.})
      for (const unsigned int cells : {2, 3})
        {
          const auto run         = collide(lower_cube(cells), upper_cube(3, angle), 8.);
          const std::string name = std::to_string(angle) + " degrees, " + std::to_string(cells) +
                                   " cells";
          expect_exact(run, name);
          // They are turned back.
          const auto velocity  = velocities_of_bodies(*run.simulation);
          const double rebound = (velocity[1][2] - velocity[0][2]) / (2. * speed);
          report(name + ": rebound", rebound);
          EXPECT_GT(rebound, 0.9) << name;
        }
  }
} // namespace
