#pragma once

#include <akmon/contact/contact_nodes.h>
#include <akmon/contact/mobility.h>
#include <akmon/contact/nodal_sums.h>
#include <akmon/contact/pair.h>

#include <vector>

namespace akmon
{
  class Bonds;

  /**
   * The Delassus operator A = G m*^{-1} G^T (65)(76) of a set of pairs, applied without being
   * assembled: forces to nodes, increments of nodes, relative increments of pairs. Scaled so that
   * its diagonal along the normals is one, which preconditions the solvers: unknowns are
   * tau_i = t_i/s_i with s_i = (n . A_ii n)^{-1/2}, results are s_i times relative increments.
   */
  class Delassus
  {
  public:
    using Vector = std::vector<dealii::Tensor<1, 3>>;

    /// @param bonds  whose constraints are taken out of the nodes' motion, if there are any
    Delassus(const ContactNodes &nodes, const Mobility &mobility, const Bonds *bonds = nullptr);

    /**
     * @param pairs        the pairs to couple; referred to until the next call
     * @param mass_factor  effective mass factor of the step
     */
    void
    reinit(const std::vector<ContactPair *> &pairs, const double mass_factor);

    /// s_i; sqrt(force/length). Zero for pairs that no normal force can move.
    const std::vector<double> &
    scale() const
    {
      return scales;
    }

    /// An upper bound of the norm of the scaled operator, the same on all ranks (collective).
    double
    norm_bound();

    /// Pairs whose nodes belong to no other pair and move alike in all directions: A_ii is a
    /// multiple of the identity, at least where they can move (collective).
    std::vector<bool>
    isolated_pairs();

    /// Rows: normal and two tangents of pair i. Forces and results of apply() are in these frames.
    const dealii::Tensor<2, 3> &
    frame(const std::size_t i) const
    {
      return frames[i];
    }

    /// y_i = s_i F_i G_i m*^{-1} sum_j G_j^T F_j^T s_j tau_j with the frames F (collective).
    void
    apply(const Vector &tau, Vector &y);

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
    bool
    is_bonded() const;

    const ContactNodes &nodes;
    const Mobility &mobility;
    const Bonds *const bonds;
    std::vector<ContactPair *> pairs;
    double mass_factor = 1.;
    std::vector<double> scales;
    std::vector<dealii::Tensor<2, 3>> frames;
    std::vector<unsigned int> used; ///< contact numbers the pairs touch, sorted
    ContactNodes::Field field;
    NodalSums sums;
  };


  template <typename Force>
  const ContactNodes::Field &
  Delassus::increments(const Force &force_of_pair)
  {
    clear();
    sums.add(
      pairs,
      [&](const std::size_t i, const unsigned int k) {
        return pairs[i]->at_node(k, force_of_pair(i));
      },
      field);
    forces_to_increments();
    return field;
  }
} // namespace akmon
