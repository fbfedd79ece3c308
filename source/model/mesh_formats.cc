#include <akmon/model/mesh_table.h>
#include <akmon/model/words.h>

#include <algorithm>
#include <limits>
#include <map>
#include <stdexcept>

// Mesh files as words: nothing is believed that is not there.

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // Kinds of cells that the formats know by different names.
    struct Kind
    {
      unsigned int n_nodes;
      enum
      {
        hexahedron,
        quadrilateral,
        tetrahedron,
        other_volume,
        no_volume
      } type;
    };


    template <std::size_t n>
    std::array<long, n>
    corners(const std::vector<long> &nodes)
    {
      if (nodes.size() != n)
        throw std::runtime_error("a cell has " + std::to_string(nodes.size()) + " nodes, not " +
                                 std::to_string(n));
      std::array<long, n> result;
      std::copy(nodes.begin(), nodes.end(), result.begin());
      return result;
    }


    const Kind &
    kind_of(const std::map<std::string, Kind> &kinds, const std::string &name)
    {
      const auto found = kinds.find(name);
      if (found == kinds.end())
        throw std::runtime_error("cells of type " + shown(name) + " are not known");
      return found->second;
    }


    // So many nodes, each with its number and its place.
    void
    read_nodes(Words &words, const long n_nodes, MeshTable &table)
    {
      for (long i = 0; i < n_nodes; ++i)
        {
          const long number = words.integer();
          table.add_node(number, words.point());
        }
    }


    void
    add_cell(const Kind &kind,
             const std::vector<long> &nodes,
             const long boundary_id,
             MeshTable &table)
    {
      if (kind.type == Kind::hexahedron)
        table.add_hexahedron(corners<8>(nodes));
      else if (kind.type == Kind::quadrilateral)
        table.add_quadrilateral(corners<4>(nodes), boundary_id);
      else if (kind.type == Kind::tetrahedron)
        table.add_other("tetrahedra");
      else if (kind.type == Kind::other_volume)
        table.add_other("pyramids or wedges");
    }


    const std::map<std::string, Kind> gmsh_kinds = {{"1", {2, Kind::no_volume}},
                                                    {"2", {3, Kind::no_volume}},
                                                    {"3", {4, Kind::quadrilateral}},
                                                    {"4", {4, Kind::tetrahedron}},
                                                    {"5", {8, Kind::hexahedron}},
                                                    {"6", {6, Kind::other_volume}},
                                                    {"7", {5, Kind::other_volume}},
                                                    {"15", {1, Kind::no_volume}}};


    // Physical tags of the surfaces, by entity.
    std::map<long, long>
    surface_tags(Words &words)
    {
      std::map<long, long> tags;
      const auto n = words.integers(4);
      for (unsigned int dim = 0; dim < 4; ++dim)
        for (long i = 0; i < n[dim]; ++i)
          {
            const long entity = words.integer();
            words.skip(dim == 0 ? 3 : 6); // place or box
            const long n_tags = words.count();
            for (long tag = 0; tag < n_tags; ++tag)
              {
                const long value = words.integer();
                if (dim == 2)
                  tags.emplace(entity, value);
              }
            if (dim > 0)
              words.skip(words.count()); // boundary
          }
      return tags;
    }


    void
    read_msh_4(Words &words, MeshTable &table)
    {
      std::map<long, long> tags;
      std::string section = words.word();
      for (; section != "$Nodes"; section = words.word())
        if (section.empty())
          throw std::runtime_error("there is no '$Nodes'");
        else if (section == "$Entities")
          tags = surface_tags(words);
      const auto n_of_nodes = words.integers(4); // blocks, nodes, smallest and largest number
      for (long block = 0; block < n_of_nodes[0]; ++block)
        {
          const long dim = words.integer();
          words.integer();
          const bool parametric = words.integer() != 0;
          std::vector<long> numbers(words.count());
          for (long &number : numbers)
            number = words.integer();
          for (const long number : numbers)
            {
              table.add_node(number, words.point());
              if (parametric)
                words.skip(dim);
            }
        }
      words.find("$Elements");
      const auto n_of_cells = words.integers(4);
      for (long block = 0; block < n_of_cells[0]; ++block)
        {
          words.integer();
          const auto tag  = tags.find(words.integer());
          const auto kind = kind_of(gmsh_kinds, words.word());
          const long n    = words.count();
          for (long i = 0; i < n; ++i)
            {
              words.integer();
              add_cell(kind,
                       words.integers(kind.n_nodes),
                       tag == tags.end() ? 0 : tag->second,
                       table);
            }
        }
    }


    // Versions 1 and 2.
    void
    read_msh_lists(Words &words, const bool first_version, MeshTable &table)
    {
      read_nodes(words, words.count(), table);
      words.find(first_version ? "$ELM" : "$Elements");
      const long n_cells = words.count();
      for (long i = 0; i < n_cells; ++i)
        {
          words.integer();
          const auto kind = kind_of(gmsh_kinds, words.word());
          long tag        = 0;
          if (first_version)
            {
              tag = words.integer();
              words.skip(2); // elementary region, number of nodes
            }
          else if (const long n_tags = words.count(); n_tags > 0)
            {
              tag = words.integer();
              words.skip(n_tags - 1);
            }
          add_cell(kind, words.integers(kind.n_nodes), tag, table);
        }
    }
  } // namespace


  void
  read_msh(std::istream &stream, MeshTable &table)
  {
    Words words(stream);
    const std::string begin = words.word();
    if (begin == "$NOD")
      return read_msh_lists(words, true, table);
    if (begin != "$MeshFormat")
      throw std::runtime_error("it does not begin with '$MeshFormat'");
    const double version = words.number();
    if (words.integer() != 0)
      throw std::runtime_error("it is binary; save it as ASCII");
    if (version >= 2. && version < 3.)
      {
        words.find("$Nodes");
        read_msh_lists(words, false, table);
      }
    else if (version > 4.05 && version < 5.)
      read_msh_4(words, table);
    else
      throw std::runtime_error("its version is not 1, 2 or 4.1; save it as version 4.1");
  }


  void
  read_ucd(std::istream &stream, MeshTable &table)
  {
    static const std::map<std::string, Kind> kinds = {{"hex", {8, Kind::hexahedron}},
                                                      {"quad", {4, Kind::quadrilateral}},
                                                      {"tet", {4, Kind::tetrahedron}},
                                                      {"prism", {6, Kind::other_volume}},
                                                      {"pyr", {5, Kind::other_volume}},
                                                      {"tri", {3, Kind::no_volume}},
                                                      {"line", {2, Kind::no_volume}},
                                                      {"pt", {1, Kind::no_volume}}};

    while (stream.peek() == '#')
      stream.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
    Words words(stream);
    const long n_nodes = words.count(), n_cells = words.count();
    words.skip(3); // numbers of data
    read_nodes(words, n_nodes, table);
    for (long i = 0; i < n_cells; ++i)
      {
        words.integer();
        const long material = words.integer();
        const auto kind     = kind_of(kinds, words.word());
        add_cell(kind, words.integers(kind.n_nodes), material, table);
      }
  }


  void
  read_vtk(std::istream &stream, MeshTable &table)
  {
    static const std::map<std::string, Kind> kinds = {{"12", {8, Kind::hexahedron}},
                                                      {"9", {4, Kind::quadrilateral}},
                                                      {"10", {4, Kind::tetrahedron}},
                                                      {"13", {6, Kind::other_volume}},
                                                      {"14", {5, Kind::other_volume}},
                                                      {"5", {3, Kind::no_volume}},
                                                      {"3", {2, Kind::no_volume}},
                                                      {"1", {1, Kind::no_volume}}};

    Words words(stream);
    if (words.line().compare(0, 5, "# vtk") != 0)
      throw std::runtime_error("it does not begin with '# vtk'");
    words.line(); // title
    words.expect("ASCII");
    words.expect("DATASET");
    words.expect("UNSTRUCTURED_GRID");
    words.find("POINTS");
    const long n_nodes = words.count();
    words.skip(1); // type of number
    for (long i = 0; i < n_nodes; ++i)
      table.add_node(i, words.point());
    words.find("CELLS");
    std::vector<std::vector<long>> cells(words.count());
    words.skip(1); // number of words
    for (auto &cell : cells)
      cell = words.integers(words.count());
    words.expect("CELL_TYPES");
    if (words.count() != long(cells.size()))
      throw std::runtime_error("cells and their types are not of the same number");
    std::vector<Kind> types;
    for (std::size_t i = 0; i < cells.size(); ++i)
      types.push_back(kind_of(kinds, words.word()));

    // deal.II tells boundary ids as materials.
    std::vector<long> ids(cells.size(), 0);
    std::string word = words.word();
    while (!word.empty() && word != "MaterialID")
      word = words.word();
    if (!word.empty())
      {
        words.find("default");
        for (long &id : ids)
          id = words.integer();
      }
    for (std::size_t i = 0; i < cells.size(); ++i)
      add_cell(types[i], cells[i], ids[i], table);
  }
} // namespace akmon
