#include <akmon/contact/contact.h>
#include <akmon/time/fidcd.h>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

// Coulomb's law (8)-(11) alone, and one slave node against one segment through Contact and Fidcd:
// the forces of Problem 3 in closed form, momentum, the gap that is left, Lemma 1. Masses fly
// freely: no internal forces.

namespace
{
  using namespace akmon;
  using Vector = dealii::Tensor<1, 3>;

  // ---------------------------------------------------------------------------------------------
  // Coulomb's law
  // ---------------------------------------------------------------------------------------------

  TEST(Coulomb, SticksBelowTheLimit)
  {
    const Coulomb law{0.5};
    const Vector stick({3., -1., 2.}); // |stick| = 3.7417 < 0.5 * 10
    const auto result = law.tangential_force(stick, 10.);
    EXPECT_TRUE(result.sticks);
    EXPECT_EQ(result.force, stick);
  }


  TEST(Coulomb, SlipsAboveTheLimitAlongTheStickingForce)
  {
    const Coulomb law{0.5};
    const Vector stick({3., -4., 12.}); // |stick| = 13
    const auto result = law.tangential_force(stick, 10.);
    EXPECT_FALSE(result.sticks);
    EXPECT_LE((result.force - stick * (5. / 13.)).norm(), 1e-15);
    EXPECT_NEAR(result.force.norm(), 5., 1e-15);
  }


  TEST(Coulomb, StillSticksAtTheLimit)
  {
    const auto result = Coulomb{0.5}.tangential_force(Vector({0., 5., 0.}), 10.);
    EXPECT_TRUE(result.sticks);
    EXPECT_EQ(result.force, Vector({0., 5., 0.}));
  }


  TEST(Coulomb, DoesNothingWithoutFrictionPressureOrSlip)
  {
    const Vector stick({1., 1., 0.});
    for (const auto &[mu, normal] : {std::pair<double, double>{0., 10.}, {0.5, 0.}, {0., 0.}})
      {
        const auto result = Coulomb{mu}.tangential_force(stick, normal);
        EXPECT_EQ(result.force.norm(), 0.);
        EXPECT_FALSE(result.sticks);
        // Nothing that could stick: no force either, and no division by zero.
        EXPECT_EQ(Coulomb{mu}.tangential_force(Vector(), normal).force.norm(), 0.);
      }
    EXPECT_TRUE(Coulomb{0.5}.tangential_force(Vector(), 10.).sticks);
  }


  TEST(Coulomb, NeverExceedsTheCone)
  {
    for (const double mu : {0.1, 1., 3.})
      for (int i = -20; i <= 20; ++i)
        {
          const double normal = 2.;
          const Vector stick({0.3 * i, 0.1 * i, -0.2 * i});
          const auto result = Coulomb{mu}.tangential_force(stick, normal);
          EXPECT_LE(result.force.norm(), mu * normal * (1. + 1e-15));
          EXPECT_GE(result.force * stick, 0.);
          EXPECT_LE(cross_product_3d(result.force, stick).norm(), 1e-14);
        }
  }


  // ---------------------------------------------------------------------------------------------
  // Two cubes
  // ---------------------------------------------------------------------------------------------

  Body
  cube(const std::string &name, const Vector &position, const std::string &material)
  {
    BoxShape shape;
    shape.size  = Vector({1., 1., 1.});
    shape.cells = {{1, 1, 1}};
    Body body;
    body.name       = name;
    body.mesh.shape = shape;
    body.position   = position;
    body.rotation   = dealii::unit_symmetric_tensor<3>();
    body.material   = material;
    return body;
  }


  Material
  stuff(const std::string &name, const double density)
  {
    Material material;
    material.name    = name;
    material.density = density;
    material.law     = Hypoelastic{Elasticity::from_young(1., 0.)};
    return material;
  }


  constexpr double initial_gap = 0.01, dt = 0.1;


  // Two unit cubes a gap apart in x, nodal masses 1 ("left", slave x+) and 3 ("right", master x-),
  // of which every node flies with the velocity of its body until it meets the other one.
  struct TwoCubes
  {
    TwoCubes(const Vector &shift,
             const Vector &v_left,
             const Vector &v_right,
             const SurfaceContact &law,
             const std::vector<PrescribedMotion> &motions = {})
      : contacts({law})
      , motions(motions)
      , discretization({cube("left", Vector(), "light"),
                        cube("right", Vector({1. + initial_gap, 0., 0.}) + shift, "heavy")},
                       {stuff("light", 8.), stuff("heavy", 24.)},
                       MPI_COMM_SELF)
      , state(discretization)
      , conditions(discretization, this->motions)
      , contact(discretization, contacts, planes, conditions)
      , integrator(discretization, state, 0.)
      , velocity(discretization.make_vector())
    {
      for (unsigned int node = 0; node < discretization.n_nodes; ++node)
        for (unsigned int d = 0; d < 3; ++d)
          velocity.local_element(
            3 * node + d) = (discretization.body_of_node[node] == 0 ? v_left : v_right)[d];
      state.dt_next = dt;
      integrator.start(velocity, dt);
      resolve();
      integrator.finish_start(velocity);
    }

