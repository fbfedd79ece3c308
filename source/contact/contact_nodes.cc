#include <akmon/contact/contact_nodes.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <tuple>

namespace akmon
{
  using namespace dealii;

  ContactNodes::ContactNodes(const Discretization &discretization)
    : discretization(discretization), n_owned(discretization.n_owned_nodes)
  {
    reinit({});
  }


  void
  ContactNodes::reinit(std::vector<types::global_dof_index> global_nodes)
  {
    const IndexSet &owned = discretization.partitioner->locally_owned_range();
    IndexSet ghosts(owned.size());
    std::sort(global_nodes.begin(), global_nodes.end());
    global_nodes.erase(std::unique(global_nodes.begin(), global_nodes.end()), global_nodes.end());
    for (const auto node : global_nodes)
      if (!owned.is_element(3 * node))
        ghosts.add_range(3 * node, 3 * node + 3);
    ghosts.compress();
    partitioner = std::make_shared<Utilities::MPI::Partitioner>(owned,
                                                                ghosts,
                                                                discretization.communicator());
  }


  unsigned int
  ContactNodes::number(const types::global_dof_index global_node) const
  {
    return partitioner->global_to_local(3 * global_node) / 3;
  }


  void
  ContactNodes::Field::exchange(const ContactNodes &nodes, const NodalVector &owned)
  {
    const auto &partitioner = *nodes.partitioner;
    owned_values            = owned.begin();
    n_owned                 = nodes.n_owned;
    ghost_values.resize(partitioner.n_ghost_indices());
    if (Utilities::MPI::n_mpi_processes(partitioner.get_mpi_communicator()) == 1)
      return;
    std::vector<double> buffer(partitioner.n_import_indices());
    std::vector<MPI_Request> requests;
    partitioner.export_to_ghosted_array_start<double, MemorySpace::Host>(
      0,
      ArrayView<const double>(owned.begin(), 3 * n_owned),
      ArrayView<double>(buffer.data(), buffer.size()),
      ArrayView<double>(ghost_values.data(), ghost_values.size()),
      requests);
    partitioner.export_to_ghosted_array_finish<double, MemorySpace::Host>(
      ArrayView<double>(ghost_values.data(), ghost_values.size()), requests);
  }


  void
  ContactNodes::send_to_owners(std::vector<Contribution> &contributions) const
  {
    const MPI_Comm communicator = discretization.communicator();
    if (Utilities::MPI::n_mpi_processes(communicator) > 1)
    {
      static_assert(std::is_trivially_copyable_v<Contribution>);
      // The partners are those of the nodal exchange, the other way round.
      std::vector<std::vector<char>> outgoing;
      std::vector<MPI_Request> requests;
      unsigned int first = n_owned;
      const int tag      = 4711;
      for (const auto &[rank, n_entries] : partitioner->ghost_targets())
      {
        const unsigned int last = first + n_entries / 3;
        outgoing.emplace_back();
        for (auto contribution : contributions)
          if (contribution.node >= first && contribution.node < last)
          {
            contribution.node       = global_number(contribution.node);
            const char *const bytes = reinterpret_cast<const char *>(&contribution);
            outgoing.back().insert(outgoing.back().end(), bytes, bytes + sizeof(contribution));
          }
        first = last;
      }
      unsigned int target = 0;
      requests.resize(outgoing.size());
      for (const auto &[rank, n_entries] : partitioner->ghost_targets())
      {
        (void)n_entries;
        MPI_Isend(outgoing[target].data(),
                  outgoing[target].size(),
                  MPI_CHAR,
                  rank,
                  tag,
                  communicator,
                  &requests[target]);
        ++target;
      }
      contributions.erase(std::remove_if(contributions.begin(),
                                         contributions.end(),
                                         [&](const auto &c) { return !is_owned(c.node); }),
                          contributions.end());
      for (const auto &[rank, n_entries] : partitioner->import_targets())
      {
        (void)n_entries;
        MPI_Status status;
        int n_bytes = 0;
        MPI_Probe(rank, tag, communicator, &status);
        MPI_Get_count(&status, MPI_CHAR, &n_bytes);
        std::vector<Contribution> incoming(n_bytes / sizeof(Contribution));
        MPI_Recv(incoming.data(), n_bytes, MPI_CHAR, rank, tag, communicator, MPI_STATUS_IGNORE);
        for (auto &contribution : incoming)
        {
          contribution.node = number(contribution.node);
          contributions.push_back(contribution);
        }
      }
      MPI_Waitall(requests.size(), requests.data(), MPI_STATUSES_IGNORE);
    }
    std::sort(contributions.begin(), contributions.end(), [](const auto &a, const auto &b) {
      return std::tie(a.node, a.interface, a.slave) < std::tie(b.node, b.interface, b.slave);
    });
  }
} // namespace akmon
