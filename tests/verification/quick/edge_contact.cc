#include <gtest/gtest.h>

#include <cmath>

#include "support/bricks.h"
#include "support/rank_case.h"
#include "support/report.h"

// Bricks that meet with their edges: neither has a node that sees a face of the other.

namespace edge_contact
{
  using namespace akmon::test;
  using namespace akmon::test::bricks;

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
    expect_same_bits_from_a_checkpoint({"Time/End=4"});
  }
} // namespace edge_contact
