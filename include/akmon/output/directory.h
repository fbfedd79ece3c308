#pragma once

#include <deal.II/base/mpi.h>

#include <cstddef>
#include <functional>
#include <string>

namespace akmon
{
  /**
   * Make the output directory of a run ready: create it with its parents, prove that files can be
   * written into it, and remove the result files an earlier run of Akmon left there (fields.pvd,
   * fields_*.vtu, history.csv, contact.csv, summary.json, parameters.prm, checkpoint*). All other
   * files stay. Collective; on failure all ranks throw InputError, before anything has been
   * removed. A run that restarts from this directory must not call it.
   */
  void
  prepare_output_directory(const std::string &path, const MPI_Comm comm);

  /**
   * Make the output directory ready for a run that goes on from a checkpoint of this step: remove
   * what the run had written after it (checkpoints, field files from number @p n_field_files on)
   * and incomplete files. Collective; all ranks throw RunError (output_failed).
   */
  void
  remove_results_behind(const std::string &path,
                        const unsigned long step,
                        const std::size_t n_field_files,
                        const MPI_Comm comm);

  /**
   * Run a task on rank 0 only. Collective: when the task throws a std::exception, all ranks throw a
   * RunError (output_failed) with its message, so that no rank is left waiting for the others.
   */
  void
  run_on_root(const MPI_Comm comm, const std::function<void()> &task);

  /**
   * Replace a file by this content in one move: a run killed at any moment leaves the old or the
   * new file, never a part. Local to the calling rank; throws std::runtime_error (path, reason).
   */
  void
  replace_file(const std::string &path, const std::string &content);
} // namespace akmon
