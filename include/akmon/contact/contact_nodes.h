#pragma once

#include <akmon/model/discretization.h>

#include <algorithm>
#include <memory>
#include <type_traits>
#include <vector>

namespace akmon
{
  /**
   * The nodes of all contact surfaces, in a numbering of their own: the owned ones in the order of
   * their local numbers, then those that this rank may meet but other ranks own. Contact works on
   * short arrays in this numbering. Ids are the same numbering over all ranks; their order is that
   * of the global node numbers and does not depend on the number of ranks.
   *
   * Behind them stand nodes that all ranks have, for the motions of rigid bodies: their values are
   * the same everywhere, and what ranks add to them is summed over all.
   */
  class ContactNodes
  {
  public:
    using Id = dealii::types::global_dof_index;

    /**
     * @param surface_nodes   owned nodes on any contact surface, sorted and unique
     * @param n_common_nodes  nodes that all ranks have
     */
    ContactNodes(const Discretization &discretization,
                 const std::vector<unsigned int> &surface_nodes,
                 const unsigned int n_common_nodes = 0);

    /// Take up nodes of other ranks by their ids (owned ones are ignored; collective).
    void
    reinit(const std::vector<Id> &ids);

    unsigned int
    n_owned() const
    {
      return owned.size();
    }

    MPI_Comm
    get_communicator() const
    {
      return communicator;
    }

    bool
    is_parallel() const
    {
      return parallel;
    }

    /// Number of owned nodes, nodes of other ranks and common nodes.
    unsigned int
    size() const
    {
      return first_common() + n_common;
    }

    /// Contact number of the first common node.
    unsigned int
    first_common() const
    {
      return owned.size() + partitioner->n_ghost_indices() / 3;
    }

    /// Id of a local node (owned or ghost of the discretization) on a contact surface.
    Id
    id_of_local(const unsigned int node) const
    {
      return ids_of_local[node];
    }

    /// Contact number of an id that is owned or was given to reinit().
    unsigned int
    number(const Id id) const
    {
      return id - first_owned < n_owned() ? static_cast<unsigned int>(id - first_owned) :
                                            partitioner->global_to_local(3 * id) / 3;
    }

    /// Local number of an owned contact node.
    unsigned int
    local_node(const unsigned int number) const
    {
      return owned[number];
    }

    Id
    id(const unsigned int number) const
    {
      return number < n_owned() ? first_owned + number : ids_of_others[number - n_owned()];
    }

    /// The same for all contact numbers: common nodes come behind all others.
    Id
    id_or_common(const unsigned int number) const
    {
      return number < first_common() ? id(number) : first_common_id() + (number - first_common());
    }

    Id
    first_common_id() const
    {
      return owned_indices.size() / 3;
    }

    /// Three components per contact node.
    class Field
    {
    public:
      dealii::Tensor<1, 3>
      operator[](const unsigned int number) const
      {
        const double *const value = &values[3 * std::size_t(number)];
        return dealii::Tensor<1, 3>({value[0], value[1], value[2]});
      }

      /// Fetch a value from memory that will be read soon.
      void
      prefetch(const unsigned int number) const
      {
        __builtin_prefetch(&values[3 * std::size_t(number)]);
      }

      void
      add(const unsigned int number, const dealii::Tensor<1, 3> &increment)
      {
        for (unsigned int d = 0; d < 3; ++d)
          values[3 * std::size_t(number) + d] += increment[d];
      }

      void
      set(const unsigned int number, const dealii::Tensor<1, 3> &value)
      {
        for (unsigned int d = 0; d < 3; ++d)
          values[3 * std::size_t(number) + d] = value[d];
      }

      void
      clear()
      {
        std::fill(values.begin(), values.end(), 0.);
      }

      /// Zeros for n nodes.
      void
      reinit(const unsigned int n)
      {
        values.assign(3 * std::size_t(n), 0.);
      }

