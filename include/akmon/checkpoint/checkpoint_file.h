#pragma once

#include <deal.II/base/mpi.h>

#include <cstdint>
#include <string>
#include <vector>

namespace akmon
{
  /// The format of the checkpoints that this version writes and reads. Goes up with every change.
  constexpr unsigned int checkpoint_format = 3;

  /// Bytes before the HDF5 part of a checkpoint (HDF5's user block).
  constexpr std::uint64_t checkpoint_header_size = 512;

  /**
   * Close a complete checkpoint: writes the header (lines of text: program, format, size and CRC-32
   * of what follows) and brings file and name to the disk, in this order. Collective; throws
   * std::runtime_error on all ranks.
   * @param temporary  the file as written
   * @param path       its name from now on
   */
  void
  seal_checkpoint(const std::string &temporary, const std::string &path, const MPI_Comm comm);

  /**
   * Refuse a file that is no checkpoint, of another format, incomplete or with a byte changed
   * anywhere. Collective; throws InputError on all ranks.
   */
  void
  verify_checkpoint(const std::string &path, const MPI_Comm comm);

  /// "DIRECTORY/checkpoint_000000001234.h5", so that names sort by step.
  std::string
  checkpoint_path(const std::string &directory, const unsigned long step);

  /// The checkpoints of a directory, oldest first (local to the calling rank).
  std::vector<std::string>
  list_checkpoints(const std::string &directory);
} // namespace akmon
