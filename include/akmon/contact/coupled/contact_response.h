#pragma once

#include <akmon/contact/contact_nodes.h>
#include <akmon/contact/mobility.h>
#include <akmon/contact/nodal_sums.h>
#include <akmon/contact/pair.h>

#include <vector>

namespace akmon
{
  class Bonds;

  /// Nodal increments m*^{-1} G^T t that the forces of contact pairs cause, bonds included.
  class ContactResponse
  {
  public:
    /// @param bonds  whose constraints are taken out of the nodes' motion, if there are any
    ContactResponse(const ContactNodes &nodes, const Mobility &mobility, const Bonds *bonds);

    /**
     * @param pairs        referred to until the next call
     * @param mass_factor  effective mass factor of the step
     */
    void
    reinit(const std::vector<ContactPair *> &pairs, const double mass_factor);

    /// For the forces the pairs have now (collective).
    void
    update();

    /// At all contact nodes, since the last update.
    const ContactNodes::Field &
    increments() const
    {
      return field;
    }

  private:
    // t of a loaded pair, and what it turns the partner by.
    struct Load
    {
      dealii::Tensor<1, 3> force, turn;
    };

    const ContactNodes &nodes;
    const Mobility &mobility;
    const Bonds *const bonds;
    std::vector<ContactPair *> pairs, loaded;
    std::vector<Load> loads; ///< of the loaded pairs
    double mass_factor = 1.;
    ContactNodes::Field field;
    NodalSums sums;
  };
} // namespace akmon
