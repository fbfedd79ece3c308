#pragma once

#include <deal.II/base/point.h>

#include <cstddef>
#include <istream>
#include <map>
#include <string>
#include <vector>

namespace akmon
{
  /**
   * What of an Abaqus input file makes a mesh: nodes, elements and surfaces made of element faces.
   * dealii::GridIn::read_abaqus takes any element for a hexahedron, finds elements by position
   * instead of number and runs out of bounds for surfaces it does not expect, so it is given this
   * extract.
   */
  class AbaqusDeck
  {
  public:
    /// Throws std::runtime_error with one line if the elements or surfaces are of no use.
    explicit AbaqusDeck(std::istream &stream);

    /// How many elements are not hexahedra with eight nodes.
    std::size_t
    n_other_elements() const;

    /// What these are: "tetrahedra" or "elements of type ...".
    std::string
    other_elements() const;

    /// The extract in the form GridIn::read_abaqus expects; a surface's boundary id is the number
    /// its name ends in.
    std::string
    extract() const;

    /// Places of the nodes in the order of the file.
    std::vector<dealii::Point<3>>
    points() const;

  private:
    void
    read_data(const std::string &keyword, const std::string &line);
    void
    read_element(const std::string &line);
    void
    read_set(const std::string &name, const std::string &line, bool generate);
    void
    read_surface(const std::string &name, const std::string &line);

    std::map<std::string, std::string> options; ///< of the keyword line that holds; upper case

    std::string nodes, elements, surfaces;
    std::map<long, std::size_t>
      positions; ///< element number -> 1, 2, 3, ... in the order of the file
    std::map<std::string, std::vector<long>> sets; ///< element numbers
    std::size_t n_others = 0;
    std::string other_type;
  };
} // namespace akmon
