#include <akmon/parameter_reference.h>
#include <akmon/parameters.h>

#include <boost/property_tree/json_parser.hpp>
#include <boost/property_tree/ptree.hpp>

#include <algorithm>
#include <cctype>
#include <sstream>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    using Tree = boost::property_tree::ptree;

    std::string
    replace_all(std::string text, const std::string &from, const std::string &to)
    {
      for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
      return text;
    }


    // Text for the cell of a table.
    std::string
    cell(const std::string &text)
    {
      return replace_all(replace_all(replace_all(text, "|", "\\|"), "<", "&lt;"), "*", "\\*");
    }


    std::string
    meaning_of(const std::string &pattern)
    {
      std::string words     = allowed_values(pattern);
      const std::string cut = "allowed are ";
      if (words.compare(0, cut.size(), cut) == 0)
        words.erase(0, cut.size());
      words = replace_all(words, "[Anything]", "text");
      return replace_all(words, "[FileName (Type: input)]", "path of a file");
    }


    bool
    is_entry(const Tree &node)
    {
      return node.count("value") == 1 && node.count("pattern_description") == 1;
    }


    void
    print_entry(const std::string &key, const Tree &entry, std::ostream &out)
    {
      const auto default_value = entry.get<std::string>("default_value");
      out << "| `" << key << "` | "
          << (default_value.empty() ? "" : "`" + replace_all(default_value, "|", "\\|") + "`")
          << " | " << cell(meaning_of(entry.get<std::string>("pattern_description"))) << " | "
          << cell(entry.get<std::string>("documentation")) << " |\n";
    }


    // A section's entries as a table, then its subsections.
    void
    print_section(const std::string &path,
                  const unsigned int depth,
                  const Tree &section,
                  std::ostream &out)
    {
      const auto n_entries = std::count_if(section.begin(), section.end(), [](const auto &child) {
        return is_entry(child.second);
      });
      if (n_entries > 0)
        {
          out << "\n| key | default | allowed | meaning |\n|---|---|---|---|\n";
          for (const auto &[name, child] : section)
            if (is_entry(child))
              print_entry(name, child, out);
        }
      for (const auto &[name, child] : section)
        if (!is_entry(child))
          {
            const std::string below = (path.empty() ? "" : path + "/") + name;
            out << "\n" << std::string(depth + 2, '#') << " " << below << "\n";
            print_section(below, depth + 1, child, out);
          }
    }


    void
    print_contents(const Tree &tree, std::ostream &out)
    {
      out << "\n";
      for (const auto &[section, child] : tree)
        if (!is_entry(child))
          {
            std::string anchor = replace_all(section, " ", "-");
            std::transform(anchor.begin(), anchor.end(), anchor.begin(), [](const char c) {
              return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
            });
            out << "- [" << section << "](#" << anchor << ")\n";
          }
    }


    const char *const introduction =
      "# Parameters\n"
      "\n"
      "Every parameter of a case, its default, what is allowed and what it means. Written by\n"
      "`akmon --print-parameters`, do not edit.\n"
      "\n"
      "A parameter file holds lines `set KEY = VALUE` within `subsection NAME` ... `end`; `#` begins a\n"
      "comment. Below, `NAME` stands for every name in the key `Names` of the section above it, and\n"
      "`A/B` for subsection B of subsection A; on the command line\n"
      "`--set \"Bodies/left/Velocity=1, 0, 0\"` sets `Velocity` in section `Bodies/left`. Boundary parts are\n"
      "written BODY:PART. Units are the case's own, any consistent set; dimensions stand in parentheses\n"
      "or brackets.\n";
  } // namespace


  void
  print_parameter_reference(const ParameterHandler &prm, std::ostream &out)
  {
    std::stringstream json;
    prm.print_parameters(json, ParameterHandler::JSON | ParameterHandler::KeepDeclarationOrder);
    Tree tree;
    boost::property_tree::read_json(json, tree);
    out << introduction;
    print_contents(tree, out);
    out << "\n## Top level\n";
    print_section("", 0, tree, out);
  }
} // namespace akmon
