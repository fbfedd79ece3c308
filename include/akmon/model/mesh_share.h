#pragma once

#include <akmon/model/global_mesh.h>
#include <akmon/model/partition.h>

#include <deal.II/base/mpi.h>

#include <array>
#include <vector>

namespace akmon
{
  /// A cell whose forces this rank computes: its own, and ghosts that touch an owned node.
  struct RelevantCell
  {
    std::array<unsigned int, 8> nodes; ///< local numbers, deal.II's vertex order
    unsigned int body;
    bool owned;
    dealii::types::global_cell_index id; ///< in space-filling-curve order, any rank count
  };


  /// A boundary face of a relevant cell.
  struct BoundaryFace
  {
    std::array<unsigned int, 4> nodes; ///< local numbers, counter-clockwise seen from outside
    dealii::types::boundary_id boundary;
    dealii::types::global_cell_index id; ///< 6 * cell id + face number, the same for any rank count
    unsigned int body;
    bool owned;
    double depth;      ///< initial thickness of the cell behind the face, volume over area; length
    unsigned int cell; ///< the cell's number among the relevant ones
  };


  /// The part of the mesh that a rank computes.
  struct MeshShare
  {
    dealii::types::global_cell_index n_global_cells = 0, n_owned_cells = 0;
    dealii::types::global_dof_index n_global_nodes = 0, first_node = 0, n_owned_nodes = 0;
    std::vector<dealii::types::global_dof_index> ghost_nodes; ///< global numbers, ascending
    std::vector<dealii::Point<3>> nodes;                      ///< owned ones, then ghosts; length
    std::vector<RelevantCell> cells;                          ///< by body, then in global order
    std::vector<BoundaryFace> faces;                          ///< in global order
  };


  /**
   * Give every rank its part of the mesh that the first rank has (collective). Ranks get
   * consecutive stretches of the space-filling curve, of equal work with their ghosts
   * (cut_evenly()), and own the nodes that their cells touch first; so does any lower number of
   * ranks.
   * @param mesh        used up; looked at on the first rank only
   * @param extra_work  that ranks share besides their cells' own
   */
  MeshShare
  share_out(GlobalMesh mesh, const ExtraWork &extra_work, const MPI_Comm communicator);
} // namespace akmon
