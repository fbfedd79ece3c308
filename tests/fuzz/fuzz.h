#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>

namespace akmon::fuzz
{
  /// A file of this process with the input as content.
  inline std::string
  input_file(const std::string &name, const std::uint8_t *const data, const std::size_t size)
  {
    static const std::string directory = []() {
      std::string pattern = (std::filesystem::temp_directory_path() / "akmon-fuzz-XXXXXX").string();
      return std::string(mkdtemp(pattern.data()));
    }();
    const std::string path = directory + "/" + name;
    std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char *>(data), size);
    return path;
  }


  /// A refusal must be one line.
  inline void
  expect_one_line(const std::string &message)
  {
    if (message.empty() || message.find('\n') != std::string::npos)
      {
        std::fprintf(stderr, "not one line: '%s'\n", message.c_str());
        std::abort();
      }
  }
} // namespace akmon::fuzz
