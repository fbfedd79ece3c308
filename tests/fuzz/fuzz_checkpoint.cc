#include <akmon/checkpoint/checkpoint.h>
#include <akmon/checkpoint/checkpoint_file.h>
#include <akmon/parameters.h>

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
    }
  catch (const akmon::InputError &error)
    {
      akmon::fuzz::expect_one_line(error.what());
      return 0;
    }
  const akmon::CheckpointReader reader(file);
  reader.integer("step");
  reader.numbers("time");
  reader.rows("x", 0, reader.size("x").first, [](const auto, const double *) {});
  return 0;
}
