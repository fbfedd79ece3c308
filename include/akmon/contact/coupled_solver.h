#pragma once

#include <akmon/contact/contact_parameters.h>
#include <akmon/contact/delassus.h>
#include <akmon/contact/pair.h>
#include <akmon/contact/pair_preconditioner.h>
#include <akmon/contact/semismooth_newton.h>

#include <vector>

namespace akmon
{
  /**
   * The coupled contact problem of a step (Problem 2, (72)-(75)): normal and friction forces of all
   * pairs at once with the full Delassus operator. Constraints may repeat each other (symmetric
   * passes): a small compliance makes forces unique.
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

    /// Whether any pair of the step may carry friction, the same on all ranks.
    bool
    has_friction() const
    {
      return friction_somewhere;
    }

    /// Forces for the pairs' target gaps, warm-started from those they have (collective).
    void
    solve(const ContactNodes::Field &dx_free);

    /// Nodal increments that the pairs' forces cause, at all contact nodes (collective).
    const ContactNodes::Field &
    increments();

    /// Keep nothing that saves time from earlier steps.
    void
    start_afresh()
    {
      preconditioner.forget();
      iterations_when_new = 0;
    }

    /// Pairs that may close in this step.
    const std::vector<ContactPair *> &
    participants() const
    {
      return all;
    }

    /// Applications of the Delassus operator in the step so far, the same on all ranks.
    unsigned int
    iterations() const
    {
      return n_iterations;
    }

    /// Largest gap violation the last solution left, relative to the cell size.
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
    void
    choose_participants(std::vector<ContactPair> &pairs,
                        const ContactNodes::Field &dx_free,
                        const std::vector<double> &friction);
    void
    solve_alone(ContactPair &pair,
                const ContactNodes::Field &dx_free,
                const double s,
                const double friction) const;
    void
    solve_together(const ContactNodes::Field &dx_free);
    double
    tolerance_for(const double violation) const;

    const ContactSolver &parameters;
    const ContactNodes &nodes;
    Delassus delassus_of_all, delassus;
    PairPreconditioner preconditioner;
    SemismoothNewton<Delassus, PairPreconditioner> newton;
    unsigned int iterations_when_new = 0; ///< that fresh factors took

    std::vector<ContactPair *> all, coupled; ///< pairs that may close, those that share nodes
    std::vector<double> friction_of_all;
    std::vector<bool> isolated;                                      ///< by number in `all`
    SemismoothNewton<Delassus, PairPreconditioner>::Problem problem; ///< in tau_i = t_i/s_i
    Delassus::Vector tau;
    bool couples_somewhere    = false;
    bool friction_somewhere   = false;
    unsigned int n_iterations = 0;
    double last_residual      = 0.;
    bool all_converged        = true;
  };
} // namespace akmon
