#include <akmon/contact/contact.h>
#include <akmon/time/fidcd.h>

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>
#include <set>
#include <vector>

// Problem 2 solved for all pairs at once, on two small boxes whose meshes do not match: through
// Contact and Fidcd (masses fly freely, no internal forces), and CoupledSolver alone from any
// start. What must hold: no gap lost, forces where gaps are closed only, Coulomb's law for every
// pair, momentum, and an increment that does not depend on the start although forces do.

namespace
{
  using namespace akmon;
  using Vector = dealii::Tensor<1, 3>;

  constexpr double initial_gap = 0.01, dt = 0.1;


  void
  report(const std::string &name, const double value)
  {
    std::cout << "  " << name << " " << value << std::endl;
  }


  Body
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


  Material
  stuff(const std::string &name, const double density)
  {
    Material material;
    material.name    = name;
    material.density = density;
    material.law     = Hypoelastic{Elasticity::from_young(1., 0.)};
    return material;
  }


  SurfaceContact
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
      , contact(discretization, solver, contacts, planes, conditions)
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
    const std::vector<RigidPlane> planes;        // none
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
            const auto work = boxes.contact.work(boxes.state.dx_next);
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


  // ---------------------------------------------------------------------------------------------
  // The solver alone
  // ---------------------------------------------------------------------------------------------

  // Increments of the contact nodes that a set of pairs makes for given starts of its forces.
  struct Alone
  {
    Alone(const unsigned int n, const unsigned int m)
      : boxes(n, m, 0.4, true)
      , mobility(boxes.discretization, boxes.conditions)
    {
      mobility.reinit(boxes.nodes);
      std::mt19937 random(11);
      std::normal_distribution<double> normal;
      boxes.nodes.make(dx_free);
      for (unsigned int i = 0; i < boxes.nodes.size(); ++i)
        {
          const bool left = boxes.discretization.body_of_node[boxes.nodes.local_node(i)] == 0;
          dx_free.set(i,
                      Vector({(left ? 0.03 : 0.) + 0.002 * normal(random),
                              (left ? 0.005 : 0.) + 0.002 * normal(random),
                              0.002 * normal(random)}));
        }
      boxes.contact.search(boxes.state);
    }

    std::vector<Vector>
    solve(const double start, const unsigned int seed, std::vector<ContactPair> &pairs)
    {
      std::mt19937 random(seed);
      std::uniform_real_distribution<double> uniform;
      pairs = boxes.contact.get_pairs();
      for (auto &pair : pairs)
        {
          pair.target_gap   = pair.gap;
          pair.normal_force = start * uniform(random);
        }
      CoupledSolver solver(boxes.solver, boxes.nodes, mobility);
      solver.solve_normal(pairs, dx_free, mass_factor);
      EXPECT_LE(solver.residual(), boxes.solver.tolerance);
      if (friction)
        solver.solve_friction(dx_free, std::vector<double>(pairs.size(), 0.4));
      EXPECT_LE(solver.residual(), boxes.solver.tolerance);
      iterations = solver.iterations();

      std::vector<Vector> force(boxes.nodes.size()), dx(boxes.nodes.size());
      for (const auto &pair : pairs)
        for (unsigned int k = 0; k < pair.n_nodes; ++k)
          force[pair.nodes[k]] += pair.weights[k] *
                                  (pair.normal_force * pair.normal + pair.tangential_force);
      for (unsigned int i = 0; i < dx.size(); ++i)
        dx[i] = dx_free[i] +
                force[i] / (boxes.discretization.mass[boxes.nodes.local_node(i)] * mass_factor);
      return dx;
    }

    static constexpr double mass_factor = 100.;
    Boxes boxes;
    Mobility mobility;
    ContactNodes::Field dx_free;
    bool friction           = false;
    unsigned int iterations = 0;
  };


  double
  largest_difference(const std::vector<Vector> &a, const std::vector<Vector> &b)
  {
    double result = 0.;
    for (std::size_t i = 0; i < a.size(); ++i)
      result = std::max(result, (a[i] - b[i]).norm());
    return result;
  }


  class UniqueIncrement : public testing::TestWithParam<std::pair<unsigned int, unsigned int>>
  {
  };


  TEST_P(UniqueIncrement, from_any_start_though_forces_differ)
  {
    const auto [n, m] = GetParam();
    Alone alone(n, m);
    std::vector<ContactPair> pairs, others;
    const auto expected   = alone.solve(0., 1, pairs);
    const auto iterations = alone.iterations;
    double forces = 0., largest = 0., increments = 0.;
    for (unsigned int seed = 2; seed <= 6; ++seed)
      {
        increments = std::max(increments,
                              largest_difference(alone.solve(10., seed, others), expected));
        for (std::size_t i = 0; i < pairs.size(); ++i)
          {
            largest = std::max(largest, pairs[i].normal_force);
            forces  = std::max(forces, std::abs(pairs[i].normal_force - others[i].normal_force));
          }
      }
    report("iterations from zero", iterations);
    report("difference of increments", increments);
    report("difference of forces over the largest", forces / largest);
    EXPECT_LE(increments, 1e-9);
    EXPECT_GE(forces, 1e-3 * largest);
  }


  TEST_P(UniqueIncrement, with_friction_to_the_accuracy_of_the_rounds)
  {
    const auto [n, m] = GetParam();
    Alone alone(n, m);
    alone.friction = true;
    std::vector<ContactPair> pairs, others;
    const auto expected = alone.solve(0., 1, pairs);
    double increments   = 0.;
    for (unsigned int seed = 2; seed <= 6; ++seed)
      increments = std::max(increments,
                            largest_difference(alone.solve(10., seed, others), expected));
    report("iterations", alone.iterations);
    report("difference of increments over the approach", increments / 0.03);
    for (const auto &pair : pairs)
      EXPECT_LE(pair.tangential_force.norm(), 0.4 * pair.normal_force + 1e-8);
  }


  INSTANTIATE_TEST_SUITE_P(Meshes,
                           UniqueIncrement,
                           testing::Values(std::make_pair(2u, 3u),
                                           std::make_pair(4u, 3u),
                                           std::make_pair(5u, 4u)));


  TEST(CoupledSolver, WarmStartFromTheSolutionCostsNothing)
  {
    Alone alone(4, 3);
    std::vector<ContactPair> pairs;
    alone.solve(0., 1, pairs);
    CoupledSolver solver(alone.boxes.solver, alone.boxes.nodes, alone.mobility);
    solver.solve_normal(pairs, alone.dx_free, Alone::mass_factor);
    EXPECT_LE(solver.iterations(), 2u);
  }


  TEST(CoupledSolver, LeavesOpenPairsAlone)
  {
    Alone alone(3, 2);
    auto pairs = alone.boxes.contact.get_pairs();
    for (auto &pair : pairs)
      {
        pair.target_gap   = 1.; // far away
        pair.normal_force = 3.;
      }
    CoupledSolver solver(alone.boxes.solver, alone.boxes.nodes, alone.mobility);
    solver.solve_normal(pairs, alone.dx_free, Alone::mass_factor);
    solver.solve_friction(alone.dx_free, std::vector<double>(pairs.size(), 0.4));
    EXPECT_EQ(solver.iterations(), 0u);
    for (const auto &pair : pairs)
      EXPECT_EQ(pair.normal_force, 0.);
  }
} // namespace
