#pragma once

#include <deal.II/base/point.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>

#include <array>

namespace akmon
{
  /// A hexahedron of any corners as a cell of deal.II that can be asked for its geometry.
  class HexahedronCell
  {
  public:
    HexahedronCell()
    {
      dealii::GridGenerator::hyper_cube(triangulation);
    }

    /// Move the corners, given in deal.II's order; the cell has them until the next call.
    dealii::Triangulation<3>::cell_iterator
    at(const std::array<dealii::Point<3>, 8> &corners)
    {
      const dealii::Triangulation<3>::cell_iterator cell = triangulation.begin();
      for (const unsigned int v : cell->vertex_indices())
        cell->vertex(v) = corners[v];
      return cell;
    }

  private:
    dealii::Triangulation<3> triangulation;
  };
} // namespace akmon
