#pragma once

#include <akmon/contact/contact_nodes.h>
#include <akmon/contact/mobility.h>
#include <akmon/contact/pair.h>

#include <vector>

namespace akmon
{
  /**
   * The Delassus operator A = G m*^{-1} G^T (65)(76) of a set of pairs, applied without being
   * assembled: forces to nodes, increments of nodes, relative increments of pairs. Scaled to a unit
   * diagonal, which preconditions the solvers: unknowns are tau_i = t_i/s_i with s_i = A_ii^{-1/2},
   * results are s_i times relative increments.
   */
  class Delassus
  {
  public:
    Delassus(const ContactNodes &nodes, const Mobility &mobility);

    /**
     * @param pairs        the pairs to couple; referred to until the next call
     * @param mass_factor  effective mass factor of the step
     */
    void
    reinit(const std::vector<ContactPair *> &pairs, const double mass_factor);

    /// s_i; sqrt(force/length).
    const std::vector<double> &
    scale() const
    {
      return scales;
    }

    /// An upper bound of the norm of the scaled operator, the same on all ranks (collective).
    double
    norm_bound();

    /// Pairs none of whose nodes belongs to another pair (collective).
    std::vector<bool>
    isolated_pairs();

    /// y_i = s_i n_i . G_i m*^{-1} sum_j G_j^T n_j s_j tau_j (collective).
    void
    apply_normal(const std::vector<double> &tau, std::vector<double> &y);

    /// The same for tangential forces and relative increments in the contact planes (collective).
    void
    apply_tangential(const std::vector<dealii::Tensor<1, 3>> &tau,
                     std::vector<dealii::Tensor<1, 3>> &y);

    /// Nodal increments that forces t_i (a vector per pair, unscaled) cause, at all contact nodes
    /// (collective).
    template <typename Force>
    const ContactNodes::Field &
    increments(const Force &force_of_pair);

  private:
    void
    clear();
    void
    forces_to_increments();

    const ContactNodes &nodes;
    const Mobility &mobility;
    std::vector<ContactPair *> pairs;
    double mass_factor = 1.;
    std::vector<double> scales;
    std::vector<unsigned int> used; ///< contact numbers the pairs touch, sorted
    ContactNodes::Field field;
  };


  template <typename Force>
  const ContactNodes::Field &
  Delassus::increments(const Force &force_of_pair)
  {
    clear();
    for (std::size_t i = 0; i < pairs.size(); ++i)
      pairs[i]->distribute(force_of_pair(i), field);
    forces_to_increments();
    return field;
  }
} // namespace akmon
