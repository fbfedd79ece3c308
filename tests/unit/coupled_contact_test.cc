#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <vector>

#include "support/coupled_boxes.h"
#include "support/report.h"

// Problem 2 solved for all pairs at once, on two small boxes whose meshes do not match: through
// Contact and Fidcd. What must hold: no gap lost, forces where gaps are closed only, Coulomb's law
// for every pair, momentum.

namespace coupled_contact_test
{
  using namespace akmon;
  using namespace akmon::test;
  using namespace akmon::test::coupled_boxes;

  struct Setting
  {
    unsigned int n, m;
    bool symmetric;
  };


  void
  PrintTo(const Setting &setting, std::ostream *out)
  {
    *out << setting.n << "/" << setting.m << (setting.symmetric ? " symmetric" : " single");
  }


  class Coupled : public testing::TestWithParam<Setting>
  {
  };


  TEST_P(Coupled, impact_of_uniform_bodies_is_that_of_two_masses)
  {
    // Plastic: the faces meet at the common velocity of their nodal masses, the same for all nodes
    // as long as the lumped masses of both faces are those of uniform pressure.
    const auto [n, m, symmetric] = GetParam();
    Boxes boxes(n, m, 0., symmetric);
    boxes.start(Vector({0.5, 0., 0.}), Vector({-0.2, 0., 0.}), 0., 0);
    const Vector before({8. * 0.5 - 24. * 0.2, 0., 0.});
    unsigned int most = 0;
    for (unsigned int k = 0; k < 10; ++k)
      {
        boxes.check(0.);
        EXPECT_LE((boxes.momentum() - before).norm(), 1e-13);
        most = std::max(most, boxes.contact.report(boxes.state).iterations);
        boxes.step();
      }
    report("iterations, most", most);
    if (!symmetric)
      return;
    for (const auto &pair : boxes.contact.get_pairs())
      for (unsigned int k = 0; k < pair.n_nodes; ++k)
        EXPECT_NEAR(boxes.increment[pair.nodes[k]][0] / dt, (8. * 0.5 - 24. * 0.2) / 32., 1e-8);
  }


  TEST_P(Coupled, noisy_impact_keeps_gaps_forces_and_momentum)
  {
    const auto [n, m, symmetric] = GetParam();
    unsigned int most            = 0;
    for (unsigned int seed = 1; seed <= 5; ++seed)
      {
        Boxes boxes(n, m, 0., symmetric, Vector({0., 0.13, 0.21}));
        boxes.start(Vector({0.3, 0., 0.}), Vector({-0.2, 0., 0.}), 0.05, seed);
        const Vector before = boxes.momentum();
        for (unsigned int k = 0; k < 5; ++k)
          {
            boxes.check(0.);
            if (k > 0)
              {
                EXPECT_LE((boxes.momentum() - before).norm(), 1e-13);
              }
            most = std::max(most, boxes.contact.report(boxes.state).iterations);
            boxes.step();
          }
      }
    report("iterations, most", most);
  }


  TEST_P(Coupled, friction_follows_coulomb_for_every_pair)
  {
    const auto [n, m, symmetric] = GetParam();
    for (const double mu : {0.05, 0.3, 2.})
      {
        Boxes boxes(n, m, mu, symmetric, Vector({0., 0.13, 0.21}));
        boxes.start(Vector({0.3, 0.1, -0.05}), Vector({-0.2, 0., 0.}), 0.02, 3);
        const Vector before = boxes.momentum();
        for (unsigned int k = 0; k < 5; ++k)
          {
            boxes.check(mu);
            // The friction of all pairs does not feed energy: t . slip <= 0.
            const auto work = boxes.contact.works(boxes.state.dx_next,
                                                  &RigidBody::increment_after)[0];
            EXPECT_LE(work.tangential, 1e-12);
            Vector normal, tangential;
            for (const auto &force : boxes.contact.nodal_forces())
              {
                normal += force.normal;
                tangential += force.tangential;
              }
            EXPECT_LE(normal.norm() + tangential.norm(), 1e-13 * (1. + boxes.largest_force()));
            if (k > 0)
              {
                EXPECT_LE((boxes.momentum() - before).norm(), 1e-13);
              }
            boxes.step();
          }
      }
  }


  TEST_P(Coupled, sticks_when_friction_can_hold)
  {
    const auto [n, m, symmetric] = GetParam();
    Boxes boxes(n, m, 5., symmetric);
    boxes.start(Vector({0.5, 0.03, -0.04}), Vector({-0.2, 0., 0.}), 0., 0);
    boxes.check(5.);
    unsigned int sticking = 0;
    for (const auto &pair : boxes.contact.get_pairs())
      if (pair.normal_force > 0.)
        {
          EXPECT_LE(pair.tangential_part(pair.relative(boxes.increment)).norm(),
                    1.001e-10 * pair.size);
          sticking += pair.sticks;
        }
    const auto report_of_step = boxes.contact.report(boxes.state);
    EXPECT_GT(sticking, 0u);
    EXPECT_EQ(report_of_step.sticking_pairs, sticking);
    EXPECT_EQ(report_of_step.active_pairs, sticking);
  }


  INSTANTIATE_TEST_SUITE_P(Meshes,
                           Coupled,
                           testing::Values(Setting{1, 1, true},
                                           Setting{2, 3, true},
                                           Setting{3, 2, true},
                                           Setting{4, 3, true},
                                           Setting{3, 5, true},
                                           Setting{2, 3, false},
                                           Setting{3, 2, false},
                                           Setting{4, 2, false}));
} // namespace coupled_contact_test
