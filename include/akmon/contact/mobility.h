#pragma once

#include <akmon/contact/contact_nodes.h>
#include <akmon/contact/pair.h>
#include <akmon/model/essential_conditions.h>

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
    Mobility(const Discretization &discretization, const EssentialConditions &conditions);

    /// Fetch W of the nodes that other ranks own (collective).
    void
    reinit(const ContactNodes &nodes);

    dealii::SymmetricTensor<2, 3>
    operator[](const unsigned int number) const
    {
      return number < n_owned ? of_owned(number) : ghosts[number - n_owned];
    }

    /// d . A_ii d of a pair along a unit direction d, for m* = m times @p mass_factor;
    /// length/force.
    double
    along(const ContactPair &pair,
          const dealii::Tensor<1, 3> &direction,
          const double mass_factor) const;

  private:
    dealii::SymmetricTensor<2, 3>
    of_owned(const unsigned int node) const
    {
      return conditions.projector(node) / discretization.mass[node];
    }

    const Discretization &discretization;
    const EssentialConditions &conditions;
    unsigned int n_owned;
    std::vector<dealii::SymmetricTensor<2, 3>> ghosts;
  };
} // namespace akmon
