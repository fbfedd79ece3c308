#include <akmon/checkpoint/checkpoint.h>
#include <akmon/checkpoint/checkpoint_file.h>

#include <stdexcept>

#include "fuzz.h"

// Any bytes as a checkpoint: refused in one line, or readable.

extern "C" int
LLVMFuzzerInitialize(int *argc, char ***argv)
{
  MPI_Init(argc, argv);
  return 0;
}


extern "C" int
LLVMFuzzerTestOneInput(const std::uint8_t *const data, const std::size_t size)
{
  const std::string file = akmon::fuzz::input_file("checkpoint.h5", data, size);
  try
    {
      akmon::verify_checkpoint(file, MPI_COMM_SELF);
      const akmon::CheckpointReader reader(file); // what fits its checksum may be no HDF5 file
      reader.integer("step");
      reader.numbers("time");
      reader.rows("x", 0, reader.size("x").first, [](const auto, const double *) {});
    }
  catch (const std::runtime_error &error)
    {
      akmon::fuzz::expect_one_line(error.what());
    }
  return 0;
}
