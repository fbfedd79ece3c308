#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "support/files.h"
#include "support/run_case.h"

namespace akmon::test
{
  /// Arguments that run a case into a directory.
  inline std::vector<std::string>
  arguments_for(const std::string &file,
                const std::string &directory,
                const std::vector<std::string> &overrides)
  {
    std::vector<std::string> arguments = {file, "--set", "Output directory=" + directory};
    for (const auto &entry : overrides)
      {
        arguments.emplace_back("--set");
        arguments.push_back(entry);
      }
    return arguments;
  }


  /// Names of the checkpoints in a directory, oldest first.
  inline std::vector<std::string>
  checkpoints_in(const std::string &directory)
  {
    std::vector<std::string> names;
    for (const auto &entry : std::filesystem::directory_iterator(directory))
      if (entry.path().extension() == ".h5")
        names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }


  /// Names of the field files in a directory, in their order.
  inline std::vector<std::string>
  field_files_in(const std::string &directory)
  {
    std::vector<std::string> names;
    for (const auto &entry : std::filesystem::directory_iterator(directory))
      if (entry.path().extension() == ".vtu")
        names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }


  /// The entries of a directory's fields.pvd, which begins with a date.
  inline std::string
  series_in(const std::string &directory)
  {
    const std::string text = file_content(directory + "/fields.pvd");
    return text.substr(std::min(text.size(), text.find("<Collection>")));
  }


  /// Expects that two runs ended in the same state and have written the same rows and field series.
  inline void
  expect_same_run(const std::string &a, const std::string &b)
  {
    EXPECT_EQ(summary_value(a, "completed"), "true");
    EXPECT_EQ(summary_value(a, "state_hash"), summary_value(b, "state_hash"));
    EXPECT_EQ(summary_value(a, "steps"), summary_value(b, "steps"));
    EXPECT_EQ(file_content(a + "/history.csv"), file_content(b + "/history.csv"));
    EXPECT_EQ(file_content(a + "/contact.csv"), file_content(b + "/contact.csv"));
    EXPECT_EQ(series_in(a), series_in(b));
    EXPECT_EQ(field_files_in(a), field_files_in(b));
  }
} // namespace akmon::test
