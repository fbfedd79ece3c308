#include <akmon/rigid/free_motion.h>
#include <akmon/rigid/rigid_shape.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

// Free motion of a rigid body: exact conservation, exact solutions, order, work.

namespace free_motion_test
{
  using namespace akmon;
  using Vector        = dealii::Tensor<1, 3>;
  constexpr double pi = dealii::numbers::PI;

  const Vector none;

  FreeMotion
  make(const Vector &size,
       const Vector &velocity,
       const Vector &spin,
       const Freedom &freedom = Freedom())
  {
    return {BlockShape(size, 0.).mass_properties(2.), freedom, Pose(), velocity, spin};
  }


  void
  advance(FreeMotion &body, const double dt, const Vector &force, const Vector &moment)
  {
    body.predict();
    body.free_increment(force, moment, dt, dt, 0.);
  }


  TEST(Rotation, MatricesAndQuaternions)
  {
    const Vector t({0.3, -0.5, 0.9});
    dealii::Tensor<2, 3> one;
    for (unsigned int d = 0; d < 3; ++d)
      one[d][d] = 1.;
    const auto half = 0.5 * cross_matrix(t);
    EXPECT_NEAR((Orientation::cayley(t).matrix() - invert(one - half) * (one + half)).norm(),
                0.,
                3e-15);
    EXPECT_NEAR((Orientation::cayley(t).cayley_vector() - t).norm(), 0., 3e-15);
    const auto quarter = Orientation::about(Vector({0., 0., 0.5 * pi}));
    EXPECT_NEAR((quarter.matrix() * Vector({1., 0., 0.}) - Vector({0., 1., 0.})).norm(), 0., 3e-15);
    const auto product = Orientation::about(t) * quarter;
    EXPECT_NEAR((product.matrix() - Orientation::about(t).matrix() * quarter.matrix()).norm(),
                0.,
                3e-15);
    EXPECT_NEAR(((product * product.inverse()).matrix() - one).norm(), 0., 3e-15);
    for (const auto &n : {Vector({0., 0., -1.}), Vector({0.6, 0., 0.8}), Vector({0., -1., 0.})})
      EXPECT_NEAR((Orientation::z_axis_to(n).matrix() * Vector({0., 0., 1.}) - n).norm(),
                  0.,
                  3e-15);
  }


  // A box thrown about its middle axis tumbles; momentum, angular momentum and energy stay.
  TEST(FreeMotion, TumblingKeepsEverything)
  {
    FreeMotion body     = make(Vector({1., 2., 3.}),
                           Vector({0.03, 0.02, 0.01}),
                           Vector({0.01, 2., 0.01}));
    constexpr double dt = 0.02;
    body.start(none, none, dt, 0.);
    const double energy = body.kinetic_energy();
    const auto momentum = body.momentum(), angular = body.angular_momentum();
    double least_y = 1., largest_error = 0.;
    for (unsigned int step = 0; step < 20000; ++step)
      {
        advance(body, dt, none, none);
        least_y       = std::min(least_y, body.pose().orientation.matrix()[1][1]);
        largest_error = std::max({largest_error,
                                  std::abs(body.kinetic_energy() / energy - 1.),
                                  (body.momentum() - momentum).norm() / momentum.norm(),
                                  (body.angular_momentum() - angular).norm() / angular.norm()});
      }
    EXPECT_LT(least_y, -0.9); // it did turn over
    EXPECT_LT(largest_error, 1e-11);
  }


  // A symmetric top without moments: its axis goes round L at L/I_across (Euler), of second order.
  TEST(FreeMotion, SymmetricTopPrecesses)
  {
    const Vector spin({1., 0., 3.});
    const auto error = [&](const double dt) {
      FreeMotion body         = make(Vector({1., 1., 2.}), none, spin);
      const auto I            = BlockShape(Vector({1., 1., 2.}), 0.).mass_properties(2.).inertia;
      const Vector L          = I * spin;
      const unsigned int last = std::lround(2. / dt);
      body.start(none, none, dt, 0.);
      for (unsigned int step = 0; step < last; ++step)
        advance(body, dt, none, none);
      const auto exact = Orientation::about((2. / I[0][0]) * L).matrix() * Vector({0., 0., 1.});
      return (body.pose().orientation.matrix() * Vector({0., 0., 1.}) - exact).norm();
    };
    EXPECT_LT(error(0.01), 2e-3);
    EXPECT_NEAR(error(0.02) / error(0.01), 4., 0.05);
  }


  TEST(FreeMotion, ConstantForceAndMoment)
  {
    constexpr double dt = 0.1;
    FreeMotion body     = make(Vector({1., 1., 1.}), Vector({0., 1., 0.}), none); // m = 2, I = 1/3
    const Vector force({0., 0., -4.}), moment({0.01, 0., 0.});
    body.start(force, moment, dt, 0.);
    for (unsigned int step = 0; step < 50; ++step)
      advance(body, dt, force, moment);
    EXPECT_NEAR((body.centre() - Vector({0., 5., -25.})).norm(), 0., 1e-12);
    EXPECT_NEAR((body.velocity() - Vector({0., 1., -10.})).norm(), 0., 1e-12);
    EXPECT_NEAR(body.spin()[0], 0.15, 1e-13);
    EXPECT_NEAR(body.angular_momentum()[0], 0.05 + 2. * (5. * -10. + 25. * 1.), 1e-11);
    // A plane motion: the angle 0.375, but for Cayley's steps.
    EXPECT_NEAR(body.pose().orientation.matrix()[2][1], std::sin(0.375), 1e-5);
  }


