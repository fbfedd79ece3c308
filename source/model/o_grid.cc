#include <akmon/model/o_grid.h>

#include <deal.II/base/numbers.h>
#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace akmon
{
  namespace
  {
    // How far the core is bulged from the cube (0) to a ball (1), and the radius of that ball over
    // the cube's half width. Found by scanning 2 to 8 cells across with up to 4 layers for the best
    // smallest scaled Jacobian: at least 0.80 in discs and 0.68 in balls.
    template <int dim>
    constexpr double bulge = dim == 2 ? 0.4 : 0.5;
    template <int dim>
    constexpr double ball_ratio = dim == 2 ? 1.2 : 1.35;
  } // namespace


  template <int dim>
  OGrid<dim>::OGrid(const double radius, const unsigned int n_across, const unsigned int n_layers)
    : radius(radius)
    , n_across(n_across)
    , n_layers(n_layers)
  {
    // Cells of the core as wide as the layers are thick, as long as neither core nor layers
    // degenerate.
    const double face_height = 1 + bulge<dim> * (ball_ratio<dim> - 1);
    const double even        = 1 / (2. * n_layers / n_across + face_height);
    core_half_width          = radius * std::clamp(even, 0.3, dim == 2 ? 0.6 : 0.5);
  }


  template <int dim>
  void
  OGrid<dim>::create(dealii::Triangulation<dim> &triangulation,
                     const std::function<bool(const dealii::Point<dim> &)> &keep) const
  {
    std::vector<dealii::Point<dim>> vertices;
    std::vector<dealii::CellData<dim>> cells;
    std::map<Node, unsigned int> numbers;

    const auto add_cell = [&](const CellNodes &nodes) {
      dealii::Point<dim> mean;
      for (const auto &node : nodes)
        mean += (1. / nodes.size()) * position(node);
      if (!keep(mean))
        return;
      dealii::CellData<dim> cell;
      for (unsigned int v = 0; v < nodes.size(); ++v)
        {
          const auto [entry, is_new] = numbers.try_emplace(nodes[v], vertices.size());
          if (is_new)
            vertices.push_back(position(nodes[v]));
          cell.vertices[v] = entry->second;
        }
      cells.push_back(cell);
    };

    const unsigned int n_core = static_cast<unsigned int>(std::lround(std::pow(n_across, dim)));
    for (unsigned int c = 0; c < n_core; ++c)
      {
        std::array<unsigned int, dim> base;
        for (unsigned int d = 0, rest = c; d < dim; ++d, rest /= n_across)
          base[d] = rest % n_across;
        visit_cells_from(base, add_cell);
      }
    dealii::GridTools::consistently_order_cells(cells);
    triangulation.create_triangulation(vertices, cells, dealii::SubCellData());
  }


  template <int dim>
  void
  OGrid<dim>::visit_cells_from(const std::array<unsigned int, dim> &base,
                               const std::function<void(const CellNodes &)> &visit) const
  {
    CellNodes core;
    for (unsigned int v = 0; v < core.size(); ++v)
      {
        core[v] = {base, 0};
        for (unsigned int d = 0; d < dim; ++d)
          core[v].index[d] += (v >> d) & 1;
      }
    visit(core);

    for (unsigned int d = 0; d < dim; ++d)
      for (const unsigned int side : {0u, 1u})
        if (base[d] == (side == 0 ? 0 : n_across - 1))
          for (unsigned int layer = 0; layer < n_layers; ++layer)
            {
              // Both sheets of nodes continue the face of the core. On the lower side the outer
              // sheet is the first one in direction d, so that the cell is not turned inside out.
              CellNodes nodes = core;
              for (unsigned int v = 0; v < nodes.size(); ++v)
                {
                  nodes[v].index[d] = base[d] + side;
                  nodes[v].layer    = layer + (((v >> d) & 1) == side ? 1 : 0);
                }
              visit(nodes);
            }
  }


  template <int dim>
  dealii::Point<dim>
  OGrid<dim>::position(const Node &node) const
  {
    // Coordinates in the cube [-1,1]^dim; exactly zero in the planes of symmetry.
    dealii::Point<dim> cube;
    double shell = 0;
    for (unsigned int d = 0; d < dim; ++d)
      {
        cube[d] = (2. * node.index[d] - n_across) / n_across;
        shell   = std::max(shell, std::abs(cube[d]));
      }
    if (shell == 0)
      return cube;

    // Equal angles between rays give cells of nearly equal size on the circle or sphere.
    dealii::Point<dim> ray;
    for (unsigned int d = 0; d < dim; ++d)
      ray[d] = std::tan(dealii::numbers::PI_4 * cube[d] / shell);
    ray /= ray.norm();

    const double weight = bulge<dim> * shell * shell;
    const dealii::Point<dim> core(core_half_width *
                                  ((1 - weight) * cube + weight * ball_ratio<dim> * shell * ray));
    const double t = static_cast<double>(node.layer) / n_layers;
    return dealii::Point<dim>((1 - t) * core + t * radius * ray);
  }


  template class OGrid<2>;
  template class OGrid<3>;
} // namespace akmon
