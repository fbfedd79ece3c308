#pragma once

#include <akmon/forces/cell_batches.h>
#include <akmon/forces/cell_kernel.h>

namespace akmon
{
  /// Shares of the cells of a body, one per lane, in the nodal masses [node]; mass.
  inline void
  lump_lane_masses(const Discretization &discretization,
                   const CellBatches &batches,
                   const CellBatches::NodeOffsets &nodes,
                   const std::size_t (&cells)[n_lanes],
                   Lanes (&mass)[8])
  {
    Lanes X[8][3];
    gather(discretization.reference.begin(), nodes, X);
    lump_cell_mass(X, discretization.material_of(batches.body).density, mass);
    alignas(lane_alignment) double factors[n_lanes];
    for (unsigned int lane = 0; lane < n_lanes; ++lane)
      factors[lane] = discretization.mass_factor_of(cells[lane]);
    for (auto &of_node : mass)
      of_node *= Lanes::load_aligned(factors);
  }


  /// Shares of a batch of cells in the nodal masses [node]; mass.
  inline void
  lump_batch_masses(const Discretization &discretization,
                    const CellBatches &batches,
                    const unsigned int batch,
                    Lanes (&mass)[8])
  {
    std::size_t cells[n_lanes];
    for (unsigned int lane = 0; lane < n_lanes; ++lane)
      cells[lane] = batches.index_of(batch, lane);
    lump_lane_masses(discretization, batches, batches.nodes(batch), cells, mass);
  }
} // namespace akmon