  // Whatever forces and moments do, the change of kinetic energy is their work.
  TEST(FreeMotion, WorkIsTheChangeOfEnergy)
  {
    std::mt19937 generator(2);
    std::uniform_real_distribution<double> number(-1., 1.);
    const auto random = [&]() {
      return Vector({number(generator), number(generator), number(generator)});
    };
    constexpr double dt = 0.05;
    FreeMotion body     = make(Vector({1., 0.7, 0.4}), random(), random());
    body.start(none, none, dt, 0.);
    body.predict();
    Vector force, moment;
    body.free_increment(force, moment, dt, dt, 0.);
    double energy = body.kinetic_energy(), work = 0.;
    for (unsigned int step = 0; step < 200; ++step)
      {
        const auto after = body.work_after();
        work             = 0.5 * (force * after.centre + moment * after.rotation);
        body.predict();
        force  = random();
        moment = random();
        body.free_increment(none, none, dt, dt, 0.);
        body.add(force, moment); // in two parts, as contact does
        const auto before = body.work_before();
        work += 0.5 * (force * before.centre + moment * before.rotation);
        EXPECT_NEAR(body.kinetic_energy() - energy, work, 1e-13);
        energy = body.kinetic_energy();
      }
  }


  TEST(FreeMotion, RespondsLinearlyToSmallForces)
  {
    constexpr double dt = 0.01, dt_next = 0.012, eta = 0.5, small = 1e-3;
    FreeMotion body = make(Vector({1., 0.7, 0.4}), none, Vector({1., 2., 3.}));
    body.start(none, none, dt, eta);
    body.predict();
    body.free_increment(none, none, dt, dt_next, eta);
    const auto free     = body.next();
    const double factor = 1. / (dt_next * 0.5 * (dt + dt_next)) + 0.5 * eta / dt_next;
    const Vector force({1., -2., 0.5}), moment({small, -small, 2. * small});
    const Pose foreseen = body.next_pose(
      {body.translation_mobility() * force / factor, body.rotation_mobility() * moment / factor});
    body.add(force, moment);
    EXPECT_NEAR((body.next_pose().place - foreseen.place).norm(), 0., 1e-16);
    EXPECT_NEAR((body.next_pose().orientation.matrix() - foreseen.orientation.matrix()).norm(),
                0.,
                1e-15);
    EXPECT_NEAR((body.next().centre - free.centre - body.translation_mobility() * force / factor)
                  .norm(),
                0.,
                1e-18);
    const auto turned = body.next().rotation - free.rotation;
    EXPECT_NEAR((turned - body.rotation_mobility() * moment / factor).norm(),
                0.,
                0.05 * turned.norm());
    // The frame reaches what it says it will.
    const Pose next = body.next_pose();
    body.predict();
    EXPECT_EQ((body.pose().place - next.place).norm(), 0.);
  }


  // v' = -eta v from v_0: central differences are of second order.
  TEST(FreeMotion, DampingSlowsDown)
  {
    const auto left = [](const double dt) {
      FreeMotion body = make(Vector({1., 1., 1.}), Vector({1., 0., 0.}), Vector({0., 0., 1.}));
      body.start(none, none, dt, 2.);
      for (unsigned int step = 0; step < std::lround(1. / dt); ++step)
        {
          body.predict();
          body.free_increment(none, none, dt, dt, 2.);
        }
      EXPECT_NEAR(body.spin()[2], body.velocity()[0], 1e-13);
      return body.velocity()[0];
    };
    EXPECT_NEAR(left(0.01), std::exp(-2.), 1e-4);
    EXPECT_NEAR((left(0.02) - std::exp(-2.)) / (left(0.01) - std::exp(-2.)), 4., 0.1);
  }


  TEST(FreeMotion, HeldDirections)
  {
    Freedom freedom;
    freedom.translation = {{false, false, true}};
    freedom.rotation    = {{true, false, false}};
    FreeMotion hinge    = make(Vector({1., 2., 3.}),
                            Vector({1., 1., 1.}),
                            Vector({1., 1., 1.}),
                            freedom);
    hinge.start(none, Vector({0., 5., 0.}), 0.1, 0.);
    for (unsigned int step = 0; step < 10; ++step)
      advance(hinge, 0.1, Vector({1., 1., 0.}), Vector({0., 5., 5.}));
    EXPECT_NEAR((hinge.velocity() - Vector({0., 0., 1.})).norm(), 0., 1e-14);
    EXPECT_NEAR((hinge.spin() - Vector({1., 0., 0.})).norm(), 0., 1e-14);
    freedom.rotation = {{false, false, false}};
    FreeMotion slide = make(Vector({1., 2., 3.}), none, Vector({1., 1., 1.}), freedom);
    EXPECT_EQ(slide.rotation_mobility().norm(), 0.);
    EXPECT_EQ(slide.translation_mobility()[0][0], 0.);
  }


  // The centre of mass is elsewhere than the frame's origin: the origin goes round it.
  TEST(FreeMotion, OffsetCentre)
  {
    MassProperties properties = BlockShape(Vector({1., 1., 1.}), 0.).mass_properties(1.);
    properties.centre         = dealii::Point<3>(1., 0., 0.);
    FreeMotion body(properties, Freedom(), Pose(), none, Vector({0., 0., 1.}));
    body.start(none, none, 1e-2, 0.);
    for (unsigned int step = 0; step < 314; ++step)
      advance(body, 1e-2, none, none);
    EXPECT_NEAR((body.centre() - Vector({1., 0., 0.})).norm(), 0., 1e-12);
    EXPECT_NEAR((body.pose().place - Vector({2., 0., 0.})).norm(), 0., 2e-3);
  }
} // namespace free_motion_test