    private:
      friend class ContactNodes;
      std::vector<double> values;
    };

    /// A field of zeros.
    void
    make(Field &field) const
    {
      field.reinit(size());
    }

    /// Values of a nodal vector at all contact nodes (collective).
    void
    gather(const NodalVector &vector, Field &field) const;

    /// Bring the owners' values to the other ranks (collective).
    void
    update_ghosts(Field &field) const;

    /// Add what other ranks have gathered for a node to its owner's value (collective).
    void
    add_to_owners(Field &field) const;

    /**
     * Bring items to the owners of their nodes, where they come in the order of ranks (collective).
     * @tparam Item  trivially copyable, with the id of a known node as member `node`
     */
    template <typename Item>
    void
    transfer_to_owners(std::vector<Item> &items) const;

    /// A force on a node that came out of a pair.
    struct Contribution
    {
      Id node;
      unsigned int interface;
      Id slave;
      bool of_rigid_feature; ///< the slave is none of a surface
      dealii::Tensor<1, 3> normal, tangential;
      bool sticks;
    };

    /**
     * Bring every contribution to the owner of its node. On return all are on owned nodes and
     * sorted by node, interface and slave, rigid bodies last: sums over them do not depend on the
     * number of ranks (collective).
     */
    void
    send_to_owners(std::vector<Contribution> &contributions) const;

  private:
    MPI_Comm communicator;
    bool parallel;
    unsigned int n_common;
    std::vector<unsigned int> owned; ///< local numbers
    Id first_owned = 0;
    std::vector<Id> ids_of_others; ///< behind the owned ones
    std::vector<Id> ids_of_local;  ///< by local node
    std::shared_ptr<dealii::Utilities::MPI::Partitioner> partitioner;
    dealii::IndexSet owned_indices;
    mutable std::vector<double> buffer;
    mutable std::vector<unsigned int> begins, ends; ///< of the contributions of owned nodes
    mutable std::vector<Contribution> by_node;
  };


  // The partners are those of the ghost exchange, the other way round.
  template <typename Item>
  void
  ContactNodes::transfer_to_owners(std::vector<Item> &items) const
  {
    static_assert(std::is_trivially_copyable_v<Item>);
    constexpr int tag = 4711;

    if (!parallel)
      return;
    const auto &targets = partitioner->ghost_targets();
    std::vector<std::vector<Item>> outgoing(targets.size());
    std::vector<MPI_Request> requests(targets.size());
    unsigned int first = n_owned();
    for (std::size_t i = 0; i < targets.size(); ++i)
      {
        const auto [rank, n_entries] = targets[i];
        const Id lowest = id(first), highest = id(first + n_entries / 3 - 1);
        first += n_entries / 3;
        for (const auto &item : items)
          if (item.node >= lowest && item.node <= highest)
            outgoing[i].push_back(item);
        MPI_Isend(outgoing[i].data(),
                  outgoing[i].size() * sizeof(Item),
                  MPI_BYTE,
                  rank,
                  tag,
                  communicator,
                  &requests[i]);
      }
    items.erase(std::remove_if(items.begin(),
                               items.end(),
                               [&](const auto &item) {
                                 return !owned_indices.is_element(3 * item.node);
                               }),
                items.end());
    for (const auto &source : partitioner->import_targets())
      {
        MPI_Status status;
        int n_bytes = 0;
        MPI_Probe(source.first, tag, communicator, &status);
        MPI_Get_count(&status, MPI_BYTE, &n_bytes);
        const std::size_t n_before = items.size();
        items.resize(n_before + n_bytes / sizeof(Item));
        MPI_Recv(items.data() + n_before,
                 n_bytes,
                 MPI_BYTE,
                 source.first,
                 tag,
                 communicator,
                 MPI_STATUS_IGNORE);
      }
    MPI_Waitall(requests.size(), requests.data(), MPI_STATUSES_IGNORE);
  }
} // namespace akmon
