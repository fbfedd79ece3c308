#pragma once

#include <akmon/model/mesh_table.h>

#include <cstddef>
#include <istream>
#include <map>
#include <set>
#include <string>

namespace akmon
{
  /**
   * What of an Abaqus input file makes a mesh: nodes, elements and surfaces made of element faces,
   * whose boundary ids are the numbers that their names end in.
   */
  class AbaqusDeck
  {
  public:
    /// Throws std::runtime_error with one line for what is of no use.
    AbaqusDeck(std::istream &stream, MeshTable &table);

  private:
    void
    read_data(const std::string &keyword, const std::string &line);
    void
    read_node(const std::string &line);
    void
    read_element(const std::string &line);
    void
    read_set(const std::string &name, const std::string &line, bool generate);
    void
    read_surface(const std::string &name, const std::string &line);

    MeshTable &table;
    std::map<std::string, std::string> options; ///< of the keyword line that holds; upper case
    std::map<long, std::size_t> positions;      ///< element number -> place in the table
    std::map<std::string, std::set<long>> sets; ///< element numbers
  };
} // namespace akmon
