#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/two_cubes.h"

// One slave node against one segment through Contact and Fidcd: the forces of Problem 3 (decoupled)
// in closed form, momentum, the gap that is left, Lemma 1. Masses fly freely: no internal forces.

namespace contact_pair_test
{
  using namespace akmon;
  using namespace akmon::test;
  using namespace akmon::test::two_cubes;

  TEST(OnePair, HasTheWeightsNormalAndGapOfTheProjection)
  {
    TwoCubes cubes(overlaps_closely, Vector(), Vector(), contact_law(to_segment, 0.));
    ASSERT_EQ(cubes.contact.get_pairs().size(), 1u);
    const auto &pair = cubes.contact.get_pairs()[0];
    EXPECT_LE((at_node(cubes.state.x, pair.slave) - Vector({0.5, 0.5, 0.5})).norm(), 1e-15);
    ASSERT_EQ(pair.n_nodes, 5u);
    EXPECT_EQ(cubes.node(pair, 0), pair.slave);
    EXPECT_EQ(pair.weights[0], 1.);
    std::vector<double> N;
    for (unsigned int k = 1; k < 5; ++k)
      N.push_back(-pair.weights[k]);
    std::sort(N.begin(), N.end());
    const std::vector<double> expected = {0.12, 0.18, 0.28, 0.42};
    for (unsigned int k = 0; k < 4; ++k)
      EXPECT_NEAR(N[k], expected[k], 1e-14);
    EXPECT_LE((pair.normal - Vector({-1., 0., 0.})).norm(), 1e-15);
    EXPECT_NEAR(pair.gap, gap_within_reach, 1e-15);
    EXPECT_NEAR(pair.size, 1., 1e-15);
    EXPECT_EQ(pair.normal_force, 0.);
  }


  TEST(OnePair, ImpactClosesTheGapExactlyAndExchangesMomentum)
  {
    // Approach at 0.7: the gap would be overrun in the first step of 0.1.
    TwoCubes cubes(one_node_overlaps,
                   Vector({0.5, 0., 0.}),
                   Vector({-0.2, 0., 0.}),
                   contact_law(to_segment, 0.));
    const auto &pair = cubes.contact.get_pairs()[0];
    const double A   = (1. + (0.42 * 0.42 + 0.28 * 0.28 + 0.12 * 0.12 + 0.18 * 0.18) / 3.) /
                     (2. / (dt * dt)); // starting step: m* = 2 m/dt^2
    EXPECT_NEAR(cubes.delassus(pair), A, 1e-15);
    EXPECT_NEAR(pair.normal_force, (0.07 - initial_gap) / A, 1e-12);
    EXPECT_NEAR(pair.gap + pair.normal * cubes.relative(pair, cubes.state.dx_next), 0., 1e-16);
    // The starting step is half a step of force: momenta of the increments after it.
    const Vector before({8. * 0.5 - 24. * 0.2, 0., 0.});
    EXPECT_LE((cubes.momentum() - before).norm(), 1e-14);

    for (unsigned int n = 0; n < 20; ++n)
      {
        cubes.step();
        for (const auto &p : cubes.contact.get_pairs())
          {
            EXPECT_GE(p.gap, -1e-15) << n;
            EXPECT_GE(p.normal_force, 0.) << n;
          }
        EXPECT_LE((cubes.momentum() - before).norm(), 1e-13) << n;
      }
  }


