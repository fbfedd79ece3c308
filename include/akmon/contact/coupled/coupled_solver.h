#pragma once

#include <akmon/contact/contact_parameters.h>
#include <akmon/contact/coupled/contact_island.h>
#include <akmon/contact/coupled/contact_response.h>
#include <akmon/contact/coupled/united_sets.h>
#include <akmon/contact/pair.h>

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
   * and the islands they join are solved again, until there are none. Every island is solved by
   * one rank, so that solutions do not depend on the number of ranks: by the one whose nodes it is
   * on, without communication, or by that of its first pair. Most pairs with obstacles are alone
   * and have the closed solution of the decoupled model.
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
     * @param dx_free   free increments of the step, at all contact nodes; the same
     * @param friction  mu of every pair
     */
    void
    begin_step(std::vector<ContactPair> &pairs,
               const ContactNodes::Field &dx_free,
               const std::vector<double> &friction,
               const double effective_mass_factor);

    /// Take up the pairs of the step again after others have joined them (collective).
    void
    take_up_anew(std::vector<ContactPair> &pairs, const std::vector<double> &friction);

    /// Whether any pair of the step may carry friction, the same on all ranks.
    bool
    has_friction() const
    {
      return friction_somewhere;
    }

    /// Forces for the pairs' target gaps, warm-started from those they have (collective).
    void
    solve();

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

    /// Seconds that this rank has worked on islands, without waiting for others.
    double
    work_seconds() const
    {
      return seconds_of_work;
    }

    /// Whether every solution of the step met its tolerance.
    bool
    converged() const
    {
      return all_converged;
    }

  private:
    struct Island : ContactIsland
    {
      ContactPair::Key key; ///< of its first pair
      bool of_this_step = false;
      bool is_new       = false; ///< its solution, to the ranks of its pairs
    };

    // What a solution tells the rank of a pair.
    struct Solved
    {
      unsigned int rank, number;
      PairForce force;
    };

    void
    choose_participants(std::vector<ContactPair> &pairs, const std::vector<double> &friction);
    double
    gap_after(const ContactPair &pair, const ContactNodes::Field *caused) const;
    double
    tolerance_for() const;
    bool
    activate(const ContactNodes::Field *caused, const double tolerance);
    template <typename VisitNodes>
    UnitedSets
    unite(const unsigned int n_pairs, const std::size_t n_nodes, const VisitNodes &visit_nodes);
    void
    divide_into_islands();
    void
    collect_own_pairs();
    void
    divide_own_pairs();
    bool
    is_bonded(const ContactPair &pair) const;
    void
    append_closing_pair(const unsigned int number,
                        const bool bonded,
                        std::vector<ClosingPair> &pairs) const;
    void
    divide_shared_pairs();
    void
    make_island(std::vector<std::unique_ptr<Island>>::iterator &old);
    void
    take_target_gaps();
    void
    solve_lone_pairs();
    void
    solve_islands(const double tolerance);
    void
    solve_side_by_side(Island *const *begin, Island *const *end);
    void
    count_solutions();
    void
    bring_forces_home();

    const ContactSolver &parameters;
    const ContactNodes &nodes;
    const Mobility &mobility;
    const Bonds *const bonds;
    const unsigned int rank;
    ContactResponse response;
    ContactIsland::Newton newton;
    NewtonLanes lanes;

    const ContactNodes::Field *free_increments = nullptr; ///< of the step
    std::vector<ContactPair *> all;                       ///< pairs that may close
    std::vector<double> friction_of_all;
    std::vector<bool> active; ///< by number in `all`
    double mass_factor = 1.;
    bool has_begun     = false; ///< to solve in this step

    std::vector<unsigned int> lone;     ///< pairs that have a closed solution, by number in `all`
    std::vector<ClosingPair> closing;   ///< in islands that no other rank has a part in
    std::vector<ClosingPair> shared;    ///< in islands that others may have a part in
    std::vector<SentPair> of_all_ranks; ///< these of all ranks, one rank after another
    std::vector<unsigned int> order;    ///< of these, by key
    std::vector<std::unique_ptr<Island>> islands; ///< that this rank solves, sorted by key
    std::vector<std::unique_ptr<Island>> old_islands;

    struct Meeting
    {
      ContactNodes::Id node;
    };

    struct LastPair
    {
      unsigned long division = 0; ///< of pairs into islands: 1, 2, ...
      unsigned int pair      = 0;
    };

    // Scratch.
    std::vector<Meeting> met;        ///< nodes of other ranks in active pairs
    std::vector<bool> met_by_others; ///< by owned node
    std::vector<unsigned int> own;   ///< active pairs, by number in `all`
    std::vector<bool> bonded;        ///< the same
    std::vector<SentPair> to_send;
    ClosingPairs members;          ///< of the island in work
    std::vector<LastPair> last_at; ///< by node
    unsigned long n_divisions = 0;
    std::vector<double> gaps;
    std::vector<Solved> solved;
    std::vector<Island *> small;                ///< islands to be solved side by side
    std::vector<NewtonLanes::Problem> problems; ///< theirs

    bool friction_somewhere = false;
    double n_applications   = 0.; ///< to a pair, in all islands
    double n_coupled        = 0.; ///< pairs in all islands
    double last_residual    = 0.;
    bool all_converged      = true;
    double seconds_of_work  = 0.;
  };
} // namespace akmon
