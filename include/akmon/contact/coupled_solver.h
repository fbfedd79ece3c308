#pragma once

#include <akmon/contact/contact_island.h>
#include <akmon/contact/contact_parameters.h>
#include <akmon/contact/contact_response.h>
#include <akmon/contact/pair.h>

#include <map>
#include <memory>
#include <vector>

namespace akmon
{
  /**
   * The coupled contact problem of a step (Problem 2, (72)-(75)): normal and friction forces of all
   * pairs at once with the full Delassus operator.
   *
   * An outer active set: pairs that had a force, or would penetrate without any, fall into islands
   * that share no node, each a problem of its own; pairs that their solution makes penetrate join,
   * and the islands they join are solved again, until there are none. An island is solved by the
   * rank of its first pair, so that solutions do not depend on the number of ranks. Most pairs with
   * obstacles are alone and have the closed solution of the decoupled model.
   */
  class CoupledSolver
  {
  public:
    CoupledSolver(const ContactSolver &parameters,
                  const ContactNodes &nodes,
                  const Mobility &mobility,
                  const Bonds *bonds = nullptr);

    /**
     * Take up the pairs of a step; those that cannot close in it get no force (collective).
     * @param pairs     referred to until the next call
     * @param dx_free   free increments of the step, at all contact nodes
     * @param friction  mu of every pair
     */
    void
    begin_step(std::vector<ContactPair> &pairs,
               const ContactNodes::Field &dx_free,
               const std::vector<double> &friction,
               const double effective_mass_factor);

    /// Take up the pairs of the step again after others have joined them (collective).
    void
    take_up_anew(std::vector<ContactPair> &pairs,
                 const ContactNodes::Field &dx_free,
                 const std::vector<double> &friction);

    /// Whether any pair of the step may carry friction, the same on all ranks.
    bool
    has_friction() const
    {
      return friction_somewhere;
    }

    /// Forces for the pairs' target gaps, warm-started from those they have (collective).
    void
    solve(const ContactNodes::Field &dx_free);

    /// Nodal increments that the last solution's forces cause, at all contact nodes.
    const ContactNodes::Field &
    increments() const
    {
      return response.increments();
    }

    /// Keep nothing that saves time from earlier steps.
    void
    start_afresh()
    {
      islands.clear();
    }

    /// Pairs that may close in this step.
    const std::vector<ContactPair *> &
    participants() const
    {
      return all;
    }

    /// Applications of the Delassus operator in the step so far, those of an island counted as the
    /// part of the operator that the island is; the same on all ranks.
    unsigned int
    iterations() const;

    /// Largest gap violation a solution left, relative to the cell size.
    double
    residual() const
    {
      return last_residual;
    }

    /// Whether every solution of the step met its tolerance.
    bool
    converged() const
    {
      return all_converged;
    }

  private:
    using Key = decltype(std::declval<const ContactPair &>().key());

    struct Island : ContactIsland
    {
      std::vector<const ClosingPair *> members;
      bool of_this_step = false;
      bool is_solved    = false; ///< in this step
      bool is_new       = false; ///< its solution, to the ranks of its pairs
    };

    // What a solution tells the rank of a pair.
    struct Solved
    {
      unsigned int rank, number;
      double normal_force;
      dealii::Tensor<1, 3> tangential_force;
      bool sticks;
    };

    void
    choose_participants(std::vector<ContactPair> &pairs,
                        const ContactNodes::Field &dx_free,
                        const std::vector<double> &friction);
    double
    gap_after(const ContactPair &pair,
              const ContactNodes::Field &dx_free,
              const ContactNodes::Field *caused) const;
    double
    tolerance_for(const ContactNodes::Field &dx_free) const;
    bool
    activate(const ContactNodes::Field &dx_free,
             const ContactNodes::Field *caused,
             const double tolerance);
    void
    collect_closing_pairs(const ContactNodes::Field &dx_free);
    void
    take_target_gaps();
    void
    divide_into_islands();
    bool
    is_bonded(const ClosingPair &closing) const;
    void
    solve_lone_pairs();
    void
    solve_islands(const double tolerance);
    void
    bring_forces_home();

    const ContactSolver &parameters;
    const ContactNodes &nodes;
    const Mobility &mobility;
    const Bonds *const bonds;
    ContactResponse response;
    ContactIsland::Newton newton;

    std::vector<ContactPair *> all; ///< pairs that may close
    std::vector<double> friction_of_all;
    std::vector<bool> active; ///< by number in `all`
    double mass_factor = 1.;
    bool has_begun     = false;        ///< to solve in this step
    std::vector<unsigned int> order;   ///< of the closing pairs: that they came in from the ranks
    std::vector<ClosingPair> closing;  ///< active pairs of all ranks, sorted by key
    std::vector<double> gaps;          ///< the target gaps of these
    std::vector<Solved> solved;        ///< scratch for what islands tell
    std::vector<unsigned int> last_at; ///< by node id: scratch while islands are made
    std::vector<const ClosingPair *> lone; ///< pairs of this rank that have a closed solution
    std::map<Key, std::unique_ptr<Island>> islands; ///< that this rank solves, by their first pair
    bool friction_somewhere = false;
    double n_applications   = 0.; ///< to a pair, in all islands
    double n_coupled        = 0.; ///< pairs in all islands
    double last_residual    = 0.;
    bool all_converged      = true;
  };
} // namespace akmon
