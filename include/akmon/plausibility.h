#pragma once

#include <akmon/case.h>
#include <akmon/model/discretization.h>

#include <string>
#include <vector>

namespace akmon
{
  /**
   * What looks like a mistake in a case that can be run: units that seem mixed, contacts that can
   * never close, bodies that nothing moves or holds, probes outside their bodies. One line each,
   * the same on all ranks (collective).
   * @param velocity  initial velocities of the nodes; length/time
   */
  std::vector<std::string>
  plausibility_warnings(const Case &parameters,
                        const Discretization &discretization,
                        const NodalVector &velocity);
} // namespace akmon
