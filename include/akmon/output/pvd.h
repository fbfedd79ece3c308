#pragma once

#include <deal.II/base/mpi.h>

#include <string>
#include <utility>
#include <vector>

namespace akmon
{
  /// The .pvd file that tells ParaView the physical time of each field file.
  class PvdSeries
  {
  public:
    /// @param path the .pvd file to write; replaced with the first add()
    PvdSeries(const std::string &path, const MPI_Comm comm);

    /**
     * Append a field file at this physical time and rewrite the series in one move: a killed run
     * leaves a valid file. The name is relative to the .pvd file. Collective; all ranks throw
     * std::runtime_error (path and reason) if it cannot be written.
     */
    void
    add(const double time, const std::string &vtu_file);

    std::size_t
    size() const
    {
      return times_and_files.size();
    }

    /// Physical times of the files so far.
    std::vector<double>
    times() const;

    /// Start from a series that an earlier part of the run has written: the next add() rewrites it.
    void
    continue_from(const std::vector<std::pair<double, std::string>> &earlier)
    {
      times_and_files = earlier;
    }

  private:
    const std::string path;
    const MPI_Comm comm;
    std::vector<std::pair<double, std::string>> times_and_files;
  };
} // namespace akmon
