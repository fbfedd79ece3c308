#include <akmon/simulation.h>

#include <boost/property_tree/json_parser.hpp>

#include <cstdio>
#include <filesystem>
#include <string>

#include "benchmark.h"

namespace akmon::benchmark
{
  namespace
  {
    struct Cylinder
    {
      unsigned int across, radial, axial;
      const char *integration = "mean dilatation";
    };


    struct Run
    {
      double seconds      = 0.; ///< processor time from the first step to the last
      unsigned long steps = 0;
      std::size_t n_cells = 0; ///< of this rank
    };


    Run
    run(const Cylinder &mesh, const double end, const std::string &directory)
    {
      const std::string cylinder = "Bodies/bar/Cylinder/Cells ";
      const auto parameters      = Case::read(std::string(AKMON_SOURCE_DIR) + "/prm/taylor_bar.prm",
                                         {"Output directory=" + directory,
                                               "Output/Fields interval=0",
                                               "Output/History steps=0",
                                               "Time/End=" + std::to_string(1e6 * end) + "e-6",
                                               cylinder + "across=" + std::to_string(mesh.across),
                                               cylinder + "radial=" + std::to_string(mesh.radial),
                                               cylinder + "axial=" + std::to_string(mesh.axial),
                                               std::string("Bodies/bar/Integration=") +
                                                 mesh.integration});
      Simulation simulation(parameters, MPI_COMM_WORLD, true);
      const double start = processor_seconds();
      simulation.run();
      return {processor_seconds() - start,
              simulation.current_state().step,
              simulation.model().n_owned_cells};
    }


    // The shares of the stages in the longer run; clock on the wall.
    void
    print_stages(const std::string &directory)
    {
      boost::property_tree::ptree summary;
      boost::property_tree::read_json(directory + "/summary.json", summary);
      double sum = 0.;
      for (const auto &[name, seconds] : summary.get_child("stage_seconds"))
        if (name != "output.write")
          sum += seconds.get_value<double>();
      for (const auto &[name, seconds] : summary.get_child("stage_seconds"))
        if (name != "output.write")
          std::printf("    %-30s %5.1f %%\n",
                      name.c_str(),
                      100. * seconds.get_value<double>() / sum);
    }
  } // namespace


  void
  measure_whole_step()
  {
    const auto directory = (std::filesystem::temp_directory_path() / "akmon_benchmark").string();
    const bool root      = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
    for (const Cylinder &mesh : {Cylinder{24, 12, 116},
                                 Cylinder{10, 5, 54},
                                 Cylinder{24, 12, 116, "one point"},
                                 Cylinder{10, 5, 54, "one point"}})
      {
        // What both runs do before and after their steps (first and last fields) cancels in the
        // difference.
        const double end = 32.4e-3 / mesh.axial / 4000.; // a few tens of steps
        // Small meshes take more steps: as many seconds.
        const Run few  = run(mesh, end, directory);
        const Run many = run(mesh, mesh.axial > 100 ? 6. * end : 51. * end, directory);
        if (!root)
          continue;
        std::printf(
          "\nwhole step, copper Taylor bar, %s, %zu cells of this rank, output off, %lu steps\n"
          "  %-30s %7.2f M cell-steps/s\n",
          mesh.integration,
          many.n_cells,
          many.steps - few.steps,
          "per core",
          1e-6 * many.n_cells * (many.steps - few.steps) / (many.seconds - few.seconds));
        print_stages(directory);
      }
    if (root)
      std::filesystem::remove_all(directory);
  }
} // namespace akmon::benchmark
