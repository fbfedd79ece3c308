#include <akmon/model/hexahedron_cell.h>

#include <boost/property_tree/json_parser.hpp>
#include <gtest/gtest.h>

#include "support/assembled_system.h"
#include "support/critical_step.h"
#include "support/run_case.h"

// The critical step of the Taylor bar through its deformation against the assembled system's own,
// and what mass scaling says of itself.

namespace assembled_step
{
  using namespace akmon;
  using namespace akmon::test;

  // A quarter of 288 cells until a time.
  std::vector<std::string>
  quarter_until(const double end, const std::string &directory)
  {
    return {"Output directory=" + directory,
            "Output/Fields interval=0",
            "Output/History steps=0",
            "Time/Critical step=assembled",
            "Bodies/bar/Cylinder/Cells across=4",
            "Bodies/bar/Cylinder/Cells radial=2",
            "Bodies/bar/Cylinder/Cells axial=24",
            "Time/End=" + std::to_string(1e6 * end) + "e-6"};
  }


  TEST(AssembledStep, OfTheTaylorBarIsCloseToTheTrueOneAndNeverAbove)
  {
    for (const double end : {.3e-6, 1e-6, 3e-6, 6e-6, 10e-6, 15e-6, 22e-6, 30e-6, 45e-6, 80e-6})
      {
        const ScratchDirectory scratch;
        Simulation simulation(Case::read(shipped("taylor_bar_quarter"),
                                         quarter_until(end, scratch.path)),
                              MPI_COMM_SELF,
                              true);
        simulation.run();
        const double exact = assembled_frequency_squared(simulation.model(),
                                                         simulation.current_state().x);
        const double ratio = ratio_of_steps(simulation.frequency().bound(), exact);
        std::cout << 1e6 * end << " microseconds, " << simulation.current_state().step << " steps, "
                  << simulation.frequency().n_estimates() << " estimates with "
                  << simulation.frequency().n_applications() / simulation.model().cells.size()
                  << " passes: estimated over true step " << ratio << ", of cells "
                  << ratio_of_steps(simulation.stresses().largest_cell_bound(), exact) << std::endl;
        EXPECT_LE(ratio, 1.);
        EXPECT_GE(ratio, 0.97);
      }
  }


  // Three steps of 1.5e-7 where the critical step is 1.2e-7.
  TEST(MassScaling, ReachesTheStepAndTellsTheAddedMass)
  {
    const ScratchDirectory scratch;
    auto overrides = quarter_until(4.5e-7, scratch.path);
    overrides.push_back("Time/Mass scaling step=1.5e-7");
    Simulation simulation(Case::read(shipped("taylor_bar_quarter"), overrides),
                          MPI_COMM_SELF,
                          true);
    simulation.run();
    boost::property_tree::ptree summary;
    boost::property_tree::read_json(scratch.path + "/summary.json", summary);
    const auto &model = simulation.model();
    double mass       = 0.;
    for (unsigned int node = 0; node < model.n_owned_nodes; ++node)
      mass += model.mass[node];
    double volume = 0.;
    HexahedronCell hexahedron;
    for (const auto &cell : model.cells)
      volume += hexahedron.at(model.corners_of(cell))->measure();
    const double added = summary.get<double>("added_mass_rel");
    std::cout << "added mass " << added << std::endl;
    EXPECT_LE(simulation.current_state().step, 3u);
    EXPECT_NEAR(mass / (8930. * volume), 1. + added, 1e-9);
    EXPECT_GT(added, .05);
    bool warned = false;
    for (const auto &warning : summary.get_child("warnings"))
      warned = warned || warning.second.data().find("mass scaling adds") == 0;
    EXPECT_TRUE(warned);
  }
} // namespace assembled_step
