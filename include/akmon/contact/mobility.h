#pragma once

#include <akmon/contact/contact_nodes.h>
#include <akmon/contact/pair.h>
#include <akmon/model/essential_conditions.h>

#include <utility>
#include <vector>

namespace akmon
{
  /**
   * What a unit force does to a contact node: W = P/m with the projector P on the directions in
   * which its motion is not prescribed. The Delassus operator A = G m*^{-1} G^T (65)(76) is made of
   * W / c, c the effective mass factor of the step.
   */
  class Mobility
  {
  public:
    /// Compute W of all contact nodes (collective); whenever their set has changed.
    void
    reinit(const Discretization &discretization,
           const EssentialConditions &conditions,
           const ContactNodes &nodes);

    /// Nodes in another numbering, of which the last ones are common nodes; W is to be set.
    void
    reinit(const unsigned int n_nodes, const unsigned int new_first_common)
    {
      W.resize(n_nodes);
      scalars.resize(n_nodes);
      first_common = new_first_common;
    }

    /// Number of nodes.
    unsigned int
    size() const
    {
      return W.size();
    }

    /// Set W of a node; 1/mass, or 1/inertia of the rotation of a rigid body.
    void
    set(const unsigned int number, const dealii::SymmetricTensor<2, 3> &mobility)
    {
      W[number]       = mobility;
      scalars[number] = trace(mobility) == 0. ? 0. : is_scalar(mobility) ? mobility[0][0] : neither;
    }

    /// Whether a node is common to all ranks, that is, of a rigid body.
    bool
    is_common(const unsigned int number) const
    {
      return number >= first_common;
    }

    /// Whether nothing moves a node.
    bool
    is_held(const unsigned int number) const
    {
      return scalars[number] == 0.;
    }

    dealii::SymmetricTensor<2, 3>
    operator[](const unsigned int number) const
    {
      if (scalars[number] == neither)
        return W[number];
      dealii::SymmetricTensor<2, 3> result;
      for (unsigned int d = 0; d < 3; ++d)
        result[d][d] = scalars[number];
      return result;
    }

    /// W f
    dealii::Tensor<1, 3>
    times(const dealii::Tensor<1, 3> &f, const unsigned int number) const
    {
      return scalars[number] == neither ? W[number] * f : scalars[number] * f;
    }

    /// The largest principal value of W: 1/m of a node that can move at all, else zero. An upper
    /// bound of it for common nodes.
    double
    inverse_mass(const unsigned int number) const
    {
      if (is_common(number))
        return W[number].norm();
      // W = P/m with a projector P: |W|^2 = tr P/m^2, tr W = tr P/m.
      const double trace_of_W = trace(W[number]);
      return trace_of_W > 0. ? (W[number] * W[number]) / trace_of_W : 0.;
    }

    /// Whether a node moves alike in all directions.
    bool
    is_free(const unsigned int number) const
    {
      return scalars[number] > 0.;
    }

    /// Whether what a node moves by along a normal is not coupled with the rest: the normal is
    /// free.
    bool
    is_free_along(const unsigned int number, const dealii::Tensor<1, 3> &normal) const
    {
      const auto moved = times(normal, number);
      const double w_n = normal * moved;
      return w_n > 0. && (moved - w_n * normal).norm() <= 1e-14 * w_n;
    }

    /// Whether a pair's relative motion answers to a force alike in all directions, at least in
    /// those its nodes can move in, so that A_ii is a multiple of the identity there.
    bool
    moves_alike(const ContactPair &pair) const;

    /// Whether no force between its nodes moves a pair along a unit direction.
    bool
    is_held_along(const ContactPair &pair, const dealii::Tensor<1, 3> &direction) const;

    /// d . A_ii d of a pair along a unit direction d, for m* = m times @p mass_factor;
    /// length/force.
    double
    along(const ContactPair &pair,
          const dealii::Tensor<1, 3> &direction,
          const double mass_factor) const;

  private:
    static constexpr double neither = -1.;

    static bool
    is_scalar(const dealii::SymmetricTensor<2, 3> &W_i)
    {
      return W_i[0][0] > 0. && W_i[0][0] == W_i[1][1] && W_i[1][1] == W_i[2][2] &&
             W_i[0][1] == 0. && W_i[0][2] == 0. && W_i[1][2] == 0.;
    }

    std::vector<dealii::SymmetricTensor<2, 3>> W; ///< by contact number
    // Nearly all nodes are free, and memory is what their access costs: 1/m of these, zero of those
    // that are held.
    std::vector<double> scalars;
    unsigned int first_common = 0;
  };
} // namespace akmon
