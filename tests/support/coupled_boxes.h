#pragma once

#include <akmon/contact/contact.h>
#include <akmon/time/fidcd.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace akmon::test::coupled_boxes
{
  // Two small boxes whose meshes do not match, through Contact and Fidcd: masses fly freely, no
  // internal forces.

  using Vector = dealii::Tensor<1, 3>;

  inline constexpr double initial_gap = 0.01, dt = 0.1;


  inline Body
  box(const std::string &name, const Vector &position, const unsigned int n)
  {
    BoxShape shape;
    shape.size  = Vector({1., 1., 1.});
    shape.cells = {{1, n, n}};
    Body body;
    body.name       = name;
    body.mesh.shape = shape;
    body.position   = position;
    body.rotation   = dealii::unit_symmetric_tensor<3>();
    body.material   = name;
    return body;
  }


  inline Material
  stuff(const std::string &name, const double density)
  {
    Material material;
    material.name    = name;
    material.density = density;
    material.law     = Hypoelastic{Elasticity::from_young(1., 0.)};
    return material;
  }


  inline SurfaceContact
  contact_law(const double mu, const bool symmetric)
  {
    SurfaceContact contact;
    contact.name          = "touch";
    contact.slaves        = {"left:x+"};
    contact.masters       = {"right:x-"};
    contact.friction      = {mu, mu, 0.};
    contact.symmetric     = symmetric;
    contact.rim_tolerance = 0.01;
    return contact;
  }


  // Two unit boxes, n x n cells on m x m with a gap in x, of which every node flies on its own.
  struct Boxes
  {
    Boxes(const unsigned int n,
          const unsigned int m,
          const double mu,
          const bool symmetric,
          const Vector &shift = Vector())
      : contacts({contact_law(mu, symmetric)})
      , discretization({box("left", Vector(), n),
                        box("right", Vector({1. + initial_gap, 0., 0.}) + shift, m)},
                       {stuff("left", 8.), stuff("right", 24.)},
                       MPI_COMM_SELF)
      , state(discretization)
      , conditions(discretization, motions)
      , contact(discretization, solver, contacts, no_obstacles, conditions)
      , nodes(discretization, owned_nodes(contact.contact_faces()))
      , integrator(discretization, state, 0.)
      , velocity(discretization.make_vector())
    {
    }

    static std::vector<unsigned int>
    owned_nodes(const std::vector<BoundaryFace> &faces)
    {
      std::set<unsigned int> nodes;
      for (const auto &face : faces)
        nodes.insert(face.nodes.begin(), face.nodes.end());
      return {nodes.begin(), nodes.end()};
    }

    // Velocities of the bodies with some noise at every node.
    void
    start(const Vector &v_left, const Vector &v_right, const double noise, const unsigned int seed)
    {
      std::mt19937 random(seed);
      std::normal_distribution<double> normal;
      for (unsigned int node = 0; node < discretization.n_nodes; ++node)
        for (unsigned int d = 0; d < 3; ++d)
          velocity.local_element(
            3 * node + d) = (discretization.body_of_node[node] == 0 ? v_left : v_right)[d] +
                            noise * normal(random);
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
      contact.search(state);
      free = state.dx_next;
      contact.resolve_normal(state, c);
      contact.resolve_friction(state, c);
      contact.add_increments(state, c);
      nodes.gather(state.dx_next, increment);
    }

    // What a step means for the gaps, forces and slips of all pairs.
    void
    check(const double mu) const
    {
      for (const auto &pair : contact.get_pairs())
        {
          const Vector moved   = pair.relative(increment);
          const double forward = pair.normal * moved + pair.target_gap;
          EXPECT_GE(forward, -1.001e-10 * pair.size);
          EXPECT_GE(pair.normal_force, 0.);
          EXPECT_LE(pair.normal_force * std::abs(forward), 1e-8 * largest_force() * pair.size);

          const Vector slip  = pair.tangential_part(moved);
          const Vector &t    = pair.tangential_force;
          const double limit = mu * pair.normal_force;
          EXPECT_LE(std::abs(t * pair.normal), 1e-13 * (1. + t.norm()));
          EXPECT_LE(t.norm(), limit * (1. + 1e-6) + 1e-8 * largest_force());
          if (mu > 0. && pair.normal_force > 1e-6 * largest_force())
            {
              if (t.norm() < 0.999 * limit)
                {
                  EXPECT_TRUE(pair.sticks);
                  EXPECT_LE(slip.norm(), 1.001e-9 * pair.size);
                }
              else // opposes, to the change of the circle in the last round
                {
                  EXPECT_LE((limit * slip + slip.norm() * t).norm(), 1e-6 * limit * dt);
                }
            }
        }
    }

    double
    largest_force() const
    {
      double result = 0.;
      for (const auto &pair : contact.get_pairs())
        result = std::max(result, pair.normal_force);
      return result;
    }

    Vector
    momentum() const
    {
      Vector sum;
      for (unsigned int node = 0; node < discretization.n_nodes; ++node)
        sum += discretization.mass[node] * at_node(state.dx_next, node) / dt;
      return sum;
    }

    const ContactSolver solver; // as by default
    const std::vector<SurfaceContact> contacts;
    std::vector<RigidBody> no_obstacles;
    const std::vector<PrescribedMotion> motions; // none
    Discretization discretization;
    NodalState state;
    EssentialConditions conditions;
    Contact contact;
    ContactNodes nodes; ///< numbered as the pairs number them
    Fidcd integrator;
    NodalVector velocity, free;
    ContactNodes::Field increment;
  };
} // namespace akmon::test::coupled_boxes
