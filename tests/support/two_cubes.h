#pragma once

#include <akmon/contact/contact.h>
#include <akmon/time/fidcd.h>

#include <set>
#include <string>
#include <vector>

namespace akmon::test::two_cubes
{
  // Two unit cubes through Contact and Fidcd. Masses fly freely: no internal forces.

  using Vector = dealii::Tensor<1, 3>;

  inline Body
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


  inline Material
  stuff(const std::string &name, const double density)
  {
    Material material;
    material.name    = name;
    material.density = density;
    material.law     = Hypoelastic{Elasticity::from_young(1., 0.)};
    return material;
  }


  inline constexpr double initial_gap = 0.01, dt = 0.1;


  inline ContactSolver
  decoupled(const double release_speed)
  {
    ContactSolver solver;
    solver.type          = ContactSolver::Type::decoupled;
    solver.release_speed = release_speed;
    return solver;
  }


  // The owned nodes of some faces, as Contact numbers them.
  inline std::vector<unsigned int>
  owned_nodes(const std::vector<BoundaryFace> &faces)
  {
    std::set<unsigned int> nodes;
    for (const auto &face : faces)
      nodes.insert(face.nodes.begin(), face.nodes.end());
    return {nodes.begin(), nodes.end()};
  }


  // Two unit cubes a gap apart in x, nodal masses 1 ("left", slave x+) and 3 ("right", master x-),
  // of which every node flies with the velocity of its body until it meets the other one.
  struct TwoCubes
  {
    TwoCubes(const Vector &shift,
             const Vector &v_left,
             const Vector &v_right,
             const SurfaceContact &law,
             const std::vector<PrescribedMotion> &motions = {},
             const double release_speed                   = 1e-4)
      : solver(decoupled(release_speed))
      , contacts({law})
      , motions(motions)
      , discretization({cube("left", Vector(), "light"),
                        cube("right", Vector({1. + initial_gap, 0., 0.}) + shift, "heavy")},
                       {stuff("light", 8.), stuff("heavy", 24.)},
                       MPI_COMM_SELF)
      , state(discretization)
      , conditions(discretization, this->motions)
      , contact(discretization, solver, contacts, no_obstacles, conditions)
      , nodes(discretization, owned_nodes(contact.contact_faces()))
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

    // Local number of a node of a pair: the slave, then the masters.
    unsigned int
    node(const ContactPair &pair, const unsigned int k) const
    {
      return nodes.local_node(pair.nodes[k]);
    }

    // G u of a pair
    Vector
    relative(const ContactPair &pair, const NodalVector &u) const
    {
      Vector result = at_node(u, pair.slave);
      for (unsigned int k = 1; k < pair.n_nodes; ++k)
        result += pair.weights[k] * at_node(u, node(pair, k));
      return result;
    }

    // A_ii = (1/m_s + sum N_k^2/m_k)/c
    double
    delassus(const ContactPair &pair) const
    {
      double sum = 0.;
      for (unsigned int k = 0; k < pair.n_nodes; ++k)
        sum += pair.weights[k] * pair.weights[k] / discretization.mass[node(pair, k)];
      return sum / integrator.effective_mass_factor();
    }

    const ContactSolver solver;
    const std::vector<SurfaceContact> contacts;
    std::vector<RigidBody> no_obstacles;
    const std::vector<PrescribedMotion> motions;
    Discretization discretization;
    NodalState state;
    EssentialConditions conditions;
    Contact contact;
    ContactNodes nodes; ///< numbered as the pairs number them
    Fidcd integrator;
    NodalVector velocity, free;
  };


  inline SurfaceContact
  contact_law(const SurfaceContact::GapModel gap_model,
              const double mu,
              const ContactLaw::Stick stick = ContactLaw::Stick::forward)
  {
    SurfaceContact contact;
    contact.name          = "touch";
    contact.slaves        = {"left:x+"};
    contact.masters       = {"right:x-"};
    contact.friction      = {mu, mu, 0.};
    contact.stick         = stick;
    contact.gap_model     = gap_model;
    contact.symmetric     = false;
    contact.rim_tolerance = 0.01;
    return contact;
  }


  inline constexpr auto to_segment = SurfaceContact::GapModel::point_to_segment;
  inline constexpr auto to_point   = SurfaceContact::GapModel::point_to_point;

  // The master cube is shifted along the face: one slave node is opposite to it, at
  // (xi, eta) = (-0.2, -0.4): N = 0.6 0.7, 0.4 0.7, 0.4 0.3, 0.6 0.3 in some order.
  inline const Vector one_node_overlaps({0., 0.6, 0.7});

  // The same at a gap that is within the reach of slaves at rest.
  inline constexpr double gap_within_reach = 0.004;
  inline const Vector overlaps_closely({gap_within_reach - initial_gap, 0.6, 0.7});
} // namespace akmon::test::two_cubes
