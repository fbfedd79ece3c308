#pragma once

#include <akmon/forces/cell_batches.h>
#include <akmon/forces/cell_kernel.h>

namespace akmon
{
  /// Shares of a batch of cells in the nodal masses [node]; mass.
  inline void
  lump_batch_masses(const Discretization &discretization,
                    const CellBatches &batches,
                    const unsigned int batch,
                    Lanes (&mass)[8])
  {
    Lanes X[8][3];
    gather(discretization.reference.begin(), batches.nodes(batch), X);
    lump_cell_mass(X, discretization.material_of(batches.body).density, mass);
    alignas(lane_alignment) double factors[n_lanes];
    for (unsigned int lane = 0; lane < n_lanes; ++lane)
      factors[lane] = discretization.mass_factor_of(batches.index_of(batch, lane));
    for (auto &of_node : mass)
      of_node *= Lanes::load_aligned(factors);
  }
} // namespace akmon
