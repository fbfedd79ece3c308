#pragma once

#include <akmon/parameters.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "support/body_overlap.h"
#include "support/kept_run.h"
#include "support/rank_case.h"

// Two elastic bricks that collide, turned against each other.

namespace akmon::test::bricks
{
  using Vector = dealii::Tensor<1, 3>;
  using Matrix = dealii::Tensor<2, 3>;

  inline const std::string two_bricks = R"(
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


  inline std::string
  text(const Vector &v)
  {
    return akmon::shortest_text(v[0]) + ", " + akmon::shortest_text(v[1]) + ", " +
           akmon::shortest_text(v[2]);
  }


  inline Matrix
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


  /// How a brick is made and moves.
  struct Brick
  {
    Vector size;
    std::array<unsigned int, 3> cells;
    Matrix R;
    Vector place, velocity;
  };


  inline std::vector<std::string>
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


  inline KeptRun
  collide(const Brick &lower,
          const Brick &upper,
          const double end,
          const std::vector<std::string> &more = {})
  {
    const ScratchDirectory scratch;
    const std::string file = scratch.path + "/cubes.prm";
    std::ofstream(file) << two_bricks;
    std::vector<std::string> overrides = {"Time/End=" + akmon::shortest_text(end)};
    for (const auto &of_brick : {overrides_of("lower", lower), overrides_of("upper", upper)})
      overrides.insert(overrides.end(), of_brick.begin(), of_brick.end());
    overrides.insert(overrides.end(), more.begin(), more.end());
    return run_and_keep(file, overrides);
  }


  /// The largest depth of two bricks in each other at some times, from their cells alone.
  inline double
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


  /// A run of the shipped bricks that is restarted from its first checkpoint has the same bits.
  inline void
  expect_same_bits_from_a_checkpoint(std::vector<std::string> overrides)
  {
    namespace fs = std::filesystem;
    const ScratchDirectory scratch;
    const std::string reference = scratch.path + "/reference", again = scratch.path + "/again";
    overrides.insert(overrides.end(), {"Checkpoint/Steps=8", "Output/Fields interval=0"});
    const auto first = run_program(arguments_for(shipped("crossed_bricks"), reference, overrides));
    ASSERT_EQ(first.status, 0) << first.output;
    fs::copy(reference, again);
    const auto checkpoints = checkpoints_in(again);
    const auto result      = run_program({"--restart", again + "/" + checkpoints[0]});
    EXPECT_EQ(result.status, 0) << result.output;
    expect_same_run(again, reference);
    EXPECT_EQ(file_content(again + "/" + checkpoints[1]),
              file_content(reference + "/" + checkpoints[1]));
  }
} // namespace akmon::test::bricks
