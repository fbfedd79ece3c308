#include <akmon/contact/search/body_motions.h>

#include <gtest/gtest.h>

#include <random>

#include "support/coupled_boxes.h"

// What the search is told of the motion of two bodies.

namespace body_motions_test
{
  using namespace akmon;
  using namespace akmon::test;
  using namespace akmon::test::coupled_boxes;

  // The first body flies with (3, 0, 4), one of its nodes with (0, 0, 2) more; the other rests. The
  // first body's last node is on no contact surface, and faster than all others.
  struct Flight
  {
    Flight()
      : boxes(2, 3, 0., false)
      , motions(boxes.discretization, surface_nodes)
    {
      bool first        = true;
      unsigned int last = 0;
      for (unsigned int node = 0; node < boxes.discretization.n_owned_nodes; ++node)
        if (boxes.discretization.body_of_node[node] == 0)
          {
            for (unsigned int d = 0; d < 3; ++d)
              {
                const double v               = d == 0 ? 3. : d == 2 ? (first ? 6. : 4.) : 0.;
                boxes.state.dx[3 * node + d] = boxes.state.dx_next[3 * node + d] = v;
              }
            first = false;
            last  = node;
          }
      boxes.state.dx_next[3 * last] = 1e3;
      for (unsigned int node = 0; node < boxes.discretization.n_owned_nodes; ++node)
        if (node != last)
          {
            surface_nodes.push_back(node);
            n_nodes += boxes.discretization.body_of_node[node] == 0;
          }
      motions.measure(boxes.state);
    }

    Boxes boxes;
    double n_nodes = 0.;
    std::vector<unsigned int> surface_nodes;
    BodyMotions motions;
  };


  TEST(BodyMotions, are_those_of_the_fastest_node)
  {
    Flight flight;
    EXPECT_NEAR(flight.motions.largest(), std::sqrt(45.), 1e-14);
    EXPECT_NEAR(flight.motions.around(0), std::sqrt(45.), 1e-14);
    EXPECT_EQ(flight.motions.around(1), 0.);
  }


  TEST(BodyMotions, within_a_body_are_seen_from_its_mean_motion)
  {
    Flight flight;
    EXPECT_NEAR(flight.motions.within(0), 2. * (1. - 1. / flight.n_nodes), 1e-14);
    EXPECT_EQ(flight.motions.within(1), 0.);
  }


  // No faster than both fastest nodes together; when the other body flies along, no faster than the
  // fastest node is against it.
  TEST(BodyMotions, bound_how_far_surfaces_approach_each_other)
  {
    Flight flight;
    EXPECT_NEAR(flight.motions.approach(0, 1), std::sqrt(45.), 1e-13);
    EXPECT_NEAR(flight.motions.approach(0, 0), 4. * (1. - 1. / flight.n_nodes), 1e-14);
    EXPECT_EQ(flight.motions.approach(1, 1), 0.);
    EXPECT_GE(flight.motions.largest_approach(), std::sqrt(45.) - 1e-13);
    EXPECT_LE(flight.motions.largest_approach(), 2. * std::sqrt(45.));
    auto &state = flight.boxes.state;
    for (unsigned int node = 0; node < flight.boxes.discretization.n_owned_nodes; ++node)
      if (flight.boxes.discretization.body_of_node[node] == 1)
        for (unsigned int d = 0; d < 3; ++d)
          state.dx[3 * node + d] = state.dx_next[3 * node + d] = d == 0 ? 3. : d == 2 ? 4. : 0.;
    flight.motions.measure(state);
    EXPECT_NEAR(flight.motions.approach(0, 1), 2., 1e-13);
    EXPECT_GE(flight.motions.largest_approach(), 2. - 1e-13);
    EXPECT_LE(flight.motions.largest_approach(), 4.);
  }


  // Bodies that fly together do not approach each other.
  TEST(BodyMotions, of_a_common_flight_are_no_approach)
  {
    Flight flight;
    for (unsigned int node = 0; node < flight.boxes.discretization.n_owned_nodes; ++node)
      for (unsigned int d = 0; d < 3; ++d)
        flight.boxes.state.dx[3 * node + d] = flight.boxes.state.dx_next[3 * node + d] = 1. + d;
    flight.motions.measure(flight.boxes.state);
    EXPECT_NEAR(flight.motions.largest(), std::sqrt(14.), 1e-14);
    EXPECT_NEAR(flight.motions.approach(0, 1), 0., 1e-14);
    EXPECT_NEAR(flight.motions.largest_approach(), 0., 1e-14);
  }


  TEST(BodyMotions, are_handed_on_to_neighbours)
  {
    Flight flight;
    flight.motions.set_neighbours({{{1, 0}}, {{1, 1}}, {{1, 0}}});
    EXPECT_NEAR(flight.motions.around(1), std::sqrt(45.), 1e-14);
    EXPECT_NEAR(flight.motions.within(1), std::sqrt(45.), 1e-14);
    EXPECT_EQ(flight.motions.approach(1, 1), 0.);
  }


  // The first body is (3, 0, 4) further, one of its nodes 2 more: that is 1 from the middle of its
  // displacements, (3, 0, 5).
  TEST(BodyMotions, since_a_mark_are_seen_from_the_middle_of_displacements)
  {
    Flight flight;
    auto &state = flight.boxes.state;
    flight.motions.mark(state);
    EXPECT_EQ(flight.motions.approach_since_mark(state), 0.);
    state.x += state.dx;
    EXPECT_NEAR(flight.motions.approach_since_mark(state), std::sqrt(34.) + 2., 1e-13);
    flight.motions.mark(state);
    EXPECT_EQ(flight.motions.approach_since_mark(state), 0.);
  }


  // For any motion no two nodes have come closer by more.
  TEST(BodyMotions, since_a_mark_bound_how_much_closer_nodes_have_come)
  {
    Flight flight;
    auto &state       = flight.boxes.state;
    const auto before = state.x;
    flight.motions.mark(state);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1., 1.);
    for (unsigned int i = 0; i < 10; ++i)
      {
        for (const unsigned int node : flight.surface_nodes)
          for (unsigned int d = 0; d < 3; ++d)
            state.x[3 * node + d] += (i + 1.) * uniform(random);
        double closest = 0.;
        for (const unsigned int a : flight.surface_nodes)
          for (const unsigned int b : flight.surface_nodes)
            closest = std::max(closest,
                               (at_node(before, a) - at_node(before, b)).norm() -
                                 (at_node(state.x, a) - at_node(state.x, b)).norm());
        EXPECT_LE(closest, flight.motions.approach_since_mark(state));
      }
  }


  // What swings is where it was.
  TEST(BodyMotions, to_and_fro_are_no_approach_since_a_mark)
  {
    Flight flight;
    auto &state = flight.boxes.state;
    flight.motions.mark(state);
    for (unsigned int i = 0; i < 8; ++i)
      state.x.add(i % 2 ? -1. : 1., state.dx);
    EXPECT_NEAR(flight.motions.approach_since_mark(state), 0., 1e-13);
  }
} // namespace body_motions_test