  TEST(OnePair, ForceLawHoldsInLaterStepsToo)
  {
    // At 0.07 the gap closes in the second step: m* = m/dt^2, t_n = -(n G dx_f + g)/A.
    TwoCubes cubes(one_node_overlaps,
                   Vector({0.05, 0., 0.}),
                   Vector({-0.02, 0., 0.}),
                   contact_law(to_segment, 0.));
    EXPECT_EQ(cubes.contact.get_pairs()[0].normal_force, 0.);
    cubes.step();
    const auto &pair = cubes.contact.get_pairs()[0];
    EXPECT_NEAR(pair.gap, 0.003, 1e-15);
    const double A = (1. + 0.3016 / 3.) * dt * dt;
    EXPECT_NEAR(cubes.delassus(pair), A, 1e-15);
    EXPECT_NEAR(pair.normal_force, (0.007 - 0.003) / A, 1e-12);
    // What a normal force does: impulse t_n dt on the slave node, shared by the masters.
    EXPECT_NEAR(at_node(cubes.state.dx_next, pair.slave)[0],
                0.005 - pair.normal_force * dt * dt,
                1e-15);
    for (unsigned int k = 1; k < 5; ++k)
      EXPECT_NEAR(at_node(cubes.state.dx_next, cubes.node(pair, k))[0],
                  -0.002 - pair.weights[k] * pair.normal_force * dt * dt / 3.,
                  1e-15);
    const auto report = cubes.contact.report(cubes.state);
    EXPECT_EQ(report.active_pairs, 1u);
    EXPECT_NEAR(report.interfaces[0].force()[0], -pair.normal_force, 1e-15);
    EXPECT_EQ(report.max_penetration, 0.);
    // Enforcement at the position reached: the next gap is nothing.
    cubes.step();
    EXPECT_NEAR(cubes.contact.get_pairs()[0].gap, 0., 1e-16);
  }


  TEST(OnePair, NoForceAtAGapThatStaysOpen)
  {
    TwoCubes cubes(one_node_overlaps,
                   Vector({0.05, 0., 0.}),
                   Vector({-0.0499, 0., 0.}),
                   contact_law(to_segment, 0.5));
    EXPECT_EQ(cubes.contact.get_pairs()[0].normal_force, 0.);
    EXPECT_EQ(cubes.contact.report(cubes.state).active_pairs, 0u);
    EXPECT_TRUE(cubes.contact.nodal_forces().empty());
    cubes.step();
    EXPECT_GT(cubes.contact.get_pairs()[0].normal_force, 0.);
  }


  TEST(OnePair, TangentialForceSticksOrSlides)
  {
    // Approach at 0.7, slip at 0.3 along y and 0.4 along z.
    const Vector v({0.7, 0.3, -0.4});
    for (const double mu : {0.1, 0.5, 0.83, 0.84, 2.})
      for (const auto stick : {ContactLaw::Stick::forward, ContactLaw::Stick::central})
        {
          TwoCubes cubes(one_node_overlaps, v, Vector(), contact_law(to_segment, mu, stick));
          const auto &pair = cubes.contact.get_pairs()[0];
          const double A   = cubes.delassus(pair);
          const double t_n = 0.06 / A, sticking = 0.05 / A; // limit: mu = 5/6
          EXPECT_NEAR(pair.normal_force, t_n, 1e-11);
          const Vector direction({0., -0.6, 0.8});
          EXPECT_EQ(pair.sticks, mu > 5. / 6.) << mu;
          EXPECT_LE((pair.tangential_force - std::min(mu * t_n, sticking) * direction).norm(),
                    1e-11)
            << mu;
          const Vector slip = cubes.relative(pair, cubes.state.dx_next);
          if (pair.sticks)
            EXPECT_LE(Vector({0., slip[1], slip[2]}).norm(), 1e-16);
          else // less than before, not reversed
            EXPECT_LT((slip * direction) * -1., 0.05);
          EXPECT_LE((slip * direction), 1e-16);
          EXPECT_EQ(cubes.contact.report(cubes.state).sticking_pairs, mu > 5. / 6. ? 1u : 0u);
        }
  }


