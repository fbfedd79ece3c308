#pragma once

#include <akmon/contact/contact_parameters.h>
#include <akmon/contact/delassus.h>
#include <akmon/contact/pair.h>
#include <akmon/contact/projected_cg.h>

#include <vector>

namespace akmon
{
  /**
   * The coupled contact problem of a step (Problem 2, (72)-(75)). Normal forces solve the
   * complementarity problem with the full Delassus operator; friction is solved for given normal
   * forces, and both in turn until the normal forces rest. Normal forces come last, so
   * impenetrability holds to the tolerance. Constraints may repeat each other (symmetric passes):
   * forces are then not unique, increments are.
   */
  class CoupledSolver
  {
  public:
    CoupledSolver(const ContactSolver &parameters,
                  const ContactNodes &nodes,
                  const Mobility &mobility);

    /**
     * Normal forces of the pairs, warm-started from those they have; pairs that cannot close in
     * this step get none (collective).
     * @param dx_free  free increments of the step
     */
    void
    solve_normal(std::vector<ContactPair> &pairs,
                 const ContactNodes::Field &dx_free,
                 const double effective_mass_factor);

    /**
     * Tangential and normal forces of the pairs of the last solve_normal() (collective).
     * @param friction_coefficients  mu of every pair given to solve_normal()
     */
    void
    solve_friction(const ContactNodes::Field &dx_free,
                   const std::vector<double> &friction_coefficients);

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

  private:
    void
    choose_participants(std::vector<ContactPair> &pairs, const ContactNodes::Field &dx_free);
    double
    tolerance_for(const double violation) const;
    double
    complementarity(const ContactNodes::Field &dx_free);
    void
    slip(const ContactNodes::Field &dx_free, const std::vector<double> &friction_coefficients);

    // A pair that shares no node with another has a closed solution, which is exact.
    template <typename Set>
    void
    set_isolated(const Set &set,
                 const std::vector<typename Set::Unknown> &b,
                 std::vector<typename Set::Unknown> &tau) const
    {
      for (std::size_t i = 0; i < tau.size(); ++i)
        if (isolated[i])
          tau[i] = set.project(i, -1. * b[i]);
    }

    const ContactSolver &parameters;
    const ContactNodes &nodes;
    Delassus delassus;
    std::vector<ContactPair *> participants;
    std::vector<unsigned int> indices; ///< of the participants among all pairs
    std::vector<bool> isolated;
    std::vector<double> weights;
    double norm               = 0.;
    unsigned int n_iterations = 0;
    double normal_violation   = 0.; ///< without contact forces, relative to the cell size
    double last_tolerance     = 0.;
    double last_residual      = 0.;
    bool tangential_forces    = false; ///< whether any has been found in this step
  };
} // namespace akmon
