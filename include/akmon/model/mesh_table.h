#pragma once

#include <deal.II/grid/tria.h>

#include <array>
#include <cstddef>
#include <istream>
#include <string>
#include <unordered_map>
#include <vector>

namespace akmon
{
  /**
   * What a mesh file says: nodes by number, hexahedra and boundary quadrilaterals with their
   * corners in the order that Gmsh, Abaqus, VTK and UCD share. deal.II's readers are not made for
   * damaged files (indices and counts are checked in debug mode only), so files are read into this
   * table, which checks all of it.
   */
  class MeshTable
  {
  public:
    /// Throws std::runtime_error for a number that is there twice and for places at infinity.
    void
    add_node(const long number, const dealii::Point<3> &place);

    /// Throws std::runtime_error for absent nodes and for corners that coincide.
    void
    add_hexahedron(const std::array<long, 8> &nodes);

    /// Quadrilaterals of negative ids are left out: they bound nothing.
    void
    add_quadrilateral(const std::array<long, 4> &nodes, const long boundary_id);

    /// A cell of another kind, which makes the mesh useless.
    void
    add_other(const std::string &kind);

    /// The corner numbers of a face of a hexahedron by Abaqus' numbers from one to six.
    std::array<long, 4>
    face(const std::size_t hexahedron, const unsigned int number) const;

    std::size_t
    n_hexahedra() const
    {
      return hexahedra.size();
    }

    /// Cells of other kinds, and what they are.
    std::size_t
    n_others() const
    {
      return other_cells;
    }

    const std::string &
    other_kind() const
    {
      return kind_of_others;
    }

    /**
     * Make the mesh; cells of negative volume are turned. Throws std::runtime_error for faces that
     * more than two cells share and for quadrilaterals that are no boundary face.
     */
    void
    make_triangulation(dealii::Triangulation<3> &triangulation) const;

  private:
    unsigned int
    index_of(const long node) const;
    void
    check_faces() const;

    std::unordered_map<long, unsigned int> indices; ///< of the nodes, by number
    std::vector<dealii::Point<3>> places;
    std::vector<std::array<long, 8>> hexahedra;
    dealii::SubCellData quadrilaterals;
    std::size_t other_cells = 0;
    std::string kind_of_others;
  };


  /// Read legacy VTK files, UCD files, and Gmsh's of versions 1, 2 and 4.1, all in text form. Throw
  /// std::runtime_error with one line.
  void
  read_vtk(std::istream &stream, MeshTable &table);
  void
  read_ucd(std::istream &stream, MeshTable &table);
  void
  read_msh(std::istream &stream, MeshTable &table);
} // namespace akmon
