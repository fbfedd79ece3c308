#include <akmon/model/mesh_file.h>
#include <akmon/parameters.h>

#include "fuzz.h"

// Any text as a mesh file; the first byte chooses the format.

extern "C" int
LLVMFuzzerTestOneInput(const std::uint8_t *const data, const std::size_t size)
{
  if (size == 0)
    return 0;
  const char *const endings[] = {".msh", ".inp", ".vtk", ".ucd"};
  akmon::FileShape shape;
  shape.name  = akmon::fuzz::input_file(std::string("mesh") + endings[data[0] % 4],
                                       data + 1,
                                       size - 1);
  shape.scale = 1.;
  try
    {
      shape.make("Bodies/body");
    }
  catch (const akmon::InputError &error)
    {
      akmon::fuzz::expect_one_line(error.what());
    }
  return 0;
}
