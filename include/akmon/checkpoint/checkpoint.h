#pragma once

#include <akmon/checkpoint/hdf5.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace akmon
{
  /**
   * Writes a checkpoint: named numbers and texts of the run, and tables of numbers that the ranks
   * hold in consecutive stretches of rows. All functions are collective and throw
   * std::runtime_error on all ranks if the file cannot be written; the object then removes the
   * incomplete file. The file gets its name only with finish().
   */
  class CheckpointWriter
  {
  public:
    /// @param path  what the complete file will be called
    CheckpointWriter(const std::string &path, const MPI_Comm comm);
    ~CheckpointWriter();
    CheckpointWriter(const CheckpointWriter &) = delete;
    CheckpointWriter &
    operator=(const CheckpointWriter &) = delete;

    /// Numbers of the run; rank 0's are kept, their count is the same on all ranks.
    void
    numbers(const std::string &name, const std::vector<double> &values);

    void
    integer(const std::string &name, const std::uint64_t value);

    void
    text(const std::string &name, const std::string &value);

    /// A rank's part of sums over all ranks.
    void
    part_of_rank(const std::string &name, const std::vector<double> &values);

    using FillRow = std::function<void(const std::size_t row, double *const values)>;

    /**
     * A table; this rank's rows come behind those of lower ranks.
     * @param width  numbers in a row, the same on all ranks
     * @param fill   gives the values of one of this rank's rows
     */
    void
    table(const std::string &name,
          const std::size_t n_rows,
          const std::size_t width,
          const FillRow &fill);

    /// Complete the file and give it its name.
    void
    finish();

  private:
    void
    reserve_space(const std::uint64_t n_bytes);

    const std::string path, temporary;
    const MPI_Comm comm;
    std::uint64_t reserved = 0; ///< of the file system for the file; bytes
    bool finished          = false;
    Hdf5Id file;
  };


  /// Reads a checkpoint that was verified. Every rank reads on its own; throws std::runtime_error.
  class CheckpointReader
  {
  public:
    explicit CheckpointReader(const std::string &path);

    std::vector<double>
    numbers(const std::string &name) const;

    std::uint64_t
    integer(const std::string &name) const;

    std::string
    text(const std::string &name) const;

    /**
     * What part_of_rank() has saved. On as many ranks as then every rank gets its part, and sums
     * over ranks come out with the same bits; else rank 0 gets the sum of all and the others zeros.
     */
    std::vector<double>
    sum_of_rank(const std::string &name, const MPI_Comm comm) const;

    /// Numbers of rows and columns of a table.
    std::pair<std::size_t, std::size_t>
    size(const std::string &name) const;

    using TakeRow = std::function<void(const std::size_t row, const double *const values)>;

    /// Rows [begin, end) of a table, one after the other.
    void
    rows(const std::string &name,
         const std::size_t begin,
         const std::size_t end,
         const TakeRow &take) const;

  private:
    Hdf5Id file;
  };
} // namespace akmon
