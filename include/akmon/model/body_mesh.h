#pragma once

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>
#include <deal.II/grid/manifold.h>
#include <deal.II/grid/tria_description.h>

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace akmon
{
  /// The curved surface a part of the boundary follows when its cells are refined.
  struct CurvedSurface
  {
    enum class Kind
    {
      cylinder,
      sphere
    };

    Kind kind;
    dealii::Point<3> center;   ///< of the sphere, or a point on the cylinder's axis; length
    dealii::Tensor<1, 3> axis; ///< unit vector along the cylinder's axis; unused for spheres

    std::unique_ptr<dealii::Manifold<3>>
    make_manifold() const;
  };

  /**
   * The coarse hexahedral mesh of one body with its named boundary parts. Every boundary face
   * carries a boundary id; a named part is a set of ids, so parts may overlap ("all" always names
   * every face).
   */
  struct BodyMesh
  {
    std::vector<dealii::Point<3>> vertices; ///< length
    std::vector<dealii::CellData<3>> cells; ///< deal.II's vertex order
    dealii::SubCellData faces;              ///< every boundary face with its id
    std::map<std::string, std::set<dealii::types::boundary_id>> parts; ///< name -> ids of its faces
    std::map<dealii::types::boundary_id, CurvedSurface>
      curved; ///< ids that follow a curved surface

    /// Rotate about the origin, then shift: x -> R x + shift.
    void
    place(const dealii::Tensor<2, 3> &rotation, const dealii::Tensor<1, 3> &shift);
  };
} // namespace akmon
