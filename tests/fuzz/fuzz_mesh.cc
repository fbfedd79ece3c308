#include <akmon/model/mesh_file.h>
#include <akmon/parameters.h>
#include <akmon/rigid/triangle_mesh.h>

#include "fuzz.h"

// Any bytes as a mesh file, of cells or of an obstacle's surface; the first byte chooses the
// format.

extern "C" int
LLVMFuzzerTestOneInput(const std::uint8_t *const data, const std::size_t size)
{
  if (size == 0)
    return 0;
  const char *const endings[] = {".msh", ".inp", ".vtk", ".ucd", ".stl"};
  const std::string ending    = endings[data[0] % 5];
  const std::string file      = akmon::fuzz::input_file("mesh" + ending, data + 1, size - 1);
  try
    {
      if (ending == ".stl")
        {
          auto mesh = akmon::read_stl(file);
          for (const auto &repair : akmon::make_closed(mesh))
            akmon::fuzz::expect_one_line(repair);
          return 0;
        }
      akmon::FileShape shape;
      shape.name  = file;
      shape.scale = 1.;
      shape.make("Bodies/body");
    }
  catch (const akmon::InputError &error)
    {
      akmon::fuzz::expect_one_line(error.what());
    }
  catch (const std::runtime_error &error) // of the surface
    {
      akmon::fuzz::expect_one_line(error.what());
    }
  return 0;
}
