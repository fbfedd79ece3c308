#include <akmon/contact/contact_nodes.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <numeric>
#include <tuple>

namespace akmon
{
  using namespace dealii;

  ContactNodes::ContactNodes(const Discretization &discretization,
                             const std::vector<unsigned int> &surface_nodes,
                             const unsigned int n_common_nodes)
    : communicator(discretization.communicator())
    , parallel(Utilities::MPI::n_mpi_processes(communicator) > 1)
    , n_common(n_common_nodes)
    , owned(surface_nodes)
  {
    Id n           = owned.size();
    const Id total = Utilities::MPI::sum(n, communicator);
    MPI_Exscan(&n,
               &first_owned,
               1,
               Utilities::MPI::mpi_type_id_for_type<Id>,
               MPI_SUM,
               communicator);
    parallel = parallel && (total > 0 || n_common > 0);
    owned_indices.set_size(3 * total);
    owned_indices.add_range(3 * first_owned, 3 * (first_owned + n));

    // Ghost nodes learn their ids from their owners; doubles hold integers of this size exactly.
    NodalVector ids = discretization.make_vector();
    for (unsigned int i = 0; i < owned.size(); ++i)
      ids.local_element(3 * owned[i]) = first_owned + i;
    ids.update_ghost_values();
    ids_of_local.resize(discretization.n_nodes);
    for (unsigned int node = 0; node < discretization.n_nodes; ++node)
      ids_of_local[node] = Id(ids.local_element(3 * node));
    reinit({});
  }


  void
  ContactNodes::reinit(const std::vector<Id> &ids)
  {
    ids_of_others.clear();
    for (const Id id : ids)
      if (!owned_indices.is_element(3 * id))
        ids_of_others.push_back(id);
    std::sort(ids_of_others.begin(), ids_of_others.end());
    ids_of_others.erase(std::unique(ids_of_others.begin(), ids_of_others.end()),
                        ids_of_others.end());
    if (owned_indices.size() == 0)
      {
        // No contact at all; deal.II's ghost exchange divides by the size.
        partitioner = std::make_shared<Utilities::MPI::Partitioner>();
        return;
      }
    std::vector<Id> others;
    for (const Id id : ids_of_others)
      for (unsigned int d = 0; d < 3; ++d)
        others.push_back(3 * id + d);
    IndexSet ghosts(owned_indices.size());
    ghosts.add_indices(others.begin(), others.end());
    partitioner = std::make_shared<Utilities::MPI::Partitioner>(owned_indices,
                                                                ghosts,
                                                                communicator);
  }


  void
  ContactNodes::gather(const NodalVector &vector, Field &field) const
  {
    field.values.resize(3 * std::size_t(size()));
    for (unsigned int i = 0; i < owned.size(); ++i)
      for (unsigned int d = 0; d < 3; ++d)
        field.values[3 * i + d] = vector.local_element(3 * owned[i] + d);
    update_ghosts(field);
  }


  void
  ContactNodes::update_ghosts(Field &field) const
  {
    if (!parallel)
      return;
    const std::size_t n = 3 * owned.size();
    buffer.resize(partitioner->n_import_indices());
    std::vector<MPI_Request> requests;
    const ArrayView<double> ghosts(field.values.data() + n, 3 * std::size_t(first_common()) - n);
    partitioner->export_to_ghosted_array_start<double, MemorySpace::Host>(
      0,
      ArrayView<const double>(field.values.data(), n),
      ArrayView<double>(buffer.data(), buffer.size()),
      ghosts,
      requests);
    partitioner->export_to_ghosted_array_finish<double, MemorySpace::Host>(ghosts, requests);
  }


  void
  ContactNodes::add_to_owners(Field &field) const
  {
    if (!parallel)
      return;
    const std::size_t n = 3 * owned.size();
    buffer.resize(partitioner->n_import_indices());
    std::vector<MPI_Request> requests;
    const ArrayView<double> ghosts(field.values.data() + n, 3 * std::size_t(first_common()) - n);
    const ArrayView<double> imports(buffer.data(), buffer.size());
    partitioner->import_from_ghosted_array_start<double, MemorySpace::Host>(VectorOperation::add,
                                                                            1,
                                                                            ghosts,
                                                                            imports,
                                                                            requests);
    partitioner->import_from_ghosted_array_finish<double, MemorySpace::Host>(
      VectorOperation::add,
      ArrayView<const double>(buffer.data(), buffer.size()),
      ArrayView<double>(field.values.data(), n),
      ghosts,
      requests);
    if (n_common > 0)
      MPI_Allreduce(MPI_IN_PLACE,
                    field.values.data() + 3 * std::size_t(first_common()),
                    3 * n_common,
                    MPI_DOUBLE,
                    MPI_SUM,
                    communicator);
  }


  void
  ContactNodes::send_to_owners(std::vector<Contribution> &contributions) const
  {
    transfer_to_owners(contributions);
    begins.assign(n_owned() + 1, 0);
    for (const Contribution &contribution : contributions)
      ++begins[number(contribution.node) + 1];
    std::partial_sum(begins.begin(), begins.end(), begins.begin());
    by_node.resize(contributions.size());
    ends = begins;
    for (const Contribution &contribution : contributions)
      by_node[ends[number(contribution.node)]++] = contribution;
    contributions.swap(by_node);
    // A node has few, which are nearly sorted. Pairs of the same slave are of one rank and stay in
    // their order: std::stable_sort would ask for memory in every step.
    const auto comes_before = [](const Contribution &a, const Contribution &b) {
      return std::tie(a.interface, a.of_rigid_feature, a.slave) <
             std::tie(b.interface, b.of_rigid_feature, b.slave);
    };
    for (unsigned int node = 0; node < n_owned(); ++node)
      {
        const auto begin = contributions.begin() + begins[node],
                   end   = contributions.begin() + begins[node + 1];
        for (auto next = begin; next != end; ++next)
          std::rotate(std::upper_bound(begin, next, *next, comes_before), next, next + 1);
      }
  }
} // namespace akmon