    void
    step()
    {
      integrator.predict();
      state.force   = 0.;
      state.dt_next = dt;
      integrator.free_increment();
      resolve();
    }

    void
    resolve()
    {
      const double c = integrator.effective_mass_factor();
      conditions.clear_reactions();
      conditions.apply(state, c);
      contact.search(state);
      free = state.dx_next;
      contact.resolve_normal(state, c);
      contact.resolve_friction(state, c);
      contact.add_increments(state, c);
      conditions.apply(state, c);
    }

    Vector
    momentum() const
    {
      Vector sum;
      for (unsigned int node = 0; node < discretization.n_nodes; ++node)
        sum += discretization.mass[node] * at_node(state.dx_next, node) / dt;
      return sum;
    }

    // G u of a pair
    Vector
    relative(const ContactPair &pair, const NodalVector &u) const
    {
      Vector result = at_node(u, pair.slave);
      for (unsigned int k = 0; k < pair.n_masters; ++k)
        result -= pair.N[k] * at_node(u, pair.masters[k]);
      return result;
    }

    // A_ii = (1/m_s + sum N_k^2/m_k)/c
    double
    delassus(const ContactPair &pair) const
    {
      double sum = 1. / discretization.mass[pair.slave];
      for (unsigned int k = 0; k < pair.n_masters; ++k)
        sum += pair.N[k] * pair.N[k] / discretization.mass[pair.masters[k]];
      return sum / integrator.effective_mass_factor();
    }

    const std::vector<SurfaceContact> contacts;
    const std::vector<RigidPlane> planes; // none
    const std::vector<PrescribedMotion> motions;
    Discretization discretization;
    NodalState state;
    EssentialConditions conditions;
    Contact contact;
    Fidcd integrator;
    NodalVector velocity, free;
  };


  SurfaceContact
  contact_law(const SurfaceContact::GapModel gap_model,
              const double mu,
              const ContactLaw::Stick stick = ContactLaw::Stick::forward)
  {
    SurfaceContact contact;
    contact.name                          = "touch";
    contact.slaves                        = {"left:x+"};
    contact.masters                       = {"right:x-"};
    contact.friction.friction_coefficient = mu;
    contact.stick                         = stick;
    contact.release_fraction              = 0.05;
    contact.gap_model                     = gap_model;
    contact.rim_tolerance                 = 0.01;
    return contact;
  }


  constexpr auto to_segment = SurfaceContact::GapModel::point_to_segment;
  constexpr auto to_point   = SurfaceContact::GapModel::point_to_point;

  // The master cube is shifted along the face: one slave node is opposite to it, at
  // (xi, eta) = (-0.2, -0.4): N = 0.6 0.7, 0.4 0.7, 0.4 0.3, 0.6 0.3 in some order.
  const Vector one_node_overlaps({0., 0.6, 0.7});


  TEST(OnePair, HasTheWeightsNormalAndGapOfTheProjection)
  {
    TwoCubes cubes(one_node_overlaps, Vector(), Vector(), contact_law(to_segment, 0.));
    ASSERT_EQ(cubes.contact.get_pairs().size(), 1u);
    const auto &pair = cubes.contact.get_pairs()[0];
    EXPECT_LE((at_node(cubes.state.x, pair.slave) - Vector({0.5, 0.5, 0.5})).norm(), 1e-15);
    ASSERT_EQ(pair.n_masters, 4u);
    std::vector<double> N(pair.N.begin(), pair.N.end());
    std::sort(N.begin(), N.end());
    const std::vector<double> expected = {0.12, 0.18, 0.28, 0.42};
    for (unsigned int k = 0; k < 4; ++k)
      EXPECT_NEAR(N[k], expected[k], 1e-14);
    EXPECT_LE((pair.normal - Vector({-1., 0., 0.})).norm(), 1e-15);
    EXPECT_NEAR(pair.gap, initial_gap, 1e-15);
    EXPECT_NEAR(pair.size, 1., 1e-15);
    EXPECT_EQ(pair.normal_force, 0.);
  }


