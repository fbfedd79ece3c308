#pragma once

#include <akmon/simulation.h>

#include <map>
#include <string>
#include <vector>

namespace akmon::test
{
  /// The columns of a history.csv.
  class Table
  {
  public:
    explicit Table(const std::string &path);

    /// A column by name; throws std::out_of_range with the name if there is none.
    const std::vector<double> &
    operator[](const std::string &column) const;

    const std::vector<std::string> &
    columns() const
    {
      return names;
    }

    std::size_t
    n_rows() const;

    /// Rows with begin <= time <= end.
    std::vector<std::size_t>
    rows_between(const double begin, const double end) const;

  private:
    std::vector<std::string> names;
    std::map<std::string, std::vector<double>> values;
  };


  /// A directory for a test's files, removed with the object.
  class ScratchDirectory
  {
  public:
    ScratchDirectory();
    ~ScratchDirectory();
    ScratchDirectory(const ScratchDirectory &) = delete;
    ScratchDirectory &
    operator=(const ScratchDirectory &) = delete;

    const std::string path;
  };


  /// Path of a shipped case, "two_bars" -> ".../prm/two_bars.prm".
  std::string
  shipped(const std::string &name);

  /**
   * Run a case in this process, on this process alone, and return its history. Fields are not
   * written unless asked for. Throws what Simulation throws.
   */
  Table
  run_case(const std::string &file, std::vector<std::string> overrides = {});

  /**
   * Run a case with the program itself on several ranks; returns its history. Throws
   * std::runtime_error with the program's output if it fails.
   */
  Table
  run_case_on_ranks(const std::string &file,
                    const unsigned int n_ranks,
                    const std::vector<std::string> &overrides = {});

  /// What a finished command printed (both streams) and its exit status.
  struct CommandResult
  {
    int status;
    std::string output;
  };

  /// Run the akmon program with arguments (each quoted) and wait for it.
  CommandResult
  run_program(const std::vector<std::string> &arguments, const unsigned int n_ranks = 1);
} // namespace akmon::test
