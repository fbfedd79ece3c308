#include <akmon/checkpoint/fingerprint.h>

#include <deal.II/base/mpi.h>

#include <cstring>

namespace akmon
{
  namespace
  {
    // The finalizer of the splitmix64 generator (Steele, Lea, Flood 2014,
    // doi 10.1145/2714064.2660195).
    std::uint64_t
    mix(std::uint64_t z)
    {
      z += 0x9e3779b97f4a7c15;
      z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
      z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
      return z ^ (z >> 31);
    }


    // The items of an array, each with its own number, hash to themselves; their sum does not
    // depend on the order in which they come nor on the rank that has them.
    class ItemHash
    {
    public:
      ItemHash(const std::uint64_t kind, const std::uint64_t number)
        : value(mix(mix(kind) ^ number))
      {
      }

      void
      add(const double x)
      {
        std::uint64_t bits;
        std::memcpy(&bits, &x, sizeof(bits));
        add(bits);
      }

      void
      add(const std::uint64_t bits)
      {
        value = mix(value ^ bits);
      }

      std::uint64_t value;
    };


    std::uint64_t
    sum_over_ranks(const std::uint64_t part, const MPI_Comm comm)
    {
      std::uint64_t sum = 0; // modulo 2^64
      MPI_Allreduce(&part, &sum, 1, MPI_UINT64_T, MPI_SUM, comm);
      return sum;
    }
  } // namespace


  std::uint64_t
  fingerprint(const Discretization &discretization)
  {
    std::uint64_t sum = 0;
    for (unsigned int node = 0; node < discretization.n_owned_nodes; ++node)
      {
        ItemHash hash(1, discretization.global_node(node));
        for (unsigned int d = 0; d < 3; ++d)
          hash.add(discretization.reference.local_element(3 * node + d));
        hash.add(discretization.mass[node]);
        sum += hash.value;
      }
    for (const auto &cell : discretization.cells)
      if (cell.owned)
        {
          ItemHash hash(2, cell.id);
          hash.add(std::uint64_t(cell.body));
          std::visit(
            [&](const auto &law) {
              hash.add(std::uint64_t(std::decay_t<decltype(law)>::n_internals));
            },
            discretization.material_of(cell.body).law);
          for (const unsigned int node : cell.nodes)
            hash.add(std::uint64_t(discretization.global_node(node)));
          sum += hash.value;
        }
    return sum_over_ranks(sum, discretization.communicator());
  }


  std::uint64_t
  state_hash(const Discretization &discretization,
             const NodalState &state,
             const InternalForces &internal_forces)
  {
    std::uint64_t sum = 0;
    for (unsigned int node = 0; node < discretization.n_owned_nodes; ++node)
      {
        ItemHash hash(3, discretization.global_node(node));
        for (const NodalVector *const vector : {&state.x, &state.dx, &state.dx_next})
          for (unsigned int d = 0; d < 3; ++d)
            hash.add(vector->local_element(3 * node + d));
        sum += hash.value;
      }
    for (const auto &batches : internal_forces.batches())
      for (std::size_t c = 0; c < batches.n_cells; ++c)
        {
          const auto &cell = discretization.cells[batches.first_cell + c];
          if (!cell.owned)
            continue;
          ItemHash hash(4, cell.id);
          const double *const values = batches.state_at(c / n_lanes) + c % n_lanes;
          for (unsigned int i = 0; i < batches.n_points * batches.n_components; ++i)
            hash.add(values[i * n_lanes]);
          sum += hash.value;
        }
    ItemHash hash(5, state.step);
    hash.add(state.time);
    hash.add(state.dt_next);
    return sum_over_ranks(sum, discretization.communicator()) + hash.value;
  }
} // namespace akmon