  TEST(OnePair, StickZeroesTheIncrementOrTheCentralVelocity)
  {
    // Contact in the second step, where both notions differ: v_{n+1} = (dx/dt + dx_next/dt)/2.
    const Vector v({0.07, 0.003, -0.004});
    for (const auto stick : {ContactLaw::Stick::forward, ContactLaw::Stick::central})
      {
        TwoCubes cubes(one_node_overlaps, v, Vector(), contact_law(to_segment, 5., stick));
        cubes.step();
        const auto &pair = cubes.contact.get_pairs()[0];
        ASSERT_TRUE(pair.sticks);
        const Vector forward = cubes.relative(pair, cubes.state.dx_next);
        const Vector central = (forward + cubes.relative(pair, cubes.state.dx)) / (2. * dt);
        const Vector zero    = stick == ContactLaw::Stick::forward ? forward : central;
        const Vector other   = stick == ContactLaw::Stick::forward ? central : forward;
        EXPECT_LE(std::hypot(zero[1], zero[2]), 1e-17);
        // The other one is half the approach, or the approach thrown back.
        const double expected = stick == ContactLaw::Stick::forward ? 0.005 / 2. : 0.005 * dt;
        EXPECT_NEAR(std::hypot(other[1], other[2]), expected, 1e-16);
      }
  }


  TEST(OnePair, TangentialForceLeavesTheNormalGapAlone)
  {
    // Lemma 1: t_n . A t_tau = 0 for a pair; A t_tau = G m*^{-1} G^T t_tau = A_ii t_tau.
    const Vector v({0.7, 0.3, -0.4});
    TwoCubes frictionless(one_node_overlaps, v, Vector(), contact_law(to_segment, 0.));
    for (const double mu : {0.2, 3.})
      {
        TwoCubes cubes(one_node_overlaps, v, Vector(), contact_law(to_segment, mu));
        const auto &pair     = cubes.contact.get_pairs()[0];
        const auto &without  = frictionless.contact.get_pairs()[0];
        const Vector A_t_tau = cubes.relative(pair, cubes.state.dx_next) -
                               frictionless.relative(without, frictionless.state.dx_next);
        EXPECT_LE((A_t_tau - cubes.delassus(pair) * pair.tangential_force).norm(), 1e-16);
        EXPECT_LE(std::abs(pair.normal_force * pair.normal * A_t_tau), 1e-14);
        EXPECT_EQ(pair.normal * pair.tangential_force, 0.);
        EXPECT_NEAR(pair.normal_force, without.normal_force, 1e-12);
        EXPECT_NEAR(pair.gap + pair.normal * cubes.relative(pair, cubes.state.dx_next), 0., 1e-16);
        // A is positive on t_n: t_n . A t_n = A_ii t_n^2.
        const Vector A_t_n = frictionless.relative(without, frictionless.state.dx_next) -
                             frictionless.relative(without, frictionless.free);
        EXPECT_NEAR(without.normal_force * (without.normal * A_t_n),
                    frictionless.delassus(without) * std::pow(without.normal_force, 2),
                    1e-12);
      }
  }


  TEST(OnePair, WorkIsForceTimesIncrement)
  {
    TwoCubes cubes(one_node_overlaps,
                   Vector({0.7, 0.3, -0.4}),
                   Vector(),
                   contact_law(to_segment, 0.2));
    const auto &pair  = cubes.contact.get_pairs()[0];
    const auto work   = cubes.contact.works(cubes.state.dx_next, &RigidBody::increment_after)[0];
    const Vector slip = cubes.relative(pair, cubes.state.dx_next);
    EXPECT_NEAR(work.normal, pair.normal_force * (pair.normal * slip), 1e-14);
    EXPECT_NEAR(work.tangential, pair.tangential_force * slip, 1e-14);
    EXPECT_LT(work.tangential, 0.);
  }


  TEST(OnePair, PrescribedMotionIsAnInfiniteMass)
  {
    // The master's face is held: A_ii = 1/m*_s, and it does not move.
    PrescribedMotion held;
    held.name     = "held";
    held.type     = PrescribedMotion::Type::symmetry;
    held.surfaces = {"right:x-"};
    TwoCubes cubes(one_node_overlaps,
                   Vector({0.7, 0., 0.}),
                   Vector(),
                   contact_law(to_segment, 0.),
                   {held});
    const auto &pair = cubes.contact.get_pairs()[0];
    EXPECT_NEAR(pair.normal_force, 0.06 * 2. / (dt * dt), 1e-12);
    for (unsigned int k = 1; k < 5; ++k)
      EXPECT_EQ(at_node(cubes.state.dx_next, cubes.node(pair, k))[0], 0.);
    EXPECT_NEAR(at_node(cubes.state.dx_next, pair.slave)[0], initial_gap, 1e-16);
  }


