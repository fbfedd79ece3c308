#include <akmon/contact/contact.h>
#include <akmon/time/fidcd.h>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

// Coulomb's law (8)-(11) alone, and the nodes of a cube that hit a rigid plane with friction, where
// the decoupled and the coupled solution are the same.

namespace contact_friction_test
{
  using namespace akmon;
  using Vector = dealii::Tensor<1, 3>;

  constexpr double initial_gap = 0.01, dt = 0.1;

  // ---------------------------------------------------------------------------------------------
  // Coulomb's law
  // ---------------------------------------------------------------------------------------------

  TEST(Coulomb, SticksBelowTheLimit)
  {
    const double limit = 0.5 * 10.;
    const Vector stick({3., -1., 2.}); // |stick| = 3.7417 < 0.5 * 10
    const auto result = Coulomb::tangential_force(stick, limit);
    EXPECT_TRUE(result.sticks);
    EXPECT_EQ(result.force, stick);
  }


  TEST(Coulomb, SlipsAboveTheLimitAlongTheStickingForce)
  {
    const double limit = 0.5 * 10.;
    const Vector stick({3., -4., 12.}); // |stick| = 13
    const auto result = Coulomb::tangential_force(stick, limit);
    EXPECT_FALSE(result.sticks);
    EXPECT_LE((result.force - stick * (5. / 13.)).norm(), 1e-15);
    EXPECT_NEAR(result.force.norm(), 5., 1e-15);
  }


  TEST(Coulomb, StillSticksAtTheLimit)
  {
    const auto result = Coulomb::tangential_force(Vector({0., 5., 0.}), 5.);
    EXPECT_TRUE(result.sticks);
    EXPECT_EQ(result.force, Vector({0., 5., 0.}));
  }


  TEST(Coulomb, DoesNothingWithoutFrictionPressureOrSlip)
  {
    const Vector stick({1., 1., 0.});
    for (const auto &[mu, normal] : {std::pair<double, double>{0., 10.}, {0.5, 0.}, {0., 0.}})
      {
        const auto result = Coulomb::tangential_force(stick, mu * normal);
        EXPECT_EQ(result.force.norm(), 0.);
        EXPECT_FALSE(result.sticks);
        // Nothing that could stick: no force either, and no division by zero.
        EXPECT_EQ(Coulomb::tangential_force(Vector(), mu * normal).force.norm(), 0.);
      }
    EXPECT_TRUE(Coulomb::tangential_force(Vector(), 5.).sticks);
  }


  TEST(Coulomb, NeverExceedsTheCone)
  {
    for (const double mu : {0.1, 1., 3.})
      for (int i = -20; i <= 20; ++i)
        {
          const double normal = 2.;
          const Vector stick({0.3 * i, 0.1 * i, -0.2 * i});
          const auto result = Coulomb::tangential_force(stick, mu * normal);
          EXPECT_LE(result.force.norm(), mu * normal * (1. + 1e-15));
          EXPECT_GE(result.force * stick, 0.);
          EXPECT_LE(cross_product_3d(result.force, stick).norm(), 1e-14);
        }
  }


  TEST(Coulomb, DecaysFromStaticToKinetic)
  {
    const Coulomb law{0.5, 0.2, 3.};
    EXPECT_EQ(law.coefficient(0.), 0.5);
    EXPECT_NEAR(law.coefficient(0.4), 0.2 + 0.3 * std::exp(-1.2), 1e-15);
    EXPECT_NEAR(law.coefficient(100.), 0.2, 1e-15);
    EXPECT_EQ((Coulomb{0.3, 0.3, 0.}.coefficient(7.)), 0.3);
  }


  // ---------------------------------------------------------------------------------------------
  // A cube on a rigid plane
  // ---------------------------------------------------------------------------------------------

  class CubeOnAPlane : public testing::TestWithParam<ContactSolver::Type>
  {
  };


  TEST_P(CubeOnAPlane, EveryNodeStopsWithFriction)
  {
    ContactSolver solver;
    solver.type = GetParam();
    Obstacle plane;
    plane.name              = "floor";
    plane.slaves            = {"left:x+"};
    plane.friction          = {0.25, 0.25, 0.};
    plane.shape             = std::make_shared<PlaneShape>();
    plane.start.place       = Vector({0.5 + initial_gap, 3., 4.});
    plane.start.orientation = Orientation::z_axis_to(Vector({-1., 0., 0.}));
    const SpaceTimeFunction no_gravity;
    std::vector<RigidBody> planes;
    planes.emplace_back(plane, no_gravity);
    const std::vector<SurfaceContact> contacts  = {};
    const std::vector<PrescribedMotion> motions = {};
    BoxShape shape;
    shape.size  = Vector({1., 1., 1.});
    shape.cells = {{1, 1, 1}};
    Body body;
    body.name       = "left";
    body.mesh.shape = shape;
    body.rotation   = dealii::unit_symmetric_tensor<3>();
    body.material   = "light";
    Material material;
    material.name    = "light";
    material.density = 8.; // nodal masses of one
    material.law     = Hypoelastic{Elasticity::from_young(1., 0.)};
    Discretization discretization({body}, {material}, MPI_COMM_SELF);
    NodalState state(discretization);
    EssentialConditions conditions(discretization, motions);
    Contact contact(discretization, solver, contacts, planes, conditions);
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
    EXPECT_LE((report.interfaces[0].force() - 4. * Vector({-t_n, -0.25 * t_n, 0.})).norm(), 1e-11);
  }


  INSTANTIATE_TEST_SUITE_P(Solvers,
                           CubeOnAPlane,
                           testing::Values(ContactSolver::Type::decoupled,
                                           ContactSolver::Type::coupled));
} // namespace contact_friction_test
