#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <memory>

#include "support/run_case.h"

// A run of a case of which more than the history is asked afterwards.

namespace akmon::test
{
  struct KeptRun
  {
    Table history;
    std::unique_ptr<Simulation> simulation;
  };


  /// As run_case(), with the simulation at its end.
  inline KeptRun
  run_and_keep(const std::string &file, std::vector<std::string> overrides = {})
  {
    const ScratchDirectory scratch;
    overrides.insert(overrides.begin(),
                     {"Output directory=" + scratch.path,
                      "Output/Fields interval=0",
                      "Output/History steps=1"});
    auto simulation = std::make_unique<Simulation>(Case::read(file, overrides),
                                                   MPI_COMM_SELF,
                                                   true);
    simulation->run();
    Table history(scratch.path + "/history.csv");
    return {std::move(history), std::move(simulation)};
  }


  /// The same for a case that a test writes itself.
  inline KeptRun
  run_text(const std::string &text, const std::vector<std::string> &overrides)
  {
    const ScratchDirectory scratch;
    const std::string file = scratch.path + "/case.prm";
    std::ofstream(file) << text;
    return run_and_keep(file, overrides);
  }


  /// Mean velocity of every body at the end, by momentum; length/time.
  inline std::vector<dealii::Tensor<1, 3>>
  velocities_of_bodies(const Simulation &simulation)
  {
    const auto &state = simulation.current_state();
    const auto &model = simulation.model();
    std::vector<dealii::Tensor<1, 3>> momentum(model.get_bodies().size());
    std::vector<double> mass(momentum.size(), 0.);
    for (unsigned int node = 0; node < model.n_owned_nodes; ++node)
      {
        const unsigned int body = model.body_of_node[node];
        mass[body] += model.mass[node];
        momentum[body] += 0.5 * model.mass[node] *
                          (at_node(state.dx, node) / state.dt +
                           at_node(state.dx_next, node) / state.dt_next);
      }
    for (unsigned int body = 0; body < mass.size(); ++body)
      momentum[body] /= mass[body];
    return momentum;
  }


  /// Largest difference of a component (xx, yy, zz, xy, xz, yz) of the stress at any quadrature
  /// point of any body from the expected one; stress.
  inline double
  largest_stress_difference(const Simulation &simulation, const std::array<double, 6> &expected)
  {
    double largest = 0.;
    for (const auto &batches : simulation.stresses().batches())
      for (unsigned int batch = 0; batch < batches.n_batches(); ++batch)
        for (unsigned int q = 0; q < batches.n_points; ++q)
          for (unsigned int c = 0; c < 6; ++c)
            for (unsigned int lane = 0; lane < batches.n_used_lanes[batch]; ++lane)
              largest = std::max(largest,
                                 std::abs(
                                   batches.state_at(
                                     batch)[(q * batches.n_components + c) * n_lanes + lane] -
                                   expected[c]));
    return largest;
  }


  /// The largest magnitude of a column in all rows.
  inline double
  largest_of(const std::vector<double> &values)
  {
    double largest = 0.;
    for (const double value : values)
      largest = std::max(largest, std::abs(value));
    return largest;
  }


  /// Largest change of linear (or angular, about the origin) momentum since the start.
  inline double
  change_of_momentum(const Table &history, const std::string &kind = "momentum_")
  {
    double largest = 0.;
    for (const char *const axis : {"x", "y", "z"})
      {
        const auto &values = history[kind + axis];
        for (const double value : values)
          largest = std::max(largest, std::abs(value - values[0]));
      }
    return largest;
  }


  /// Mean iterations of a contact solution over the steps with closed pairs.
  inline double
  mean_iterations(const Table &history)
  {
    double sum = 0., n = 0.;
    for (std::size_t i = 0; i < history.n_rows(); ++i)
      if (history["active_pairs"][i] > 0.)
        {
          sum += history["contact_iterations"][i];
          n += 1.;
        }
    return n > 0. ? sum / n : 0.;
  }
} // namespace akmon::test
