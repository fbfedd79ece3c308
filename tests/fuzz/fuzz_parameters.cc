#include <akmon/case.h>
#include <akmon/parameters.h>

#include "fuzz.h"

// Any text as a parameter file: a case, or a refusal in one line.

extern "C" int
LLVMFuzzerTestOneInput(const std::uint8_t *const data, const std::size_t size)
{
  const std::string file = akmon::fuzz::input_file("case.prm", data, size);
  try
    {
      akmon::Case::read(file, {});
    }
  catch (const akmon::InputError &error)
    {
      akmon::fuzz::expect_one_line(error.what());
    }
  return 0;
}
