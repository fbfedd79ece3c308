#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "support/kept_run.h"
#include "support/report.h"

// Small fast bodies against large faces, thin plates and rims: nothing passes through, whatever the
// step makes of it. A bullet of one cell flies at a plate of few cells at up to a quarter of the
// wave speed, so that it moves by a sixth of its size in a step.

using namespace akmon::test;

namespace
{
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


  // The top alone is master: beside it a slave has no partner until it is above.
  TEST(FastBodies, do_not_slip_under_a_rim)
  {
    std::mt19937 random(1);
    const auto between = [&](const double a, const double b) {
      return a + (b - a) * (random() / 4294967296.);
    };
    for (unsigned int i = 0; i < 40; ++i)
      {
        const double speed = between(0.05, 0.3);
        // From beside the plate, level with or above its top, inwards and down: its centre crosses
        // the plane of the top inside the rim.
        const double aside = between(0.02, 0.08), inside = between(0.02, 0.1),
                     height = between(0.03, 0.08);
        const Vector from({0.5 + aside, between(-0.3, 0.3), 0.05 + height}),
          to({0.5 - inside, 0., 0.05});
        Vector direction = to - from;
        direction[1]     = 0.1 * between(-1., 1.);
        direction /= direction.norm();
        const auto run           = shoot({0.1,
                                          from,
                                          speed * direction,
                                          between(0., 90.),
                                          0.3 / speed,
                                          {"Contact/touch/Slave=bullet", "Contact/touch/Master=plate:z+"}});
        const double penetration = largest_of(run.history["max_penetration_rel"]);
        report("shot " + std::to_string(i) + " at " + std::to_string(speed), penetration);
        EXPECT_LE(penetration, 1e-6) << i;
        EXPECT_LE(largest_of(run.history["energy_error"]), 0.05) << i;
      }
  }


  TEST(FastBodies, do_not_pass_edges_and_corners_of_a_closed_surface)
  {
    std::mt19937 random(2);
    const auto between = [&](const double a, const double b) {
      return a + (b - a) * (random() / 4294967296.);
    };
    for (unsigned int i = 0; i < 40; ++i)
      {
        const double speed = between(0.05, 0.3);
        // At a point near an edge of the top, from anywhere above.
        const Vector to({0.5 - between(-0.01, 0.05), between(-0.5, 0.5), 0.05});
        Vector direction({between(-1., 1.), between(-1., 1.), between(0.2, 1.)});
        direction /= direction.norm();
        const auto run = shoot(
          {0.1, to + 0.12 * direction, -speed * direction, between(0., 90.), 0.3 / speed});
        const double penetration = largest_of(run.history["max_penetration_rel"]);
        report("shot " + std::to_string(i) + " at " + std::to_string(speed), penetration);
        EXPECT_LE(penetration, 1e-6) << i;
        EXPECT_LE(largest_of(run.history["energy_error"]), 0.05) << i;
      }
  }
} // namespace
