#include <akmon/case.h>
#include <akmon/parameters.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <regex>
#include <sstream>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // The sections that list named items, and how an item declares itself.
    struct ListSection
    {
      std::string name;
      std::string documentation;
      std::function<void(ParameterHandler &)> declare_item;
    };

    const std::vector<ListSection> &
    list_sections()
    {
      static const std::vector<ListSection> sections =
        {{"Materials", "Names of the materials", &Material::declare},
         {"Bodies", "Names of the bodies", &Body::declare},
         {"Prescribed motion", "Names of the prescribed motions", &PrescribedMotion::declare},
         {"Loads", "Names of the surface loads", &SurfaceLoad::declare},
         {"Contact", "Names of the contacts between bodies", &SurfaceContact::declare},
         {"Obstacles", "Names of the rigid planes", &RigidPlane::declare},
         {"Probes", "Names of the probes", &Probe::declare}};
      return sections;
    }

    using Names = std::map<std::string, std::vector<std::string>>; // per list section

    struct Override
    {
      std::vector<std::string> path;
      std::string key, value;
    };


    void
    declare_names(ParameterHandler &prm)
    {
      for (const auto &section : list_sections())
      {
        prm.enter_subsection(section.name);
        prm.declare_entry("Names",
                          "",
                          Patterns::Anything(),
                          section.documentation + ", separated by commas; each has a subsection of "
                                                  "its name");
        prm.leave_subsection();
      }
    }


    void
    declare_all(ParameterHandler &prm, const Names &names)
    {
      prm.declare_entry("Title", "", Patterns::Anything(), "One line about the case");
      prm.declare_entry("Output directory",
                        "",
                        Patterns::Anything(),
                        "Directory of the results (default: output/ and the name of the prm file)");
      declare_names(prm);
      for (const auto &section : list_sections())
        for (const auto &name : names.at(section.name))
        {
          prm.enter_subsection(section.name);
          prm.enter_subsection(name);
          section.declare_item(prm);
          prm.leave_subsection();
          prm.leave_subsection();
        }
      prm.enter_subsection("Time");
      StepControl::declare(prm);
      prm.leave_subsection();
      prm.enter_subsection("Body force");
      BodyForce::declare(prm);
      prm.leave_subsection();
      prm.enter_subsection("Contact solver");
      ContactSolver::declare(prm);
      prm.leave_subsection();
      prm.enter_subsection("Output");
      OutputParameters::declare(prm);
      prm.leave_subsection();
    }


    // The subsections that are open at a line of a prm file, "Bodies/left".
    std::string
    section_at_line(const std::string &file, const unsigned int line_number)
    {
      std::ifstream in(file);
      std::vector<std::string> open;
      std::string line;
      for (unsigned int i = 0; i < line_number && std::getline(in, line); ++i)
      {
        std::smatch match;
        if (std::regex_match(line, match, std::regex("\\s*subsection\\s+(.*?)\\s*(#.*)?")))
          open.push_back(match[1]);
        else if (std::regex_match(line, std::regex("\\s*end\\s*(#.*)?")) && !open.empty())
          open.pop_back();
      }
      std::string section;
      for (const auto &name : open)
        section += (section.empty() ? "" : "/") + name;
      return section;
    }


    // One line out of what deal.II says about a prm file.
    std::string
    one_line(const ExceptionBase &exception, const std::string &file)
    {
      std::ostringstream text;
      exception.print_info(text);
      const std::string collapsed = std::regex_replace(text.str(), std::regex("\\s+"), " ");
      std::smatch match;
      std::string place;
      if (std::regex_search(collapsed, match, std::regex("[Ll]ine <?(\\d+)>?")))
        place = "line " + match[1].str() + ", [" + section_at_line(file, std::stoi(match[1])) +
                "] ";
      if (std::regex_search(collapsed,
                            match,
                            std::regex(
                              "entry value (.*) for the entry named (.*) does not match the given "
                              "pattern:? (.*)")))
        return place + match[2].str() + " = " + match[1].str() + ": allowed is " + match[3].str();
      if (std::regex_search(collapsed, match, std::regex("No entry with name <(.*)> was declared")))
        return place + match[1].str() + ": there is no such key in this section";
      if (std::regex_search(collapsed, match, std::regex("no such subsection to be entered: (.*)")))
        return place + "there is no such subsection (lists need the name in their Names)";
      return place + collapsed;
    }


    void
    parse_file(ParameterHandler &prm, const std::string &file, const bool skip_undefined)
    {
      std::ifstream in(file);
      if (!in)
        throw InputError("cannot be read");
      try
      {
        prm.parse_input(in, file, "", skip_undefined);
      }
      catch (const ExceptionBase &exception)
      {
        throw InputError(one_line(exception, file));
      }
    }


    std::vector<Override>
    split_overrides(const std::vector<std::string> &texts)
    {
      std::vector<Override> overrides;
      for (const auto &text : texts)
      {
        const auto equals = text.find('=');
        if (equals == std::string::npos || equals == 0)
          throw InputError("--set " + text + ": allowed is \"Section/Sub/Key=value\"");
        Override entry{split_list(text.substr(0, equals), '/'), "", text.substr(equals + 1)};
        entry.key = entry.path.back();
        entry.path.pop_back();
        overrides.push_back(entry);
      }
      return overrides;
    }


    void
    apply_override(ParameterHandler &prm, const Override &entry)
    {
      std::string section;
      for (const auto &name : entry.path)
      {
        prm.enter_subsection(name);
        section += (section.empty() ? "" : "/") + name;
      }
      const InputError unknown("--set [" + section + "] " + entry.key + ": there is no such key");
      try
      {
        prm.get(entry.key);
      }
      catch (const ExceptionBase &)
      {
        throw unknown;
      }
      try
      {
        prm.set(entry.key, entry.value);
      }
      catch (const ExceptionBase &exception)
      {
        std::ostringstream text;
        exception.print_info(text);
        throw InputError("--set " + section,
                         entry.key,
                         entry.value,
                         std::regex_replace(text.str(), std::regex("\\s+"), " "));
      }
      for (unsigned int i = 0; i < entry.path.size(); ++i)
        prm.leave_subsection();
    }


    // First pass: only the lists of names, which decide what the second pass declares.
    Names
    read_names(const std::string &file, const std::vector<Override> &overrides)
    {
      ParameterHandler prm;
      declare_names(prm);
      parse_file(prm, file, true);
      for (const auto &entry : overrides)
        if (entry.key == "Names" && entry.path.size() == 1)
          apply_override(prm, entry);
      Names names;
      for (const auto &section : list_sections())
      {
        prm.enter_subsection(section.name);
        auto &list = names[section.name] = split_list(prm.get("Names"));
        for (auto name = list.begin(); name != list.end(); ++name)
          if (std::find(list.begin(), name, *name) != name)
            throw InputError(section.name,
                             "Names",
                             prm.get("Names"),
                             "'" + *name + "' stands twice");
          else if (name->find_first_of(":/") != std::string::npos)
            throw InputError(section.name, "Names", prm.get("Names"), "names have no ':' or '/'");
        prm.leave_subsection();
      }
      return names;
    }


    template <typename Item>
    std::vector<Item>
    parse_items(ParameterHandler &prm, const Names &names, const std::string &section)
    {
      std::vector<Item> items;
      prm.enter_subsection(section);
      for (const auto &name : names.at(section))
      {
        prm.enter_subsection(name);
        items.emplace_back();
        items.back().name = name;
        items.back().parse(prm, section + "/" + name);
        prm.leave_subsection();
      }
      prm.leave_subsection();
      return items;
    }


    template <typename Module>
    void
    parse_section(ParameterHandler &prm, const std::string &section, Module &module)
    {
      prm.enter_subsection(section);
      module.parse(prm);
      prm.leave_subsection();
    }


    Case
    parse_all(ParameterHandler &prm, const Names &names, const std::string &file)
    {
      Case result;
      result.title            = prm.get("Title");
      result.output_directory = prm.get("Output directory");
      if (result.output_directory.empty())
        result.output_directory = "output/" + std::filesystem::path(file).stem().string();
      parse_section(prm, "Time", result.time);
      result.materials          = parse_items<Material>(prm, names, "Materials");
      result.bodies             = parse_items<Body>(prm, names, "Bodies");
      result.prescribed_motions = parse_items<PrescribedMotion>(prm, names, "Prescribed motion");
      result.surface_loads      = parse_items<SurfaceLoad>(prm, names, "Loads");
      parse_section(prm, "Body force", result.body_force);
      parse_section(prm, "Contact solver", result.contact_solver);
      result.contacts = parse_items<SurfaceContact>(prm, names, "Contact");
      result.planes   = parse_items<RigidPlane>(prm, names, "Obstacles");
      result.probes   = parse_items<Probe>(prm, names, "Probes");
      parse_section(prm, "Output", result.output);
      if (result.bodies.empty())
        throw InputError("Bodies", "Names", "(none)", "a case needs at least one body");
      std::ostringstream as_used;
      prm.print_parameters(as_used, ParameterHandler::PRM);
      result.as_used = as_used.str();
      return result;
    }
  } // namespace


  Case
  Case::read(const std::string &file, const std::vector<std::string> &overrides)
  {
    try
    {
      const auto entries = split_overrides(overrides);
      const Names names  = read_names(file, entries);
      ParameterHandler prm;
      declare_all(prm, names);
      parse_file(prm, file, false);
      for (const auto &entry : entries)
        apply_override(prm, entry);
      return parse_all(prm, names, file);
    }
    catch (const InputError &error)
    {
      throw InputError(file + ": " + error.what());
    }
  }


  void
  Case::print_reference(std::ostream &out)
  {
    Names names;
    for (const auto &section : list_sections())
      names[section.name] = {"NAME"};
    ParameterHandler prm;
    declare_all(prm, names);
    prm.print_parameters(out, ParameterHandler::Description);
  }
} // namespace akmon
