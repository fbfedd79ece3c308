#include <akmon/case.h>
#include <akmon/idle_parameters.h>
#include <akmon/parameter_errors.h>
#include <akmon/parameter_reference.h>
#include <akmon/parameters.h>

#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
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
         {"Obstacles", "Names of the rigid obstacles and tools", &Obstacle::declare},
         {"Probes", "Names of the probes", &Probe::declare}};
      return sections;
    }

    using Names = std::map<std::string, std::vector<std::string>>; // per list section

    struct Override
    {
      std::vector<std::string> path;
      std::string key, value;
    };


    // Swallows what is written to std::cerr while it lives.
    class SilentErrors
    {
    public:
      SilentErrors()
        : previous(std::cerr.rdbuf(swallowed.rdbuf()))
      {
      }

      ~SilentErrors()
      {
        std::cerr.rdbuf(previous);
      }

      SilentErrors(const SilentErrors &) = delete;

    private:
      std::ostringstream swallowed;
      std::streambuf *previous;
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
                            section.documentation +
                              ", separated by commas; each has a subsection of "
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
      prm.enter_subsection("Checkpoint");
      CheckpointParameters::declare(prm);
      prm.leave_subsection();
      prm.enter_subsection("Parallel");
      PartitionParameters::declare(prm);
      prm.leave_subsection();
    }


    void
    parse_file(ParameterHandler &prm, const std::string &file, const bool skip_undefined)
    {
      std::ifstream in(file);
      if (!in || !std::filesystem::exists(file))
        throw InputError("there is no such file, or it cannot be read");
      if (std::filesystem::is_directory(file))
        throw InputError("this is a directory; a parameter file is needed");
      if (in.peek() == std::ifstream::traits_type::eof())
        throw InputError("the file is empty");
      try
        {
          prm.parse_input(in, file, "", skip_undefined);
        }
      catch (const ExceptionBase &exception)
        {
          throw InputError(in_one_line(exception, prm, file));
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
      const std::string section = join(entry.path, "/");
      const std::string what    = "--set " + (section.empty() ? "" : "[" + section + "] ") +
                               entry.key + " = " + entry.value + ": ";
      if (!entry.path.empty() && !prm.subsection_path_exists(entry.path))
        throw InputError(what + no_such_section(prm, entry.path));
      for (const auto &name : entry.path)
        prm.enter_subsection(name);
      std::string problem;
      try
        {
          prm.set(entry.key, entry.value);
        }
      catch (const ParameterHandler::ExcValueDoesNotMatchPattern &exception)
        {
          std::ostringstream text;
          exception.print_info(text);
          std::smatch match;
          const std::string info = text.str();
          std::regex_search(info, match, std::regex("given pattern <(.*)>\\."));
          problem = allowed_values(match[1]);
        }
      catch (const ExceptionBase &)
        {
          problem = no_such_key(prm, entry.path);
        }
      for (unsigned int i = 0; i < entry.path.size(); ++i)
        prm.leave_subsection();
      if (!problem.empty())
        throw InputError(what + problem);
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
      const std::string above = section + "/";
      std::vector<Item> items;
      prm.enter_subsection(section);
      for (const auto &name : names.at(section))
        {
          prm.enter_subsection(name);
          items.emplace_back();
          items.back().name = name;
          items.back().parse(prm, above + name);
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


    void
    check_materials(const Case &result)
    {
      std::vector<std::string> known;
      for (const auto &material : result.materials)
        known.push_back(material.name);
      for (const auto &body : result.bodies)
        if (std::find(known.begin(), known.end(), body.material) == known.end())
          throw InputError("Bodies/" + body.section_name(),
                           "Material",
                           body.material,
                           "there is no such material; allowed are " +
                             (known.empty() ? "none" : join(known, ", ")) +
                             " (the Names of [Materials])");
    }


    Case
    parse_all(ParameterHandler &prm, const Names &names, const std::string &file)
    {
      if (names.at("Bodies").empty())
        throw InputError("Bodies", "Names", "(none)", "a case needs at least one body");
      Case result;
      result.title            = prm.get("Title");
      result.output_directory = prm.get("Output directory");
      if (result.output_directory.empty())
        result.output_directory = "output/" + std::filesystem::path(file).stem().string();
      parse_section(prm, "Time", result.time);
      result.materials          = parse_items<Material>(prm, names, "Materials");
      result.bodies             = with_copies(parse_items<Body>(prm, names, "Bodies"));
      result.prescribed_motions = parse_items<PrescribedMotion>(prm, names, "Prescribed motion");
      result.surface_loads      = parse_items<SurfaceLoad>(prm, names, "Loads");
      parse_section(prm, "Body force", result.body_force);
      parse_section(prm, "Contact solver", result.contact_solver);
      result.contacts  = parse_items<SurfaceContact>(prm, names, "Contact");
      result.obstacles = parse_items<Obstacle>(prm, names, "Obstacles");
      result.probes    = parse_items<Probe>(prm, names, "Probes");
      parse_section(prm, "Output", result.output);
      parse_section(prm, "Checkpoint", result.checkpoint);
      parse_section(prm, "Parallel", result.partition);
      check_materials(result);
      std::ostringstream as_used;
      prm.print_parameters(as_used, ParameterHandler::PRM);
      result.as_used = as_used.str();
      result.idle    = idle_parameters(prm);
      return result;
    }
  } // namespace


  Case
  Case::read(const std::string &file, const std::vector<std::string> &overrides)
  {
    // deal.II's function parser talks to std::cerr before it throws.
    const SilentErrors silent;
    const auto entries = split_overrides(overrides);
    const Names names  = read_names(file, entries);
    ParameterHandler prm;
    declare_all(prm, names);
    parse_file(prm, file, false);
    check_braces(prm, file);
    for (const auto &entry : entries)
      apply_override(prm, entry);
    return parse_all(prm, names, file);
  }


  void
  Case::print_reference(std::ostream &out)
  {
    Names names;
    for (const auto &section : list_sections())
      names[section.name] = {"NAME"};
    ParameterHandler prm;
    declare_all(prm, names);
    print_parameter_reference(prm, out);
  }
} // namespace akmon
