#include <akmon/output/directory.h>
#include <akmon/output/vtu_file.h>

#include <sstream>
#include <stdexcept>

namespace akmon
{
  using namespace dealii;

  // The operating system knows why a file cannot be created.
  VtuFile::VtuFile(const std::string &path,
                   const PatchValues &values,
                   const DataOutBase::VtkFlags &flags,
                   const MPI_Comm communicator)
    : path(path)
    , values(values)
    , flags(flags)
    , communicator(communicator)
  {
    run_on_root(communicator, [&]() {
      replace_file(path, "");
      file.open(path, std::ios::binary);
      DataOutBase::write_vtu_header(file, flags);
    });
  }


  void
  VtuFile::add(const std::vector<DataOutBase::Patch<3, 3>> &patches)
  {
    std::string text;
    if (!patches.empty())
      {
        std::ostringstream piece;
        DataOutBase::write_vtu_main(patches, values.names, values.groups, flags, piece);
        text = piece.str();
      }
    // Rank by rank, for as many pieces need not fit into the first one's memory.
    const unsigned int me = Utilities::MPI::this_mpi_process(communicator);
    if (me != 0)
      MPI_Send(text.data(), text.size(), MPI_CHAR, 0, 0, communicator);
    else
      for (unsigned int rank = 0; rank < Utilities::MPI::n_mpi_processes(communicator); ++rank)
        {
          if (rank != 0)
            {
              MPI_Status status;
              int size;
              MPI_Probe(rank, 0, communicator, &status);
              MPI_Get_count(&status, MPI_CHAR, &size);
              text.resize(size);
              MPI_Recv(text.data(), size, MPI_CHAR, rank, 0, communicator, MPI_STATUS_IGNORE);
            }
          file << text;
        }
  }


  void
  VtuFile::finish()
  {
    run_on_root(communicator, [&]() {
      DataOutBase::write_vtu_footer(file);
      file.close();
      if (!file)
        throw std::runtime_error("cannot write '" + path + "'; is the disk full?");
    });
  }
} // namespace akmon
