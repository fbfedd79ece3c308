#pragma once

#include <deal.II/base/mpi.h>

#include <type_traits>
#include <vector>

namespace akmon
{
  /// The items of all ranks, one rank after another (collective).
  template <typename Item>
  std::vector<Item>
  gather(const std::vector<Item> &own, const MPI_Comm communicator)
  {
    static_assert(std::is_trivially_copyable_v<Item>);

    const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(communicator);
    if (n_ranks == 1)
      return own;
    std::vector<int> sizes(n_ranks), offsets(n_ranks);
    const int size = own.size() * sizeof(Item);
    MPI_Allgather(&size, 1, MPI_INT, sizes.data(), 1, MPI_INT, communicator);
    for (unsigned int rank = 1; rank < n_ranks; ++rank)
      offsets[rank] = offsets[rank - 1] + sizes[rank - 1];
    std::vector<Item> all((offsets.back() + sizes.back()) / sizeof(Item));
    MPI_Allgatherv(own.data(),
                   size,
                   MPI_BYTE,
                   all.data(),
                   sizes.data(),
                   offsets.data(),
                   MPI_BYTE,
                   communicator);
    return all;
  }
} // namespace akmon
