#pragma once

#include <akmon/model/body.h>

#include <deal.II/base/point.h>
#include <deal.II/base/types.h>

#include <boost/serialization/map.hpp>
#include <boost/serialization/set.hpp>
#include <boost/serialization/string.hpp>

#include <array>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace akmon
{
  /// What is known of a body's mesh on every rank.
  struct BodyOutline
  {
    std::map<std::string, std::set<dealii::types::boundary_id>> parts; ///< boundary ids by name
    dealii::Point<3> centre; ///< volume centroid of the coarse mesh in its initial place; length

    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int)
    {
      archive &parts &centre;
    }
  };


  /**
   * All bodies as disconnected parts of one mesh of Q1 hexes. Cells are numbered body by body along
   * a space-filling curve, nodes in the order in which the cells come upon them.
   */
  struct GlobalMesh
  {
    struct Face
    {
      dealii::types::global_cell_index cell;
      unsigned int number; ///< of the face in its cell
      dealii::types::boundary_id boundary;
      double depth; ///< volume of the cell over area of the face; length
    };

    std::vector<std::array<dealii::types::global_dof_index, 8>>
      cells; ///< nodes, deal.II's vertex order
    std::vector<unsigned int> body_of_cell;
    std::vector<dealii::Point<3>> nodes; ///< length
    std::vector<Face> faces;             ///< of the boundary, in the order of cells and numbers
  };


  /**
   * Mesh the bodies by deal.II's Triangulation and number the nodes by its DoFHandler; both are
   * gone when this returns. Local to the calling rank. Throws InputError for meshes that cannot be
   * used.
   * @param outlines  of the bodies, in their order
   */
  GlobalMesh
  make_global_mesh(const std::vector<Body> &bodies, std::vector<BodyOutline> &outlines);
} // namespace akmon
