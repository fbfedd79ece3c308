#include <akmon/idle_parameters.h>
#include <akmon/material/library.h>

#include <boost/property_tree/json_parser.hpp>
#include <boost/property_tree/ptree.hpp>

#include <algorithm>
#include <map>
#include <sstream>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    using Tree = boost::property_tree::ptree;

    // Keys that have a meaning for some values of another one of their section or item.
    struct Rule
    {
      std::string section;           // its items, if it is a list
      std::string within;            // a section in it that the keys are in, or none
      std::vector<std::string> keys; // none: all
      std::string choice;
      std::vector<std::string> served;
    };


    // Of the entries and their defaults. The reader wants UTF-8, which a file need not be.
    Tree
    tree_of(const ParameterHandler &prm)
    {
      std::stringstream printed;
      prm.print_parameters(printed, ParameterHandler::JSON);
      std::string text = printed.str();
      std::replace_if(
        text.begin(), text.end(), [](const char c) { return (c & 0x80) != 0; }, '?');
      std::istringstream ascii(text);
      Tree tree;
      read_json(ascii, tree);
      return tree;
    }


    template <std::size_t... I>
    void
    add_laws(std::vector<Rule> &rules, std::index_sequence<I...>)
    {
      std::map<std::string, std::vector<std::string>> laws_of_key;
      const auto add = [&](const std::string &law, const auto &declare) {
        ParameterHandler prm;
        declare(prm);
        for (const auto &[key, entry] : tree_of(prm))
          laws_of_key[key].push_back(law);
      };
      (add(std::variant_alternative_t<I, MaterialLaw>::name,
           &std::variant_alternative_t<I, MaterialLaw>::declare),
       ...);
      for (const auto &[key, laws] : laws_of_key)
        rules.push_back({"Materials", "", {key}, "Law", laws});
    }


    std::vector<Rule>
    all_rules()
    {
      std::vector<Rule> rules;
      add_laws(rules, std::make_index_sequence<std::variant_size_v<MaterialLaw>>());
      rules.push_back({"Bodies",
                       "",
                       {"Hourglass control", "Hourglass coefficient"},
                       "Integration",
                       {"one point"}});
      rules.push_back({"Prescribed motion",
                       "",
                       {"Components", "Function"},
                       "Type",
                       {"displacement", "velocity"}});
      rules.push_back({"Contact",
                       "",
                       {"Normal strength", "Shear strength", "Fracture energy", "Bond distance"},
                       "Type",
                       {"tied"}});
      rules.push_back({"Obstacles", "Prescribed", {}, "Motion", {"prescribed"}});
      rules.push_back({"Obstacles", "Free", {}, "Motion", {"free"}});
      rules.push_back(
        {"Contact solver", "", {"Tolerance", "Maximum iterations"}, "Type", {"coupled"}});
      rules.push_back({"Contact solver", "", {"Penalty scale"}, "Type", {"penalty"}});
      const std::map<std::string, std::vector<std::string>> shapes =
        {{"Bodies", {"Box", "Cylinder", "Hollow cylinder", "Sphere", "File"}},
         {"Obstacles", {"Box", "Cylinder", "Sphere", "Torus", "File"}}};
      for (const auto &[section, names] : shapes)
        for (const auto &name : names)
          rules.push_back({section,
                           name,
                           {},
                           "Shape",
                           {std::string(1, char(std::tolower(name[0]))) + name.substr(1)}});
      return rules;
    }


    // Names may hold the dots that paths in a tree consist of.
    const Tree &
    child(const Tree &tree, const std::string &name)
    {
      return tree.find(name)->second;
    }


    void
    look_at(const std::string &path,
            const Tree &item,
            const Rule &rule,
            std::vector<std::string> &lines)
    {
      const auto chosen = child(item, rule.choice).get<std::string>("value");
      const Tree &keys  = rule.within.empty() ? item : child(item, rule.within);
      if (std::find(rule.served.begin(), rule.served.end(), chosen) != rule.served.end())
        return;
      for (const auto &[key, entry] : keys)
        {
          const auto value = entry.get_optional<std::string>("value");
          if (!value || *value == entry.get<std::string>("default_value") ||
              !(rule.keys.empty() ||
                std::find(rule.keys.begin(), rule.keys.end(), key) != rule.keys.end()))
            continue;
          std::string needed;
          for (const auto &choice : rule.served)
            needed += (needed.empty() ? "" : " or ") + choice;
          lines.push_back("[" + path + (rule.within.empty() ? "" : "/" + rule.within) + "] " + key +
                          " = " + *value + " has no effect: it needs [" + path + "] " +
                          rule.choice + " = " + needed);
        }
    }
  } // namespace


  std::vector<std::string>
  idle_parameters(const ParameterHandler &prm)
  {
    const Tree tree = tree_of(prm);
    std::vector<std::string> lines;
    for (const auto &rule : all_rules())
      {
        const Tree &section = child(tree, rule.section);
        if (!section.count("Names"))
          look_at(rule.section, section, rule, lines);
        else
          for (const auto &[name, item] : section)
            if (!item.count("value"))
              look_at(rule.section + "/" + name, item, rule, lines);
      }
    return lines;
  }
} // namespace akmon
