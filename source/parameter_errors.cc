#include <akmon/parameter_errors.h>
#include <akmon/parameters.h>

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <regex>
#include <sstream>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // Follows a prm text line by line.
    struct PrmReader
    {
      std::vector<std::string> open; // the subsections around the last line: "Bodies", "left"
      std::string key, value;        // if that line sets an entry

      void
      take(const std::string &line)
      {
        static const std::regex subsection("\\s*subsection\\s+(.*?)\\s*(#.*)?"),
          end("\\s*end\\s*(#.*)?"), set("\\s*set\\s+(.*?)\\s*=\\s*(.*?)\\s*(#.*)?");
        std::smatch match;
        key.clear();
        if (std::regex_match(line, match, subsection))
          open.push_back(match[1]);
        else if (std::regex_match(line, end) && !open.empty())
          open.pop_back();
        else if (std::regex_match(line, match, set))
          {
            key   = match[1];
            value = match[2];
          }
      }
    };


    // Reads a file up to a line (or its end).
    PrmReader
    read_until(const std::string &file, const unsigned int line_number)
    {
      std::ifstream in(file);
      PrmReader reader;
      std::string line;
      for (unsigned int i = 0; i < line_number && std::getline(in, line); ++i)
        reader.take(line);
      return reader;
    }


    struct Contents
    {
      std::vector<std::string> keys, subsections;
    };

    Contents
    contents(const ParameterHandler &prm, const std::vector<std::string> &section)
    {
      std::stringstream text;
      prm.print_parameters(text, ParameterHandler::ShortText);
      PrmReader reader;
      Contents result;
      for (std::string line; std::getline(text, line);)
        {
          const std::size_t depth_before = reader.open.size();
          reader.take(line);
          const auto &open = reader.open;
          if (!reader.key.empty() && open == section)
            result.keys.push_back(reader.key);
          else if (open.size() > depth_before &&
                   std::vector<std::string>(open.begin(), open.end() - 1) == section)
            result.subsections.push_back(open.back());
        }
      return result;
    }


    std::string
    list_or_none(const std::vector<std::string> &names)
    {
      return names.empty() ? "none" : join(names, ", ");
    }
  } // namespace


  std::string
  join(const std::vector<std::string> &names, const std::string &separator)
  {
    std::string text;
    for (const auto &name : names)
      text += (text.empty() ? "" : separator) + name;
    return text;
  }


  std::string
  no_such_section(const ParameterHandler &prm, const std::vector<std::string> &section)
  {
    std::vector<std::string> known; // up to the first part that is unknown
    while (known.size() + 1 < section.size())
      {
        known.push_back(section[known.size()]);
        if (!prm.subsection_path_exists(known))
          {
            known.pop_back();
            break;
          }
      }
    const Contents there = contents(prm, known);
    const bool is_list   = std::find(there.keys.begin(), there.keys.end(), "Names") !=
                         there.keys.end();
    return "there is no such section; allowed are " + list_or_none(there.subsections) +
           (is_list ? " (the Names of [" + join(known, "/") + "])" : "");
  }


  std::string
  no_such_key(const ParameterHandler &prm, const std::vector<std::string> &section)
  {
    return "there is no such key; allowed are " + list_or_none(contents(prm, section).keys);
  }


  void
  check_braces(ParameterHandler &prm, const std::string &file)
  {
    std::ifstream in(file);
    PrmReader reader;
    unsigned int number = 0;
    for (std::string line; std::getline(in, line);)
      {
        ++number;
        reader.take(line);
        if (reader.key.empty() || reader.value.find('{') == std::string::npos)
          continue;
        for (const auto &name : reader.open)
          prm.enter_subsection(name);
        const std::string read = prm.get(reader.key); // perhaps of a later line
        try
          {
            prm.set(reader.key, reader.value);
          }
        catch (const ParameterHandler::ExcValueDoesNotMatchPattern &)
          {
            const std::string section = reader.open.empty() ? "" :
                                                              "[" + join(reader.open, "/") + "] ";
            throw InputError("line " + std::to_string(number) + ": " + section + reader.key +
                             " = " + reader.value + ": braces are not allowed here");
          }
        prm.set(reader.key, read);
        for (std::size_t i = 0; i < reader.open.size(); ++i)
          prm.leave_subsection();
      }
  }


  std::string
  in_one_line(const ExceptionBase &exception, const ParameterHandler &prm, const std::string &file)
  {
    std::ostringstream text;
    exception.print_info(text);
    std::string collapsed = dealii::Utilities::trim(
      std::regex_replace(text.str(), std::regex("\\s+"), " "));
    const auto found = [&](const char *const pattern, std::smatch &match) {
      return std::regex_search(collapsed, match, std::regex(pattern));
    };

    std::smatch match;
    if (dynamic_cast<const ParameterHandler::ExcUnbalancedSubsections *>(&exception))
      return "the end of the file comes within section [" +
             join(read_until(file, std::numeric_limits<unsigned int>::max()).open, "/") +
             "]: an 'end' is missing in it or before it";
    if (!found("Line <(\\d+)> of file <(.*?)(?:>:|>\\.|: There is) *(.*)", match))
      return collapsed;
    const std::string problem = match[3];
    const auto reader         = read_until(match[2], std::stoul(match[1]));
    const std::string place   = "line " + match[1].str() +
                              (match[2] == file ? "" : " of " + match[2].str()) + ": ";
    const std::string section = reader.open.empty() ? "" : "[" + join(reader.open, "/") + "] ";
    if (dynamic_cast<const ParameterHandler::ExcNoSubsection *>(&exception))
      return place + section + no_such_section(prm, reader.open);
    if (dynamic_cast<const ParameterHandler::ExcInvalidEntryForPattern *>(&exception) &&
        found("does not match the given pattern:? *(.*)", match))
      return place + section + reader.key + " = " + reader.value + ": " + allowed_values(match[1]);
    if (found("No entry with name", match))
      return place + section + reader.key + " = " + reader.value + ": " +
             no_such_key(prm, reader.open);
    if (found("no subsection to leave", match))
      return place + "an 'end' without its subsection";
    if (found("The line <(.*)> could not be parsed", match))
      return place + section + "'" + match[1].str() +
             "' is not understood; allowed are 'subsection NAME', 'set KEY = VALUE', 'end' and "
             "comments after '#'";
    return place + section + problem;
  }
} // namespace akmon
