#pragma once

#include <akmon/checkpoint/checkpoint.h>
#include <akmon/contact/contact_nodes.h>
#include <akmon/contact/contact_parameters.h>
#include <akmon/contact/mobility.h>
#include <akmon/contact/nodal_areas.h>
#include <akmon/contact/pair.h>
#include <akmon/contact/penalty.h>
#include <akmon/contact/search/body_motions.h>
#include <akmon/contact/search/obstacle_search.h>
#include <akmon/contact/search/rigid_touch.h>
#include <akmon/contact/search/surface_search.h>
#include <akmon/model/essential_conditions.h>
#include <akmon/model/nodal_state.h>

#include <memory>
#include <string>
#include <vector>

namespace akmon
{
  class Bonds;
  class CoupledSolver;
  class EdgeSearch;
  class FeatureSearch;

  /// What contact did at an interface, over this rank's pairs. Forces act on the surfaces named as
  /// slaves; those of an obstacle on what it touches.
  struct InterfaceReport
  {
    dealii::Tensor<1, 3> normal_force, friction_force;
    dealii::Tensor<1, 3> moment;          ///< of both about the origin; force length
    double max_penetration          = 0.; ///< length
    double max_penetration_relative = 0.; ///< over the size of the cell faces at the slave
    unsigned int sticking_pairs = 0, slipping_pairs = 0;

    dealii::Tensor<1, 3>
    force() const
    {
      return normal_force + friction_force;
    }
  };


  /// What contact did at a time level, summed or maximized over this rank's pairs.
  struct ContactReport
  {
    double max_penetration          = 0.; ///< length
    double max_penetration_relative = 0.; ///< over the size of the cell faces at the slave
    dealii::Point<3> place;               ///< of the largest relative penetration
    unsigned int deepest      = dealii::numbers::invalid_unsigned_int; ///< its slave, local number
    unsigned int active_pairs = 0;
    unsigned int sticking_pairs = 0;
    unsigned int iterations     = 0;    ///< of the coupled solver, the same on all ranks
    bool converged              = true; ///< whether it met its tolerance, the same on all ranks
    double residual             = 0.;   ///< gap violation it left, over the size of the cell faces
    double driven_penetration   = 0.;   ///< largest where motions of both sides are prescribed, so
                                        ///< that no force prevents it, over the cell size
    std::vector<InterfaceReport> interfaces;
  };


  /**
   * Frictional contact by complementary equations, forward Lagrangian (Problem 2 or 3, Algorithm 1
   * steps 2, 5 and 6): deformable surfaces and rigid bodies. Interfaces are numbered contacts
   * first, then obstacles.
   */
  class Contact
  {
  public:
    /**
     * Throws InputError for unknown surfaces and settings that exclude each other.
     * @param bodies  the rigid obstacles, which contact forces act on
     */
    Contact(const Discretization &discretization,
            const ContactSolver &solver,
            const std::vector<SurfaceContact> &contacts,
            std::vector<RigidBody> &bodies,
            const EssentialConditions &conditions);
    ~Contact();
    Contact(const Contact &) = delete;
    Contact &
    operator=(const Contact &) = delete;

    /// Step 2: pairs, normals and gaps at the positions state.x.
    void
    search(const NodalState &state);

    /**
     * Step 5: normal forces that keep every gap non-negative at the position the step reaches.
     * Decoupled: t_n = max(0, -(n . G dx_f + g)/A_ii); coupled: 0 <= t_n _|_ A t_n + n . G dx_f + g
     * >= 0. An open gap g may close; a penetration g < 0 found by the search is taken back at a
     * limited speed. With friction the coupled solver finds all forces in step 6.
     */
    void
    resolve_normal(const NodalState &state, const double effective_mass_factor);

    /**
     * Step 6: tangential forces by Coulomb's law. Decoupled, from the sticking force
     *
     *     forward: -(1/A_ii) P_tau G dx_f        central: -(2 dt'/A_ii) P_tau G (dx_f/(2 dt') + v~)
     *
     * coupled, the slip P_tau G dx vanishes or opposes a force on the friction circle, all pairs at
     * once.
     */
    void
    resolve_friction(const NodalState &state, const double effective_mass_factor);

