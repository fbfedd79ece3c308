#pragma once

namespace akmon::benchmark
{
  /// What one core of the machine can do at best.
  struct Machine
  {
    double flops_per_second; ///< independent fused multiply-adds in registers, two flops each
    double bytes_per_second; ///< triad a = b + s c far beyond any cache, 24 bytes an entry
                             ///< (STREAM's count)
  };

  /// Measure it now, so that it is comparable with what is measured next.
  Machine
  measure_machine();

  /// Processor time this process has used, s. On a busy machine it says more than the clock on the
  /// wall.
  double
  processor_seconds();
} // namespace akmon::benchmark
