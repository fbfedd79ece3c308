#include <akmon/model/mesh_table.h>

#include <deal.II/base/geometry_info.h>
#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    using Corners = std::array<unsigned int, 4>;

    // Corners of a hexahedron's faces S1 to S6 in the order of Abaqus.
    constexpr std::array<std::array<unsigned int, 4>, 6> abaqus_faces = {{{{0, 1, 2, 3}},
                                                                          {{4, 7, 6, 5}},
                                                                          {{0, 4, 5, 1}},
                                                                          {{1, 5, 6, 2}},
                                                                          {{2, 6, 7, 3}},
                                                                          {{3, 7, 4, 0}}}};


    Corners
    sorted(Corners corners)
    {
      std::sort(corners.begin(), corners.end());
      return corners;
    }


    Corners
    sorted_corners_of(const CellData<2> &quadrilateral)
    {
      Corners corners;
      std::copy(quadrilateral.vertices.begin(), quadrilateral.vertices.end(), corners.begin());
      return sorted(corners);
    }


    template <std::size_t n>
    void
    refuse_repeated(const std::array<long, n> &nodes, const std::string &what)
    {
      if (std::set<long>(nodes.begin(), nodes.end()).size() < n)
        throw std::runtime_error(what + " has a node twice");
    }
  } // namespace


  void
  MeshTable::add_node(const long number, const Point<3> &place)
  {
    for (unsigned int d = 0; d < 3; ++d)
      if (!(std::abs(place[d]) < 1e100))
        throw std::runtime_error("node " + std::to_string(number) + " has no place in space");
    if (!indices.emplace(number, places.size()).second)
      throw std::runtime_error("node " + std::to_string(number) + " is there twice");
    places.push_back(place);
  }


  unsigned int
  MeshTable::index_of(const long node) const
  {
    const auto found = indices.find(node);
    if (found == indices.end())
      throw std::runtime_error("there is no node " + std::to_string(node));
    return found->second;
  }


  void
  MeshTable::add_hexahedron(const std::array<long, 8> &nodes)
  {
    refuse_repeated(nodes, "cell " + std::to_string(hexahedra.size() + 1));
    for (const long node : nodes)
      index_of(node);
    hexahedra.push_back(nodes);
  }


  void
  MeshTable::add_quadrilateral(const std::array<long, 4> &nodes, const long boundary_id)
  {
    if (boundary_id < 0 || boundary_id >= long(numbers::internal_face_boundary_id))
      return;
    refuse_repeated(nodes, "a quadrilateral");
    CellData<2> face;
    for (unsigned int v = 0; v < 4; ++v)
      face.vertices[GeometryInfo<2>::ucd_to_deal[v]] = index_of(nodes[v]);
    face.boundary_id = boundary_id;
    quadrilaterals.boundary_quads.push_back(face);
  }


  void
  MeshTable::add_other(const std::string &kind)
  {
    ++other_cells;
    kind_of_others = kind;
  }


  std::array<long, 4>
  MeshTable::face(const std::size_t hexahedron, const unsigned int number) const
  {
    std::array<long, 4> nodes;
    for (unsigned int v = 0; v < 4; ++v)
      nodes[v] = hexahedra.at(hexahedron)[abaqus_faces.at(number - 1)[v]];
    return nodes;
  }


  void
  MeshTable::check_faces() const
  {
    std::map<Corners, unsigned int> n_cells;
    for (std::size_t cell = 0; cell < hexahedra.size(); ++cell)
      for (unsigned int f = 1; f <= 6; ++f)
        {
          Corners corners;
          const auto nodes = face(cell, f);
          std::transform(nodes.begin(), nodes.end(), corners.begin(), [&](const long node) {
            return index_of(node);
          });
          if (++n_cells[sorted(corners)] > 2)
            throw std::runtime_error("more than two cells share a face of cell " +
                                     std::to_string(cell + 1));
        }
    for (const auto &quadrilateral : quadrilaterals.boundary_quads)
      {
        const auto found = n_cells.find(sorted_corners_of(quadrilateral));
        if (found == n_cells.end() || found->second != 1)
          throw std::runtime_error("a quadrilateral of boundary " +
                                   std::to_string(quadrilateral.boundary_id) +
                                   " is not on the boundary of the mesh");
      }
  }


  void
  MeshTable::make_triangulation(Triangulation<3> &triangulation) const
  {
    check_faces();
    std::vector<CellData<3>> cells;
    for (const auto &nodes : hexahedra)
      {
        cells.emplace_back();
        for (unsigned int v = 0; v < 8; ++v)
          cells.back().vertices[GeometryInfo<3>::ucd_to_deal[v]] = index_of(nodes[v]);
      }
    // The first of several at a face counts.
    SubCellData boundary;
    std::set<Corners> known;
    for (const auto &quadrilateral : quadrilaterals.boundary_quads)
      if (known.insert(sorted_corners_of(quadrilateral)).second)
        boundary.boundary_quads.push_back(quadrilateral);
    auto vertices = places;
    GridTools::delete_unused_vertices(vertices, cells, boundary);
    GridTools::invert_cells_with_negative_measure(vertices, cells);
    GridTools::consistently_order_cells(cells);
    triangulation.create_triangulation(vertices, cells, boundary);
  }
} // namespace akmon