    /// Step 7: dx = dx_f + dx_n + dx_tau (45)(66)(67); sums forces at nodes and on rigid bodies
    /// over ranks.
    void
    add_increments(NodalState &state, const double effective_mass_factor);

    /// Works of the normal and of the tangential contact forces, of bonds that hold and of bonds
    /// that fail, through an increment of this rank's nodes and of rigid bodies, per interface;
    /// energy.
    struct Work
    {
      double normal = 0., tangential = 0., holding = 0., failing = 0.;
    };
    std::vector<Work>
    works(const NodalVector &increment, RigidIncrement (RigidBody::*motion)() const) const;

    /// Whether normal forces store what they take: penalty springs.
    bool
    stores_energy() const
    {
      return solver.type == ContactSolver::Type::penalty;
    }

    /// Elastic energy of this rank's penalty springs per interface, none with other solvers;
    /// energy.
    std::vector<Work>
    stored_energies() const;

    /// What the springs that act, or may in this step, add to the largest frequency squared of the
    /// bodies, lambda_max(M^{-1}(K + K_c)) <= lambda_max(M^{-1} K) + lambda_max(M^{-1} K_c)
    /// (collective).
    PenaltyLimit
    penalty_limit();

    const Bonds &
    get_bonds() const
    {
      return *bonds;
    }

    ContactReport
    report(const NodalState &state) const;

    /// Where the report's driven penetration is: which bodies, how deep and where; empty if nowhere
    /// (collective).
    std::string
    driven_bodies(const NodalState &state) const;

    /// Seconds that this rank has worked on its pairs, their search and their forces, without
    /// waiting for others.
    double
    work_seconds() const;

    /// Extents of the contact of an interface.
    struct Patch
    {
      double area = 0.; ///< around this rank's slaves that carry a force; where both sides are
                        ///< slaves the mean of the two; length^2
      double max_pressure = 0.; ///< at a node of either side; force/length^2
    };
    std::vector<Patch>
    patches(const NodalState &state) const;

    /// Names of the interfaces, in their order.
    std::vector<std::string>
    names() const;

    /// Contact force of an interface at an owned node, as a slave and as a master; force.
    struct NodalForce
    {
      unsigned int node; ///< local number
      unsigned int interface;
      dealii::Tensor<1, 3> normal, tangential;
      bool sticks; ///< a pair that sticks has a part in it
    };

    const std::vector<NodalForce> &
    nodal_forces() const
    {
      return forces;
    }

    const std::vector<ContactPair> &
    get_pairs() const
    {
      return pairs;
    }

    /// Areas around owned nodes on contact surfaces.
    const NodalAreas &
    nodal_areas() const
    {
      return areas;
    }

    /// What the next step takes over from this one: the forces of the pairs (collective).
    void
    save(CheckpointWriter &checkpoint) const;

    /// Take it back, for the owned slaves (collective).
    void
    restore(const CheckpointReader &checkpoint);

    /**
     * Build everything anew in the next search that is kept between steps to save time. After a
     * checkpoint this makes a run go on as one that is restarted from it.
     */
    void
    forget_shortcuts();

    /// Relevant boundary faces that take part in contact.
    std::vector<BoundaryFace>
    contact_faces() const;

    /// Throws InputError naming the place and depth if bodies overlap in the initial configuration.
    void
    refuse_initial_overlap(const NodalState &state) const;

