#pragma once

#include <akmon/checkpoint/checkpoint.h>
#include <akmon/forces/internal_forces.h>

#include <vector>

namespace akmon
{
  /**
   * Bound of the largest frequency of the assembled system, M^{-1} K u = omega^2 u with the elastic
   * stiffness on the present configuration and the lumped masses. It lies below the largest cell
   * frequency: a mesh of cubes with nu = 0.3 may take .96 h/c_d where its free cell takes .73.
   *
   * Estimated now and then by Lanczos' method; in between, the bound grows with the largest strain
   * of each step (frequency_growth) until it may be too large by a few percent. A full estimate
   * looks only at the cells S whose own bound is beyond a threshold tau below the result, and a
   * layer around them. For all others K_e <= tau M_e, hence
   *
   *     omega_max^2 <= omega_max^2(K_S + tau M_rest, M) .
   *
   * The estimates that follow look only at those cells of S that have changed since, and some
   * layers around them; for the rest the full estimate stands, and takes the place of tau.
   *
   * The method approaches the largest eigenvalue from below; the residual of the last Ritz pair is
   * added. Sums are in fixed point, so that the bound has the same bits on any number of ranks.
   */
  class AssembledFrequency
  {
  public:
    AssembledFrequency(const Discretization &discretization, InternalForces &forces);

    /**
     * Estimate omega_max^2 from all cells (collective).
     * @param x  positions, ghosted; length
     * @return   the bound, not above that of the cells; 1/time^2
     */
    double
    estimate(const NodalVector &x);

    /**
     * The bound after a step (collective).
     * @param growth            InternalForces::growth(), the largest of all ranks
     * @param largest_of_cells  bound of all cells on all ranks, 1/time^2
     */
    double
    follow(const NodalVector &x,
           const InternalForces::Growth &growth,
           const double largest_of_cells);

    /// Of the last follow() or estimate(); 1/time^2.
    double
    bound() const
    {
      return latest;
    }

    /// Estimates made so far.
    unsigned long
    n_estimates() const
    {
      return estimates;
    }

    /// Applications of a cell's stiffness by this rank in all estimates so far.
    unsigned long
    n_applications() const
    {
      return applications;
    }

    void
    save(CheckpointWriter &checkpoint) const;
    void
    restore(const CheckpointReader &checkpoint);

  private:
    /// Vectors of Lanczos' method, nodes of the cells S only.
    struct Work;

    double
    estimate_of_all(const NodalVector &x);
    double
    estimate_anew(const NodalVector &x);
    double
    largest_of_cells() const;
    unsigned long
    watch(const bool changed_only, const unsigned int n_layers);
    void
    add_layer();
    double
    largest_ritz_value(const NodalVector &x, const double outside, const double largest);
    void
    start_vector(Work &work) const;
    void
    apply(const NodalVector &x, Work &work);
    void
    collect_nodes(Work &work) const;

    const Discretization &discretization;
    InternalForces &forces;
    double of_all              = 0.; ///< by the last full estimate, 1/time^2; zero: none yet
    double of_changed          = 0.; ///< by the last estimate; 1/time^2
    double growth_since        = 1.; ///< factor by which that may have grown
    double latest              = 0.; ///< the bound; 1/time^2
    unsigned long estimates    = 0;
    unsigned long applications = 0;
  };
} // namespace akmon
