#pragma once

#include <akmon/model/discretization.h>

#include <memory>
#include <vector>

namespace akmon
{
  /**
   * The nodes that contact needs on this rank: the owned ones under their local numbers, then those
   * master nodes that other ranks own. Changes only when the contact candidates change.
   */
  class ContactNodes
  {
  public:
    explicit ContactNodes(const Discretization &discretization);

    /// Take up the given global nodes (owned ones are ignored).
    void
    reinit(std::vector<dealii::types::global_dof_index> global_nodes);

    /// Contact number of a global node that is owned or was given to reinit().
    unsigned int
    number(const dealii::types::global_dof_index global_node) const;

    dealii::types::global_dof_index
    global_number(const unsigned int number) const
    {
      return partitioner->local_to_global(3 * number) / 3;
    }

    /// Number of nodes that other ranks own.
    unsigned int
    n_ghosts() const
    {
      return partitioner->n_ghost_indices() / 3;
    }

    bool
    is_owned(const unsigned int number) const
    {
      return number < n_owned;
    }

    /// A nodal quantity with three components at the contact nodes.
    class Field
    {
    public:
      /// Fetch the values of the nodes that other ranks own; owned values are read from @p owned
      /// itself.
      void
      exchange(const ContactNodes &nodes, const NodalVector &owned);

      dealii::Tensor<1, 3>
      operator[](const unsigned int number) const
      {
        const double *const value = number < n_owned ? owned_values + 3 * number
                                                     : &ghost_values[3 * (number - n_owned)];
        return dealii::Tensor<1, 3>({value[0], value[1], value[2]});
      }

    private:
      const double *owned_values = nullptr;
      unsigned int n_owned       = 0;
      std::vector<double> ghost_values;
    };

    /// A force on a node that came out of a pair.
    struct Contribution
    {
      unsigned int node; ///< contact number; at the owner: local number
      unsigned int interface;
      dealii::types::global_dof_index slave; ///< global
      dealii::Tensor<1, 3> normal, tangential;
    };

    /**
     * Bring every contribution to the owner of its node. On return all are on owned nodes and
     * sorted by node, interface and slave: sums over them do not depend on the number of ranks.
     */
    void
    send_to_owners(std::vector<Contribution> &contributions) const;

  private:
    const Discretization &discretization;
    unsigned int n_owned;
    std::shared_ptr<dealii::Utilities::MPI::Partitioner> partitioner;
  };
} // namespace akmon
