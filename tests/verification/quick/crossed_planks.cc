#include <gtest/gtest.h>

#include "support/bricks.h"
#include "support/rank_case.h"
#include "support/report.h"

// Planks one cell wide that lie flat across each other: hardly a node of either is on a face, and
// faces that are twisted dip over edges between their ends and crossings.

namespace crossed_planks
{
  using namespace akmon::test;
  using namespace akmon::test::bricks;

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


  const Vector off({0.13, 0.07, 0.}), further_off({0.21, 0.07, 0.}), corner({0.4, 0.9, 0.}),
    above({0.21, 0.07, 0.1}), no_drift, along({0.03, 0.02, 0.}), across({0.03, -0.02, 0.});

  // Twisted faces dip into edges that cross them aslant.
  INSTANTIATE_TEST_SUITE_P(
    Angles,
    CrossedPlanks,
    testing::Values(Planks{"square", 90., 0., off, no_drift, {{3, 3}}, 4., 1e-9, 1e-9},
                    Planks{"square_pushed", 90., 0., off, along, {{4, 5}}, 4., 1e-9, 1e-9},
                    Planks{"square_unlike", 90., 0., further_off, across, {{2, 4}}, 4., 1e-9, 1e-9},
                    Planks{"square_fine", 90., 0., off, no_drift, {{4, 4}}, 3.3, 1e-9, 1e-9},
                    Planks{"sixty", 60., 0., off, no_drift, {{3, 3}}, 4., 1e-9, 1e-9},
                    Planks{"sixty_unlike", 60., 0., further_off, across, {{2, 4}}, 4., 1e-9, 1e-9},
                    Planks{"aslant", 45., 0., off, no_drift, {{3, 3}}, 4., 2e-7, 2e-7},
                    Planks{"aslant_rolled", 45., 2., corner, no_drift, {{3, 3}}, 4., 2e-7, 2e-7},
                    Planks{"aslant_unlike", 45., 0., further_off, across, {{2, 4}}, 4., 2e-7, 2e-7},
                    Planks{"flat", 30., 0., off, along, {{4, 5}}, 4., 2e-7, 2e-7},
                    Planks{"flat_like", 30., 0., off, no_drift, {{3, 3}}, 4., 2e-7, 2e-7},
                    Planks{"flat_unlike", 30., 0., further_off, across, {{2, 4}}, 4., 2e-7, 2e-7},
                    Planks{"flat_rolled", 30., 2., corner, no_drift, {{4, 5}}, 4., 2e-7, 2e-7},
                    Planks{"flatter", 20., 0., further_off, across, {{2, 4}}, 4., 2e-7, 2e-7},
                    Planks{"flatter_rolled", 20., 2., above, across, {{5, 4}}, 4., 2e-7, 2e-7},
                    Planks{"flattest", 15., 0., further_off, across, {{2, 4}}, 4., 2e-7, 2e-7}),
    [](const auto &info) { return info.param.name; });


  // The edges of one are then those of the slave, the other's of the master, and none of both.
  TEST(TwoSurfaces, are_kept_apart_as_one)
  {
    const Planks planks{"", 30., 0., further_off, across, {{2, 4}}, 4., 0., 0.};
    const std::vector<std::string> more = {"Time/Safety factor=0.2",
                                           "Contact/touch/Slave=lower:all",
                                           "Contact/touch/Master=upper:all",
                                           "Contact/touch/Friction coefficient=0.3"};
    const auto run     = collide(lower_plank(planks), upper_plank(planks), 6., more);
    const double depth = depth_at({1., 1.4, 1.8, 3.},
                                  lower_plank(planks),
                                  upper_plank(planks),
                                  more) /
                         h;
    report("penetration over h", largest_of(run.history["max_penetration_rel"]));
    report("depth over h", depth);
    EXPECT_LE(largest_of(run.history["max_penetration_rel"]), 2e-7);
    EXPECT_LE(depth, 2e-7);
    EXPECT_LE(change_of_momentum(run.history) / (2. * speed), 1e-12);
    EXPECT_LE(change_of_momentum(run.history, "angular_momentum_") / speed, 1e-12);
  }


  // The crossed bricks as planks that lie flat across each other, aslant.
  const std::vector<std::string> as_planks = {"Time/End=4",
                                              "Time/Safety factor=0.4",
                                              "Bodies/lower/Rotation angle=0",
                                              "Bodies/upper/Rotation angle=-60",
                                              "Bodies/upper/Rotation axis=0, 0, 1",
                                              "Bodies/upper/Position=0.2, 0.1, 1.02",
                                              "Bodies/lower/Box/Size=4, 1, 1",
                                              "Bodies/upper/Box/Size=1, 4, 1",
                                              "Bodies/lower/Box/Cells=2, 1, 2",
                                              "Bodies/upper/Box/Cells=1, 4, 2"};


  TEST(CrossedPlanksOnRanks, have_one_hash)
  {
    for (const bool two_surfaces : {false, true})
      {
        auto overrides = as_planks;
        if (two_surfaces)
          overrides.insert(overrides.end(),
                           {"Contact/touch/Slave=upper:all", "Contact/touch/Master=lower:all"});
        expect_one_hash({"crossed_bricks", overrides},
                        3,
                        {"Output/Fields interval=0"},
                        [](const std::string &directory) {
                          const Table history(directory + "/history.csv");
                          const double penetration = largest_of(history["max_penetration_rel"]);
                          report("penetration over h", penetration);
                          report("active pairs", largest_of(history["active_pairs"]));
                          EXPECT_LE(penetration, 2e-7);
                          EXPECT_GT(largest_of(history["active_pairs"]), 4.);
                        });
      }
  }


  // Pairs that have joined in a step are known in the next.
  TEST(CrossedPlanksOnRanks, go_on_from_a_checkpoint_with_the_same_bits)
  {
    expect_same_bits_from_a_checkpoint(as_planks);
  }
} // namespace crossed_planks