  TEST(MatchingFaces, FourPairsMeetAsTwoMassesEach)
  {
    // Masses 1 and 3 at 0.05 and -0.02: plastic impact of each pair, common velocity
    // (0.05 - 3 0.02)/4 once the gap is closed.
    for (const auto model : {to_segment, to_point})
      {
        TwoCubes cubes(Vector(),
                       Vector({0.05, 0., 0.}),
                       Vector({-0.02, 0., 0.}),
                       contact_law(model, 0.));
        const Vector before = cubes.momentum();
        EXPECT_EQ(cubes.contact.get_pairs().size(), 4u);
        for (unsigned int n = 1; n <= 10; ++n)
          {
            cubes.step();
            ASSERT_EQ(cubes.contact.get_pairs().size(), 4u);
            EXPECT_LE((cubes.momentum() - before).norm(), 1e-15);
            for (const auto &pair : cubes.contact.get_pairs())
              {
                ASSERT_EQ(pair.n_nodes, 2u);
                EXPECT_EQ(pair.weights[1], -1.);
                EXPECT_GE(pair.gap, -2e-16);
                if (n == 1) // closes: t_n = (0.007 - 0.003)/A, A = (1 + 1/3) dt^2
                  {
                    EXPECT_NEAR(pair.normal_force, 0.004 / (4. / 3. * dt * dt), 1e-12);
                  }
                if (n == 2) // the rest of the approach, 0.003 a step
                  {
                    EXPECT_NEAR(pair.normal_force, 0.003 / (4. / 3. * dt * dt), 1e-12);
                  }
                if (n >= 2)
                  {
                    EXPECT_NEAR(pair.gap, 0., 2e-16);
                    EXPECT_NEAR(at_node(cubes.state.dx_next, pair.slave)[0] / dt, -0.0025, 1e-14);
                    EXPECT_NEAR(at_node(cubes.state.dx_next, cubes.node(pair, 1))[0] / dt,
                                -0.0025,
                                1e-14);
                  }
                if (n > 2)
                  {
                    EXPECT_NEAR(pair.normal_force, 0., 1e-12);
                  }
              }
          }
      }
  }


  TEST(Penetration, IsNotEjectedAtOnceAndNeverGrows)
  {
    // The slave node is put 0.02 deep at rest: 1e-3 of it is taken back in a step.
    const double released = 1e-3, c = std::sqrt(1. / 8.);
    TwoCubes cubes(overlaps_closely,
                   Vector(),
                   Vector(),
                   contact_law(to_segment, 0.),
                   {},
                   released / (c * dt));
    ASSERT_EQ(cubes.contact.get_pairs().size(), 1u);
    const unsigned int slave = cubes.contact.get_pairs()[0].slave;
    cubes.state.x.local_element(3 * slave) += gap_within_reach + 0.02;
    // The master face turns as its corners are pushed unevenly: gaps are linear but for 1e-9.
    double depth = 0.02;
    for (unsigned int n = 0; n < 5; ++n)
      {
        cubes.step();
        ASSERT_EQ(cubes.contact.get_pairs().size(), 1u);
        const auto &pair = cubes.contact.get_pairs()[0];
        EXPECT_NEAR(pair.gap, -depth, 1e-9) << n;
        EXPECT_GE(pair.normal * cubes.relative(pair, cubes.state.dx_next), released * (1. - 1e-12));
        EXPECT_NEAR(cubes.contact.report(cubes.state).max_penetration, -pair.gap, 1e-15);
        depth -= pair.normal * cubes.relative(pair, cubes.state.dx_next);
      }
    EXPECT_LT(depth, 0.02 - 5. * 0.75 * released);
  }
} // namespace contact_pair_test
