#include <akmon/simulation.h>

#include <deal.II/base/mpi.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "benchmark.h"

namespace akmon::benchmark
{
  namespace
  {
    // A line of the kernel's account of this process, e.g. VmHWM, the peak resident set; bytes.
    double
    process_memory(const std::string &name)
    {
      std::ifstream status("/proc/self/status");
      for (std::string word; status >> word;)
        if (word == name + ":")
          {
            double kilobytes;
            status >> kilobytes;
            return 1024. * kilobytes;
          }
      return 0.;
    }


    template <typename T>
    double
    bytes_of(const std::vector<T> &vector)
    {
      return double(vector.capacity()) * sizeof(T);
    }


    double
    bytes_of(const std::vector<CellBatches> &bodies)
    {
      double sum = 0.;
      for (const auto &b : bodies)
        sum += 8. * (b.owned.capacity() + b.state.capacity() + b.hourglass.capacity() +
                     b.eroded.capacity() + b.frequencies.capacity()) +
               4. * b.node_offsets.capacity() + b.n_used_lanes.capacity() +
               b.has_eroded.capacity() + b.watched.capacity();
      return sum;
    }
  } // namespace


  void
  measure_memory()
  {
    // A million cells of the copper Taylor bar: made ready, then some steps with field output.
    const auto directory = (std::filesystem::temp_directory_path() / "akmon_benchmark").string();
    const std::string cylinder = "Bodies/bar/Cylinder/Cells ";
    const auto parameters      = Case::read(std::string(AKMON_SOURCE_DIR) + "/prm/taylor_bar.prm",
                                       {"Output directory=" + directory,
                                             "Time/End=2e-7",
                                             "Output/Fields interval=1",
                                             cylinder + "across=40",
                                             cylinder + "radial=20",
                                             cylinder + "axial=210"});
    const double before = process_memory("VmRSS"), start = processor_seconds();
    Simulation simulation(parameters, MPI_COMM_WORLD, true);
    const double seconds = processor_seconds() - start;
    const auto &model    = simulation.model();
    const double n       = model.n_global_cells;
    const auto line      = [&](const char *name, const double bytes) {
      std::printf("  %-44s %7.0f bytes/cell\n",
                  name,
                  dealii::Utilities::MPI::sum(bytes, MPI_COMM_WORLD) / n);
    };
    std::printf("\nmemory, copper Taylor bar, %.0f cells, sums over ranks\n", n);
    line("program and its libraries, before", before);
    line("peak resident set, ready to run", process_memory("VmHWM"));
    line("resident set, ready to run", process_memory("VmRSS"));
    line("batches", bytes_of(simulation.stresses().batches()));
    line("cell list", bytes_of(model.cells));
    line("nodal vectors, masses",
         8. * 3. * model.n_nodes * 5 + bytes_of(model.mass) + bytes_of(model.body_of_node));
    std::printf("  %-44s %7.1f microseconds/cell\n", "set-up, processor time", 1e6 * seconds / n);
    simulation.run();
    line("peak resident set after steps and output", process_memory("VmHWM"));
    line("resident set after steps and output", process_memory("VmRSS"));
  }
} // namespace akmon::benchmark
