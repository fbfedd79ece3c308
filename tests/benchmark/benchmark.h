#pragma once

#include "machine.h"

namespace akmon::benchmark
{
  /// Print the throughput of stress update and internal forces on a block, beyond the caches and
  /// within.
  void
  measure_cell_pass(const Machine &machine);

  /// Print the throughput of whole steps of the copper Taylor bar with output off, large and small.
  void
  measure_whole_step();

  /// Print who holds the memory of a million cells ready to run, and what set-up takes.
  void
  measure_memory();
} // namespace akmon::benchmark
