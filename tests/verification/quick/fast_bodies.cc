#include <gtest/gtest.h>

#include <fstream>

#include "support/kept_run.h"
#include "support/report.h"

// Small fast bodies against large faces and thin plates: nothing passes through, whatever the
// step makes of it. A bullet of one cell flies at a plate of few cells at up to a quarter of the
// wave speed, so that it moves by a sixth of its size in a step.

namespace fast_bodies
{
  using namespace akmon::test;

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
  set Names = plate, bullet
  subsection plate
    set Material = stuff
    subsection Box
      set Size  = 1, 1, 0.1
      set Cells = 2, 2, 1
    end
  end
  subsection bullet
    set Material = stuff
    subsection Box
      set Size = 0.03, 0.03, 0.03
    end
  end
end
subsection Contact
  set Names = touch
  subsection touch
    set Slave                = all
    set Master               = all
    set Friction coefficient = 0.2
  end
end
)";


  struct Shot
  {
    double thickness;
    dealii::Tensor<1, 3> place, velocity; ///< of the bullet
    double angle;                         ///< by which it is turned about (1, 2, 3), degrees
    double end;
    std::vector<std::string> overrides = {};
  };


  std::string
  text(const dealii::Tensor<1, 3> &v)
  {
    return akmon::shortest_text(v[0]) + ", " + akmon::shortest_text(v[1]) + ", " +
           akmon::shortest_text(v[2]);
  }


  KeptRun
  shoot(const Shot &shot)
  {
    const ScratchDirectory scratch;
    const std::string file = scratch.path + "/shot.prm";
    std::ofstream(file) << common;
    std::vector<std::string> overrides = {"Bodies/plate/Box/Size=1, 1, " +
                                            akmon::shortest_text(shot.thickness),
                                          "Bodies/bullet/Position=" + text(shot.place),
                                          "Bodies/bullet/Velocity=" + text(shot.velocity),
                                          "Bodies/bullet/Rotation axis=1, 2, 3",
                                          "Bodies/bullet/Rotation angle=" +
                                            akmon::shortest_text(shot.angle),
                                          "Time/End=" + akmon::shortest_text(shot.end)};
    overrides.insert(overrides.end(), shot.overrides.begin(), shot.overrides.end());
    return run_and_keep(file, overrides);
  }


  // Deepest penetration, and whether the bullet was turned back from above the plate.
  void
  expect_turned_back(const KeptRun &run, const std::string &name)
  {
    const double penetration = largest_of(run.history["max_penetration_rel"]);
    report(name + ": penetration over h", penetration);
    EXPECT_LE(penetration, 1e-6) << name;
    EXPECT_LE(largest_of(run.history["energy_error"]), 0.05) << name;
    EXPECT_GT(run.history["impact_dissipation"].back(), 0.) << name;
    const auto velocity = velocities_of_bodies(*run.simulation);
    EXPECT_GE(velocity[1][2], velocity[0][2] - 1e-6) << name;
  }


  using Vector = dealii::Tensor<1, 3>;

  TEST(FastBodies, do_not_pass_the_middle_of_a_large_face)
  {
    for (const double speed : {0.01, 0.1, 0.2, 0.3})
      for (const double thickness : {0.1, 0.01})
        {
          const Vector place({0.21, 0.17, 0.5 * thickness + 0.05});
          const double end = 0.1 / speed;
          expect_turned_back(shoot({thickness, place, Vector({0., 0., -speed}), 35., end}),
                             "speed " + std::to_string(speed) + ", thickness " +
                               std::to_string(thickness));
        }
  }
} // namespace fast_bodies
