#include <akmon/model/abaqus_deck.h>
#include <akmon/model/words.h>
#include <akmon/parameters.h>

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <stdexcept>

namespace akmon
{
  namespace
  {
    bool
    is_number(const std::string &text)
    {
      return !text.empty() && text.size() < 10 &&
             std::all_of(text.begin(), text.end(), [](const unsigned char c) {
               return std::isdigit(c) != 0;
             });
    }


    long
    number(const std::string &text)
    {
      if (!is_number(text))
        throw std::runtime_error("'" + text + "' stands where a number is expected");
      return std::stol(text);
    }
  } // namespace


  AbaqusDeck::AbaqusDeck(std::istream &stream, MeshTable &table)
    : table(table)
  {
    std::string keyword;
    for (std::string line; std::getline(stream, line);)
      {
        line = upper_case(dealii::Utilities::trim(line));
        if (split_list(line).empty() || line.compare(0, 2, "**") == 0)
          continue;
        if (line[0] != '*')
          {
            read_data(keyword, line);
            continue;
          }
        const auto entries = split_list(line);
        keyword            = entries[0];
        options.clear();
        for (const auto &entry : entries)
          {
            const auto equals                                         = entry.find('=');
            options[dealii::Utilities::trim(entry.substr(0, equals))] = equals ==
                                                                            std::string::npos ?
                                                                          "" :
                                                                          dealii::Utilities::trim(
                                                                            entry.substr(equals +
                                                                                         1));
          }
      }
    if (positions.empty() && table.n_others() == 0)
      throw std::runtime_error("there are no elements");
  }


  void
  AbaqusDeck::read_data(const std::string &keyword, const std::string &line)
  {
    if (keyword == "*NODE")
      read_node(line);
    else if (keyword == "*ELEMENT")
      read_element(line);
    else if (keyword == "*ELSET")
      read_set(options["ELSET"], line, options.count("GENERATE") == 1);
    else if (keyword == "*SURFACE" && options["TYPE"] != "NODE")
      read_surface(options["NAME"], line);
  }


  void
  AbaqusDeck::read_node(const std::string &line)
  {
    const auto entries = split_list(line);
    if (entries.size() < 4)
      throw std::runtime_error("a node has no three coordinates on its line");
    dealii::Point<3> place;
    for (unsigned int d = 0; d < 3; ++d)
      {
        const std::string &entry = entries[d + 1];
        char *end                = nullptr;
        place[d]                 = std::strtod(entry.c_str(), &end);
        if (entry.empty() || *end != '\0')
          throw std::runtime_error("'" + entry + "' stands where a coordinate is expected");
      }
    table.add_node(number(entries[0]), place);
  }


  void
  AbaqusDeck::read_element(const std::string &line)
  {
    static const std::set<std::string> hexahedra = {"C3D8", "C3D8R", "C3D8I", "C3D8H", "C3D8RH"};
    if (hexahedra.count(options["TYPE"]) == 0)
      {
        const std::string &type = options["TYPE"];
        table.add_other(type == "C3D4" || type == "C3D10" ? "tetrahedra" :
                                                            "elements of type " + type);
        return;
      }
    const auto entries = split_list(line);
    const long element = number(entries[0]);
    if (entries.size() != 9)
      throw std::runtime_error("element " + entries[0] + " does not have eight nodes on its line");
    if (!positions.emplace(element, table.n_hexahedra()).second)
      throw std::runtime_error("element " + entries[0] + " is there twice");
    sets[options["ELSET"]].insert(element);
    std::array<long, 8> nodes;
    std::transform(entries.begin() + 1, entries.end(), nodes.begin(), number);
    table.add_hexahedron(nodes);
  }


  void
  AbaqusDeck::read_set(const std::string &name, const std::string &line, const bool generate)
  {
    const auto entries = split_list(line);
    auto &set          = sets[name];
    if (generate && entries.size() >= 2)
      {
        const long step  = entries.size() > 2 ? std::max(1l, number(entries[2])) : 1;
        const long first = number(entries[0]), last = number(entries[1]);
        if ((last - first) / step >= long(positions.size()))
          throw std::runtime_error("set '" + name + "' has more elements than there are");
        for (long i = first; i <= last; i += step)
          set.insert(i);
        return;
      }
    for (const auto &entry : entries)
      if (const auto other = sets.find(entry); other != sets.end() && entry != name)
        set.insert(other->second.begin(), other->second.end());
      else
        set.insert(number(entry));
  }


  void
  AbaqusDeck::read_surface(const std::string &name, const std::string &line)
  {
    const auto digits = name.find_last_not_of("0123456789") + 1;
    if (!is_number(name.substr(digits)))
      throw std::runtime_error("surface '" + name +
                               "' must have a name that ends in a number, its boundary id");
    const auto entries = split_list(line);
    if (entries.size() != 2 || entries[1].size() != 2 || entries[1][0] != 'S' ||
        entries[1][1] < '1' || entries[1][1] > '6')
      throw std::runtime_error("surface '" + name +
                               "' must list elements or their sets with a face from S1 to S6");

    std::set<long> elements;
    if (const auto set = sets.find(entries[0]); set != sets.end())
      elements = set->second;
    else
      elements.insert(number(entries[0]));
    for (const long element : elements)
      {
        const auto position = positions.find(element);
        if (position == positions.end())
          throw std::runtime_error("surface '" + name + "' names the absent element " +
                                   std::to_string(element));
        table.add_quadrilateral(table.face(position->second, entries[1][1] - '0'),
                                std::stol(name.substr(digits)));
      }
  }
} // namespace akmon
