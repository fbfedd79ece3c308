#pragma once

#include <iostream>
#include <string>

namespace akmon::test
{
  /// A measured number, for the test's output.
  inline void
  report(const std::string &name, const double value)
  {
    std::cout << "  " << name << " " << value << std::endl;
  }
} // namespace akmon::test
