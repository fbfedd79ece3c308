#pragma once

#include <akmon/forces/internal_forces.h>
#include <akmon/model/nodal_state.h>

#include <cstdint>

namespace akmon
{
  /// A number that two models share only if mesh, bodies, masses and the numbers of internal
  /// variables are the same bits. The same on any number of ranks (collective).
  std::uint64_t
  fingerprint(const Discretization &discretization);

  /// A number that two states share only if time, positions, both increments and all stresses and
  /// internal variables are the same bits. The same on any number of ranks (collective).
  std::uint64_t
  state_hash(const Discretization &discretization,
             const NodalState &state,
             const InternalForces &internal_forces);
} // namespace akmon
