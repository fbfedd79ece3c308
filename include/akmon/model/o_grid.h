#pragma once

#include <deal.II/base/point.h>
#include <deal.II/grid/tria.h>

#include <array>
#include <functional>

namespace akmon
{
  /**
   * Quadrilaterals filling a disc (dim 2) or hexahedra filling a ball (dim 3) about the origin: a
   * core of n^dim cells, surrounded by layers that blend from the core's surface to the circle or
   * sphere. The core is bulged: its corners then have angles near 120 degrees, as the cells around
   * them do, where a straight-edged core would squeeze the outer cells. All nodes are explicit, so
   * no manifold is needed; those of the last layer lie on the radius up to roundoff, those in the
   * planes of symmetry exactly.
   */
  template <int dim>
  class OGrid
  {
  public:
    /// `radius` [length], `n_across` cells along an edge of the core, `n_layers` around the core.
    OGrid(double radius, unsigned int n_across, unsigned int n_layers);

    /// Make the cells whose vertices' mean fulfills `keep`.
    void
    create(dealii::Triangulation<dim> &triangulation,
           const std::function<bool(const dealii::Point<dim> &)> &keep) const;

  private:
    /// Position in the core's lattice, and the layer: 0 in and on the core.
    struct Node
    {
      std::array<unsigned int, dim> index;
      unsigned int layer;

      bool
      operator<(const Node &other) const
      {
        return layer != other.layer ? layer < other.layer : index < other.index;
      }
    };

    using CellNodes = std::array<Node, (1 << dim)>;

    dealii::Point<dim>
    position(const Node &node) const;

    /// The cell of the core whose first node is `base`, and those stacked on its faces, given to
    /// `visit`.
    void
    visit_cells_from(const std::array<unsigned int, dim> &base,
                     const std::function<void(const CellNodes &)> &visit) const;

    double radius;
    unsigned int n_across;
    unsigned int n_layers;
    double core_half_width; ///< before bulging; length
  };
} // namespace akmon
