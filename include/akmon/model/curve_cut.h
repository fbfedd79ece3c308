#pragma once

#include <akmon/model/global_mesh.h>
#include <akmon/model/partition.h>

#include <cstdint>
#include <vector>

namespace akmon
{
  /// The stretches of the space-filling curve that ranks have, and what follows from them.
  struct CurveCut
  {
    std::vector<dealii::types::global_cell_index> first_cell; ///< [rank], and the last one's end
    std::vector<dealii::types::global_dof_index> first_node;  ///< [rank], and the last one's end
    std::vector<std::vector<dealii::types::global_cell_index>>
      ghost_cells;               ///< [rank]: ascending, cells of others that touch the rank's nodes
    std::uint64_t most_work = 0; ///< of a rank, with its ghosts; thousandths of a cell's own
  };


  /**
   * Cut the curve so that all ranks have the same work: their cells, what these cost besides, and
   * their ghosts, whose forces they compute too. Which these are is known once the curve is cut;
   * the last rank has none, as lower ranks own the nodes they share.
   * @param mesh        cells and nodes in the order of the curve
   * @param extra_work  what cells cost besides their forces
   */
  CurveCut
  cut_evenly(const GlobalMesh &mesh, const ExtraWork &extra_work, const unsigned int n_ranks);
} // namespace akmon
