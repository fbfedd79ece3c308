#pragma once

#include <akmon/model/body.h>

#include <vector>

namespace akmon
{
  /**
   * Refuse bodies whose meshes cannot fit into the memory of this machine, before any is made.
   * Throws InputError naming the body with the most cells.
   */
  void
  refuse_too_large_meshes(const std::vector<Body> &bodies);
} // namespace akmon
