#pragma once

#include <akmon/contact/contact_nodes.h>
#include <akmon/contact/coupled/closing_pair.h>
#include <akmon/contact/mobility.h>
#include <akmon/contact/pair.h>

#include <Eigen/Core>
#include <array>
#include <vector>

namespace akmon
{
  class Bonds;

  /**
   * The Delassus operator A = G m*^{-1} G^T (65)(76) of a set of pairs, applied without being
   * assembled: forces to nodes, increments of nodes, relative increments of pairs; or as a matrix,
   * where pairs are so few that it takes less. Scaled so that
   * its diagonal along the normals is one, which preconditions the solvers: unknowns are
   * tau_i = t_i/s_i with s_i = (n . A_ii n)^{-1/2}, results are s_i times relative increments.
   * Sums are in the order of the pairs.
   */
  class Delassus
  {
  public:
    using Vector = std::vector<dealii::Tensor<1, 3>>;

    /**
     * @param pairs        the pairs to couple; their nodes are numbers in @p mobility; referred to
     * @param mobility     of the pairs' nodes; referred to
     * @param mass_factor  effective mass factor of the step
     */
    void
    reinit(const std::vector<ContactPair> &pairs,
           const Mobility &mobility,
           const double mass_factor);

    /// As a matrix, of pairs that no bonds hold. They are not referred to.
    void
    assemble(const ClosingPairs &members, const double mass_factor);

    /// Rows and columns: three for each pair, in its frame. Empty if it has not been assembled.
    const Eigen::MatrixXd &
    matrix() const
    {
      return assembled;
    }

    /// Take the constraints of bonds out of the nodes' motion. Both are referred to.
    /// @param ids  of the nodes
    void
    set_bonds(const Bonds &new_bonds, const std::vector<ContactNodes::Id> &new_ids)
    {
      bonds = &new_bonds;
      ids   = &new_ids;
    }

    /// s_i; sqrt(force/length). Zero for pairs that no normal force can move.
    const std::vector<double> &
    scale() const
    {
      return scales;
    }

    /// An upper bound of the norm of the scaled operator.
    double
    norm_bound();

    /// Rows: normal and two tangents of pair i. Forces and results of apply() are in these frames.
    const dealii::Tensor<2, 3> &
    frame(const std::size_t i) const
    {
      return frames[i];
    }

    /// y_i = s_i F_i G_i m*^{-1} sum_j G_j^T F_j^T s_j tau_j with the frames F.
    void
    apply(const Vector &tau, Vector &y);

  private:
    // What unit forces along the axes of a pair do to one of its nodes, s_i N_ik e, and the
    // increments of that node, m*^{-1} s_i N_ik e.
    struct Column
    {
      ContactNodes::Id node;
      std::array<dealii::Tensor<1, 3>, 3> force, increment;
    };

    void
    collect_columns(const ClosingPair &member);

    const std::vector<ContactPair> *pairs    = nullptr;
    const Mobility *mobility                 = nullptr;
    const Bonds *bonds                       = nullptr;
    const std::vector<ContactNodes::Id> *ids = nullptr;
    double mass_factor                       = 1.;
    std::vector<double> scales;
    std::vector<dealii::Tensor<2, 3>> frames;
    ContactNodes::Field field;
    std::vector<double> at_node; ///< sums for the bound of the norm
    Eigen::MatrixXd assembled;
    std::vector<Column> columns;      ///< of all pairs' nodes that can move
    std::vector<unsigned int> begins; ///< in columns, by pair, and one past the end
  };
} // namespace akmon
