#pragma once

#include <deal.II/base/data_out_base.h>
#include <deal.II/base/mpi.h>

#include <fstream>
#include <string>
#include <tuple>
#include <vector>

namespace akmon
{
  /// What the values of a deal.II patch mean: a name for each of them, and which make a vector or
  /// a tensor (first, last, name, interpretation).
  struct PatchValues
  {
    std::vector<std::string> names;
    std::vector<std::tuple<unsigned int,
                           unsigned int,
                           std::string,
                           dealii::DataComponentInterpretation::DataComponentInterpretation>>
      groups;
  };


  /**
   * A .vtu file that takes the patches of all ranks piece by piece, so that they need not be in
   * memory together. deal.II makes the text, the first rank writes it. All functions are
   * collective; the file is complete when finish() returns.
   */
  class VtuFile
  {
  public:
    /// Throws RunError (output_failed) with the system's reason if the file cannot be made.
    VtuFile(const std::string &path,
            const PatchValues &values,
            const dealii::DataOutBase::VtkFlags &flags,
            const MPI_Comm communicator);

    /// Add a piece of every rank that has patches.
    void
    add(const std::vector<dealii::DataOutBase::Patch<3, 3>> &patches);

    /// Throws RunError (output_failed) if the file is not complete on the disk.
    void
    finish();

  private:
    const std::string path;
    const PatchValues &values;
    const dealii::DataOutBase::VtkFlags flags;
    const MPI_Comm communicator;
    std::ofstream file; ///< open on the first rank only
  };
} // namespace akmon
