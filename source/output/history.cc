#include <akmon/output/directory.h>
#include <akmon/output/history.h>
#include <akmon/parameters.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <unistd.h>

namespace akmon
{
  namespace
  {
    void
    append(std::string &line, const std::string &entry)
    {
      if (!line.empty())
        line += ',';
      line += entry;
    }
  } // namespace


  History::History(const std::string &path, const MPI_Comm comm)
    : path(path)
    , comm(comm)
  {
  }


  void
  History::add_column(const std::string &name)
  {
    if (header_written)
      throw std::logic_error("History: column '" + name + "' comes after the first row");
    columns.push_back(name);
  }


  void
  History::add_columns(const std::vector<std::string> &names)
  {
    for (const auto &name : names)
      add_column(name);
  }


  void
  History::write_row(const std::vector<double> &values)
  {
    if (values.size() != columns.size())
      throw std::logic_error("History: " + std::to_string(values.size()) + " values for " +
                             std::to_string(columns.size()) + " columns");
    run_on_root(comm, [&]() {
      if (!header_written)
        {
          file.reset(std::fopen(path.c_str(), "wb"));
          write_line(header());
        }
      std::string row;
      for (const double value : values)
        append(row, shortest_text(value));
      write_line(row);
    });
    header_written = true;
  }


  std::string
  History::header() const
  {
    std::string line;
    for (const auto &name : columns)
      append(line, name);
    return line;
  }


  std::uint64_t
  History::secure()
  {
    std::uint64_t size = 0;
    run_on_root(comm, [&]() {
      if (!file)
        return;
      if (fsync(fileno(file.get())) != 0)
        throw std::runtime_error("cannot write '" + path + "': " + std::strerror(errno));
      size = std::ftell(file.get());
    });
    return size;
  }


  void
  History::check_beginning(const std::uint64_t size) const
  {
    try
      {
        run_on_root(comm, [&]() {
          std::ifstream in(path);
          std::string line;
          if (size > 0 && (!std::getline(in, line) || std::filesystem::file_size(path) < size))
            throw std::runtime_error(
              "'" + path + "' lacks rows that were there when the checkpoint was written");
          if (size > 0 && line != header())
            throw std::runtime_error("'" + path + "' has other columns than the case now");
        });
      }
    catch (const std::runtime_error &error)
      {
        throw InputError(error.what());
      }
  }


  void
  History::continue_behind(const std::uint64_t size)
  {
    if (size == 0)
      return; // no row yet
    run_on_root(comm, [&]() {
      std::filesystem::resize_file(path, size);
      file.reset(std::fopen(path.c_str(), "ab"));
      if (!file || std::fseek(file.get(), 0, SEEK_END) != 0)
        throw std::runtime_error("cannot write '" + path + "': " + std::strerror(errno));
    });
    header_written = true;
  }


  void
  History::write_line(const std::string &line)
  {
    // Flushed, so that a run that is watched or dies shows every row, and a full disk shows at
    // once.
    if (!file || std::fputs((line + '\n').c_str(), file.get()) < 0 || std::fflush(file.get()) != 0)
      throw std::runtime_error("cannot write '" + path + "': " + std::strerror(errno));
  }
} // namespace akmon
