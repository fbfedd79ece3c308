#include "support/run_case.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <sys/wait.h>

namespace akmon::test
{
  namespace
  {
    std::string
    make_scratch_path()
    {
      std::string pattern = (std::filesystem::temp_directory_path() / "akmon-test-XXXXXX").string();
      if (!mkdtemp(pattern.data()))
        throw std::runtime_error("no scratch directory");
      return pattern;
    }


    std::string
    quoted(const std::string &argument)
    {
      std::string result = "'";
      for (const char c : argument)
        result += c == '\'' ? std::string("'\\''") : std::string(1, c);
      return result + "'";
    }
  } // namespace


  Table::Table(const std::string &path)
  {
    std::ifstream in(path);
    std::string line, cell;
    if (!std::getline(in, line))
      throw std::runtime_error(path + " is empty or absent");
    for (std::istringstream header(line); std::getline(header, cell, ',');)
      names.push_back(cell);
    while (std::getline(in, line))
      {
        std::istringstream row(line);
        for (const auto &name : names)
          {
            if (!std::getline(row, cell, ','))
              throw std::runtime_error(path + " has a short row");
            values[name].push_back(std::stod(cell));
          }
      }
  }


  const std::vector<double> &
  Table::operator[](const std::string &column) const
  {
    const auto found = values.find(column);
    if (found == values.end())
      throw std::out_of_range("no column " + column);
    return found->second;
  }


  std::size_t
  Table::n_rows() const
  {
    return (*this)["time"].size();
  }


  std::vector<std::size_t>
  Table::rows_between(const double begin, const double end) const
  {
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < n_rows(); ++i)
      if ((*this)["time"][i] >= begin && (*this)["time"][i] <= end)
        rows.push_back(i);
    return rows;
  }


  ScratchDirectory::ScratchDirectory()
    : path(make_scratch_path())
  {
  }


  ScratchDirectory::~ScratchDirectory()
  {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }


  std::string
  shipped(const std::string &name)
  {
    return std::string(AKMON_SOURCE_DIR) + "/prm/" + name + ".prm";
  }


  Table
  run_case(const std::string &file, std::vector<std::string> overrides)
  {
    const ScratchDirectory scratch;
    overrides.insert(overrides.begin(),
                     {"Output directory=" + scratch.path,
                      "Output/Fields interval=0",
                      "Output/Fields steps=0"});
    Simulation simulation(Case::read(file, overrides), MPI_COMM_SELF, true);
    simulation.run();
    return Table(scratch.path + "/history.csv");
  }


  Table
  run_case_on_ranks(const std::string &file,
                    const unsigned int n_ranks,
                    const std::vector<std::string> &overrides)
  {
    const ScratchDirectory scratch;
    std::vector<std::string> arguments = {file,
                                          "--set",
                                          "Output directory=" + scratch.path,
                                          "--set",
                                          "Output/Fields interval=0",
                                          "--set",
                                          "Output/Fields steps=0"};
    for (const auto &entry : overrides)
      {
        arguments.emplace_back("--set");
        arguments.push_back(entry);
      }
    const auto result = run_program(arguments, n_ranks);
    if (result.status != 0)
      throw std::runtime_error(result.output);
    return Table(scratch.path + "/history.csv");
  }


  CommandResult
  run_program(const std::vector<std::string> &arguments, const unsigned int n_ranks)
  {
    // Processes started inside an MPI process must not take it for their parent.
    std::string command =
      "env -u OMPI_MCA_ess -u PMIX_RANK -u PMIX_NAMESPACE -u OMPI_COMM_WORLD_RANK -u OMPI_COMM_WORLD_SIZE ";
    if (n_ranks > 1)
      command += "mpirun --oversubscribe --bind-to none -np " + std::to_string(n_ranks) + " ";
    command += quoted(AKMON_PROGRAM);
    for (const auto &argument : arguments)
      command += " " + quoted(argument);
    command += " 2>&1 </dev/null";

    CommandResult result;
    std::FILE *pipe = popen(command.c_str(), "r");
    if (!pipe)
      throw std::runtime_error("cannot run " + command);
    char buffer[4096];
    for (std::size_t n; (n = std::fread(buffer, 1, sizeof(buffer), pipe)) > 0;)
      result.output.append(buffer, n);
    const int status = pclose(pipe);
    result.status    = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
    return result;
  }
} // namespace akmon::test
