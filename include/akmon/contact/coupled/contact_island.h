#pragma once

#include <akmon/contact/contact_parameters.h>
#include <akmon/contact/coupled/closing_pair.h>
#include <akmon/contact/coupled/delassus.h>
#include <akmon/contact/coupled/newton_lanes.h>
#include <akmon/contact/coupled/pair_preconditioner.h>
#include <akmon/contact/coupled/semismooth_newton.h>
#include <akmon/contact/mobility.h>

#include <vector>

namespace akmon
{
  class Bonds;

  /**
   * Contact pairs that share nodes, directly or through others, and with them a problem that no
   * other pair takes part in: (72)-(75) for their forces, in a numbering of their nodes of its own.
   * Constraints may repeat each other: a small compliance makes forces unique.
   */
  class ContactIsland
  {
  public:
    using Newton = SemismoothNewton<Delassus, PairPreconditioner>;

    /// @param members  referred to until the next call
    void
    set_members(const ClosingPairs &new_members)
    {
      members = new_members;
    }

    const ClosingPairs &
    get_members() const
    {
      return members;
    }

    /**
     * Begin with the forces that the members have. Factors of earlier ones are kept.
     * @param first_common_id  of nodes of rigid bodies
     * @param bonds            that hold any of the nodes, if there are such
     */
    void
    reinit(const ContactNodes::Id first_common_id,
           const Bonds *bonds,
           const double effective_mass_factor);

    /**
     * Take up the members' free motions and target gaps.
     * @param tolerance  relative to the cell size
     */
    void
    pose(const ContactSolver &parameters, const double tolerance);

    /// Find forces for what was posed.
    void
    solve(const ContactSolver &parameters, Newton &newton);

    /// Whether the problem may be one of several that are solved side by side.
    bool
    fits_lane() const
    {
      return delassus.matrix().size() > 0 && members.size() <= NewtonLanes::most_pairs &&
             problem.limit > 2 * NewtonLanes::most_steps;
    }

    /// The problem, to be solved side by side with others.
    NewtonLanes::Problem
    lane()
    {
      return {&delassus.matrix(), &problem, &tau};
    }

    /// Take the solution of such a problem.
    void
    take(const NewtonLanes::Problem &lane);

    /// Whether the last solution is for the members' target gaps.
    bool
    is_solved() const;

    /// Of the last solution, in the order of the members.
    const std::vector<PairForce> &
    get_forces() const
    {
      return forces;
    }

    /// Of the last solution.
    const Newton::Result &
    get_result() const
    {
      return result;
    }

  private:
    // A residual that the rounding of constraints that repeat each other explains.
    static constexpr double nearly = 1e-8;

    // Pairs: of rigid bodies, whose matrix is assembled; and where Newton steps need a better
    // start, which takes the matrix.
    static constexpr std::size_t most_of_rigid_bodies = 32, most_restarted = 64;

    bool
    has_rigid_bodies(const ContactNodes::Id first_common_id) const;
    void
    assemble();
    void
    number_nodes(const ContactNodes::Id first_common_id);
    void
    start_elsewhere(const unsigned int limit, Newton &newton);
    void
    take_forces();
    double
    residual();
    double
    largest_overlap();
    void
    let_slip(const unsigned int limit, Newton &newton);
    void
    solve_one_by_one();

    ClosingPairs members;
    double mass_factor = 1.;
    bool has_bonds     = false;
    std::vector<ContactPair> pairs; ///< with numbers of the island, if the operator is no matrix
    std::vector<ContactNodes::Id> ids;
    Mobility mobility;
    Delassus delassus;
    PairPreconditioner preconditioner;
    unsigned int iterations_when_new = 0; ///< that fresh factors took
    FrictionalProblem problem;            ///< in tau_i = t_i/s_i
    Delassus::Vector tau;
    std::vector<CoulombFace> faces;
    Newton::Result result{};
    std::vector<double> solved_gaps; ///< target gaps of the last solution
    std::vector<PairForce> forces;
  };
} // namespace akmon
