#pragma once

#include <akmon/material/hypoelastic.h>
#include <akmon/material/j2_plastic.h>

#include <variant>

namespace akmon
{
  /// Every material law, chosen by its `name` in the prm. A new law is a header and a line here.
  using MaterialLaw = std::variant<Hypoelastic, J2Plastic>;
} // namespace akmon