  TEST(OnePair, ImpactClosesTheGapExactlyAndExchangesMomentum)
  {
    // Approach at 0.7: the gap of 0.01 would be overrun in the first step of 0.1.
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
    // At 0.07 the gap of 0.01 closes in the second step: m* = m/dt^2, t_n = -(n G dx_f + g)/A.
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
    for (unsigned int k = 0; k < 4; ++k)
      EXPECT_NEAR(at_node(cubes.state.dx_next, pair.masters[k])[0],
                  -0.002 + pair.N[k] * pair.normal_force * dt * dt / 3.,
                  1e-15);
    const auto report = cubes.contact.report(cubes.state);
    EXPECT_EQ(report.active_pairs, 1u);
    EXPECT_NEAR(report.forces[0][0], -pair.normal_force, 1e-15);
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
    const auto work   = cubes.contact.work(cubes.state.dx_next);
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
    for (unsigned int k = 0; k < 4; ++k)
      EXPECT_EQ(at_node(cubes.state.dx_next, pair.masters[k])[0], 0.);
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
                ASSERT_EQ(pair.n_masters, 1u);
                EXPECT_EQ(pair.N[0], 1.);
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
                    EXPECT_NEAR(at_node(cubes.state.dx_next, pair.masters[0])[0] / dt,
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
    // The slave node is put 0.02 deep at rest: 5 % of the depth is taken back in the step.
    TwoCubes cubes(one_node_overlaps, Vector(), Vector(), contact_law(to_segment, 0.));
    const unsigned int slave = cubes.contact.get_pairs()[0].slave;
    cubes.state.x.local_element(3 * slave) += initial_gap + 0.02;
    // The master face turns as its corners are pushed unevenly: gaps are linear but for 1e-9.
    double depth = 0.02;
    for (unsigned int n = 0; n < 5; ++n)
      {
        cubes.step();
        const auto &pair = cubes.contact.get_pairs()[0];
        EXPECT_NEAR(pair.gap, -depth, 1e-9) << n;
        EXPECT_GE(pair.normal * cubes.relative(pair, cubes.state.dx_next),
                  0.05 * depth * (1. - 1e-12));
        EXPECT_NEAR(cubes.contact.report(cubes.state).max_penetration, -pair.gap, 1e-15);
        depth -= pair.normal * cubes.relative(pair, cubes.state.dx_next);
      }
    EXPECT_LT(depth, 0.02 - 5. * 0.05 * 0.015);
  }


  // ---------------------------------------------------------------------------------------------
  // A cube on a rigid plane
  // ---------------------------------------------------------------------------------------------

  TEST(RigidPlane, StopsEveryNodeAtThePlaneWithFriction)
  {
    RigidPlane plane;
    plane.name                                  = "floor";
    plane.slaves                                = {"left:x+"};
    plane.friction.friction_coefficient         = 0.25;
    plane.release_fraction                      = 0.05;
    plane.point                                 = dealii::Point<3>(0.5 + initial_gap, 3., 4.);
    plane.normal                                = Vector({-1., 0., 0.});
    const std::vector<RigidPlane> planes        = {plane};
    const std::vector<SurfaceContact> contacts  = {};
    const std::vector<PrescribedMotion> motions = {};
    Discretization discretization({cube("left", Vector(), "light")},
                                  {stuff("light", 8.)},
                                  MPI_COMM_SELF);
    NodalState state(discretization);
    EssentialConditions conditions(discretization, motions);
    Contact contact(discretization, contacts, planes, conditions);
    Fidcd integrator(discretization, state, 0.);
    auto velocity = discretization.make_vector();
    for (unsigned int node = 0; node < 8; ++node)
      {
        velocity.local_element(3 * node)     = 0.7;
        velocity.local_element(3 * node + 1) = 0.4;
      }
    integrator.start(velocity, dt);
    const double c = integrator.effective_mass_factor();
    contact.search(state);
    contact.resolve_normal(state, c);
    contact.resolve_friction(state, c);
    contact.add_increments(state, c);
    ASSERT_EQ(contact.get_pairs().size(), 4u);
    const double t_n = 0.06 * 2. / (dt * dt); // A = dt^2/2 for a mass of one
    for (const auto &pair : contact.get_pairs())
      {
        EXPECT_NEAR(pair.gap, initial_gap, 1e-15);
        EXPECT_NEAR(pair.normal_force, t_n, 1e-12);
        EXPECT_LE((pair.tangential_force - Vector({0., -0.25 * t_n, 0.})).norm(), 1e-12);
        EXPECT_FALSE(pair.sticks);
        const Vector step = at_node(state.dx_next, pair.slave);
        EXPECT_LE((step - Vector({initial_gap, 0.04 - 0.25 * 0.06, 0.})).norm(), 1e-15);
      }
    const auto report = contact.report(state);
    EXPECT_LE((report.forces[0] - 4. * Vector({-t_n, -0.25 * t_n, 0.})).norm(), 1e-11);
  }
} // namespace
