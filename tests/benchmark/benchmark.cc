// Throughput per core: the cell pass (stress update and internal forces) against what the machine
// can do at best, and whole steps of the copper Taylor bar. Every figure is processor time, the
// best of several repetitions where there are any. Usage: akmon_benchmark [cell-pass] [whole-step]
// [memory]; all if none is given. Under mpirun rank 0 reports.

#include "benchmark.h"

#include <akmon/simd.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

int
main(int argc, char **argv)
{
  using namespace akmon::benchmark;

  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const std::vector<std::string> parts(argv + 1, argv + argc);
  const auto wanted = [&](const char *part) {
    return parts.empty() || std::find(parts.begin(), parts.end(), part) != parts.end();
  };
  for (const auto &part : parts)
    if (part != "cell-pass" && part != "whole-step" && part != "memory")
      {
        std::fprintf(
          stderr,
          "akmon_benchmark: unknown part '%s'; allowed are cell-pass, whole-step, memory\n",
          part.c_str());
        return 1;
      }

  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) != 0 &&
      !std::freopen("/dev/null", "w", stdout))
    return 1;
  const Machine machine = measure_machine();
  std::printf("machine, per core: %u SIMD lanes, fused multiply-adds %.1f GF/s, triad %.1f GB/s\n",
              akmon::n_lanes,
              1e-9 * machine.flops_per_second,
              1e-9 * machine.bytes_per_second);
  if (wanted("cell-pass"))
    measure_cell_pass(machine);
  if (wanted("whole-step"))
    measure_whole_step();
  if (wanted("memory"))
    measure_memory();
  return 0;
}
