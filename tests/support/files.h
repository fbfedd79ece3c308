#pragma once

#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string>

namespace akmon::test
{
  /// All bytes of a file; empty if there is none.
  inline std::string
  file_content(const std::string &path)
  {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
  }


  inline void
  write_file(const std::string &path, const std::string &content)
  {
    std::ofstream(path, std::ios::binary) << content;
  }


  /// The value of a key in the summary.json of a run, as it stands there.
  inline std::string
  summary_value(const std::string &directory, const std::string &key)
  {
    const std::string text = file_content(directory + "/summary.json");
    std::smatch match;
    if (!std::regex_search(text, match, std::regex("\"" + key + "\": \"?([^\",\n]*)")))
      throw std::runtime_error(directory + "/summary.json has no " + key);
    return match[1];
  }
} // namespace akmon::test