  private:
    double
    least_radius_of_searches() const;
    double
    reach_of_features(const NodalState &state, const double of_obstacles) const;
    bool
    candidates_hold(const NodalState &state, const double reach, const bool has_features);
    void
    rebuild_candidates(const NodalState &state, const double reach);
    void
    find_obstacle_pairs(const NodalState &state, const double reach);
    double
    radius_of_edges(const unsigned int interface) const;
    double
    fastest_rigid_motion(const NodalState &state) const;
    void
    add_rigid_motions(ContactNodes::Field &field,
                      RigidIncrement (RigidBody::*motion)() const) const;
    void
    warm_start();
    double
    release(const ContactPair &pair, const NodalState &state) const;
    bool
    is_driven(const ContactPair &pair) const;
    std::string
    sides_of(const ContactPair &pair, const ContactNodes::Field &body_of_node) const;
    void
    set_target_gaps(const NodalState &state);
    void
    solve_coupled(const NodalState &state);
    std::vector<double>
    friction_of_pairs(const NodalState &state) const;
    double
    least_gap(const ContactPair &pair, const NodalState &state) const;
    bool
    may_be_entered() const;
    bool
    refit_pairs();
    std::vector<Pose>
    reach();
    std::vector<ContactPair>
    follow_touches(const std::vector<Pose> &poses);
    bool
    follow_bulges(const std::vector<Pose> &poses,
                  const bool may_move,
                  std::vector<ContactPair> &joining);
    double
    follow_partners(const NodalState &state,
                    const std::vector<Pose> &poses,
                    const unsigned int round);
    void
    prefetch(const ContactPair &pair) const;
    double
    gap_tolerance(const ContactPair &pair, const bool late) const;
    static void
    count_on(ContactPair &pair, const double curvature);
    std::vector<Pose>
    reached_poses(const ContactNodes::Field *response) const;
    bool
    reached_gap(ContactPair &pair, const std::vector<Pose> &poses, double &gap) const;
    void
    push_out(const NodalState &state, const double effective_mass_factor);
    void
    add_response(const double effective_mass_factor, ContactNodes::Field &field);
    template <typename Visit>
    void
    visit_rigid_loads(const Visit &visit) const;
    void
    load_rigid_bodies();
    void
    decoupled_friction(ContactPair &pair,
                       const NodalState &state,
                       const double effective_mass_factor);
    void
    set_rigid_mobilities();
    double
    spring(const ContactPair &pair) const;
    void
    penalty_normal();
    void
    penalty_friction(const NodalState &state);
    void
    add_bond_forces(NodalState &state, const double effective_mass_factor);
    double
    friction_coefficient(const ContactPair &pair, const NodalState &state) const;
    const ContactLaw &
    law_of(const ContactPair &pair) const;

    const Discretization &discretization;
    const ContactSolver &solver;
    const std::vector<SurfaceContact> &contacts;
    const EssentialConditions &conditions;
    std::vector<RigidBody> &bodies;
    std::vector<SurfaceSearch> searches;
    std::vector<EdgeSearch> edge_searches;         ///< one per contact, or none
    std::vector<ObstacleSearch> obstacle_searches; ///< one per body
    std::vector<FeatureSearch> feature_searches;   ///< one per body, or none
    std::vector<RigidTouch> rigid_touches;         ///< of bodies that may meet
    const RigidNodes rigid_nodes;
    const std::vector<double> wave_speeds; ///< dilatational, by body; length/time
    std::vector<unsigned int> surface_nodes;
    const NodalAreas areas;
    ContactNodes nodes;
    Mobility mobility;
    const std::unique_ptr<Bonds> bonds;
    const std::unique_ptr<CoupledSolver> coupled;
    BodyMotions motions;
    double moved           = 0.; ///< how far surfaces may have approached since the last build
    double travelled       = 0.; ///< nodes may have moved against obstacles since the beginning
    double seconds_of_work = 0.; ///< but for what the coupled solver does
    bool prepared          = false;

    ContactNodes::Field x, dx, dx_free, x_reached;
    ContactNodes::Field dx_reached;  ///< increments that the last solution leads to
    ContactNodes::Field dx_followed; ///< increments by contact that gaps have been measured for
    std::vector<ContactPair> pairs, previous; ///< of this step, of the one before
    std::vector<ContactPair *> unsettled; ///< of nodes, whose gaps the last round found otherwise
    std::vector<ContactNodes::Contribution> contributions;
    std::vector<NodalForce> forces;
  };


  // visit(interface, number of the rigid node, normal, tangential load) for what this rank's pairs
  // do to rigid bodies.
  template <typename Visit>
  void
  Contact::visit_rigid_loads(const Visit &visit) const
  {
    for (const auto &pair : pairs)
      if (pair.normal_force > 0.)
        for (unsigned int k = 0; k < pair.n_nodes; ++k)
          if (pair.nodes[k] >= nodes.first_common())
            visit(pair.interface,
                  pair.nodes[k] - nodes.first_common(),
                  pair.at_node(k, pair.normal_force * pair.normal),
                  pair.at_node(k, pair.tangential_force));
  }
} // namespace akmon
