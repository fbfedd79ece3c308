#pragma once

#include <akmon/output/text.h>

#include <deal.II/base/mpi.h>

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace akmon
{
  /**
   * The time history of a run: a CSV file with a header of column names and one row per call, on
   * the disk when the call returns. Numbers are in the units of the run and lose no digit.
   */
  class History
  {
  public:
    /// The file is opened, and an existing one replaced, with the first row.
    History(const std::string &path, const MPI_Comm comm);

    /// Append a column. Throws std::logic_error once a row has been written.
    void
    add_column(const std::string &name);

    /// Append columns in this order; see add_column().
    void
    add_columns(const std::vector<std::string> &names);

    /**
     * Write one value per column; the values of rank 0 count. Collective. Throws std::logic_error
     * if the number of values is not that of the columns, and on all ranks std::runtime_error (path
     * and reason) if the file cannot be written.
     */
    void
    write_row(const std::vector<double> &values);

    /**
     * Bring all rows to the disk and return the size of the file in bytes, on rank 0 (collective);
     * throws as write_row().
     */
    std::uint64_t
    secure();

    /**
     * Check that the file starts with this run's header and has at least @p size bytes
     * (collective). Throws InputError.
     */
    void
    check_beginning(const std::uint64_t size) const;

    /// Go on behind the first @p size bytes of an existing file and drop the rest (collective).
    void
    continue_behind(const std::uint64_t size);

  private:
    std::string
    header() const;

    struct CloseFile
    {
      void
      operator()(std::FILE *file) const
      {
        std::fclose(file);
      }
    };

    void
    write_line(const std::string &line);

    const std::string path;
    const MPI_Comm comm;
    std::vector<std::string> columns;
    bool header_written = false;
    std::unique_ptr<std::FILE, CloseFile> file;
  };
} // namespace akmon
