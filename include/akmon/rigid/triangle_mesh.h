#pragma once

#include <deal.II/base/tensor.h>

#include <array>
#include <string>
#include <vector>

namespace akmon
{
  /// A surface of triangles.
  struct TriangleMesh
  {
    std::vector<dealii::Tensor<1, 3>> vertices; ///< length
    std::vector<std::array<unsigned int, 3>>
      triangles; ///< numbers of their corners, counter-clockwise seen from outside

    /// Normal of a triangle, as long as twice its area.
    dealii::Tensor<1, 3>
    normal(const std::array<unsigned int, 3> &triangle) const
    {
      const auto &a = vertices[triangle[0]];
      return cross_product_3d(vertices[triangle[1]] - a, vertices[triangle[2]] - a);
    }

    /// Volume enclosed by a closed surface, negative if its normals point inward; length^3.
    double
    volume() const;
  };


  /**
   * Read an STL file, ASCII or binary; triangles share no vertices yet. Throws std::runtime_error,
   * whose text can follow the file's name, if it cannot be read.
   */
  TriangleMesh
  read_stl(const std::string &file);


  /**
   * Make a heap of triangles the surface of a solid: merge vertices that lie together, drop
   * triangles that have collapsed, and turn all normals outward, also those of cavities. Triangles
   * of zero area whose corners are distinct stay: they close the surface.
   * Returns what had to be repaired, in one line each; merging is none. Throws std::runtime_error
   * with the place if there are holes, edges with more than two triangles or no volume.
   */
  std::vector<std::string>
  make_closed(TriangleMesh &mesh);
} // namespace akmon
