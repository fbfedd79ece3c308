#pragma once

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

#include "support/run_case.h"

namespace akmon::test
{
  /// A bar along z after its impact on the plane z = 0, and how it got there. SI units.
  struct BarOnWall
  {
    std::size_t n_cells, n_steps;
    double length;           ///< from the lowest to the highest node
    double radius;           ///< largest distance from the axis of a node of the face
    double plastic_strain;   ///< largest at a Gauss point
    double kinetic_left;     ///< kinetic energy over (1/2) m v0^2
    double lift;             ///< of the highest node of the face
    double least_length;     ///< over time, at the probe top_rim
    double t_least_length;   ///< its time
    double t_least_kinetic;  ///< time of the least kinetic energy
    double lowest;           ///< z of the lowest node over the bar's initial length
    unsigned int n_closed;   ///< nodes in the wall's plane at the next level, up to round-off
    unsigned int n_active;   ///< pairs that carry a force
    double max_penetration;  ///< over the local cell size, worst step
    double max_energy_error; ///< worst step
    double momentum_error;   ///< of the momentum across the axis over m v0, worst step
  };


  /// Largest equivalent plastic strain (the first internal variable) over all Gauss points.
  inline double
  largest_plastic_strain(const InternalForces &forces)
  {
    double largest = 0.;
    for (const auto &batches : forces.batches())
      for (unsigned int batch = 0; batch < batches.n_batches(); ++batch)
        for (unsigned int q = 0; q < batches.n_points; ++q)
          for (unsigned int lane = 0; lane < batches.n_used_lanes[batch]; ++lane)
            largest = std::max(largest,
                               batches.state_at(
                                 batch)[(q * batches.n_components + 6) * n_lanes + lane]);
    return largest;
  }


  /// What the nodes and Gauss points say at the end.
  inline void
  measure_shape(const Simulation &simulation, const double speed, BarOnWall &bar)
  {
    const Discretization &model = simulation.model();
    const NodalState &state     = simulation.current_state();
    double initial_length = 0., highest = 0., lowest = 1e300;
    for (unsigned int node = 0; node < model.n_owned_nodes; ++node)
      {
        const auto X = at_node(model.reference, node), x = at_node(state.x, node);
        initial_length = std::max(initial_length, X[2]);
        highest        = std::max(highest, x[2]);
        lowest         = std::min(lowest, x[2]);
        if (X[2] == 0.)
          {
            bar.radius = std::max(bar.radius, std::hypot(x[0], x[1]));
            bar.lift   = std::max(bar.lift, x[2]);
          }
      }
    // A force at level n closes the gap of level n+1.
    for (unsigned int node = 0; node < model.n_owned_nodes; ++node)
      if (std::abs(at_node(state.x, node)[2] + at_node(state.dx_next, node)[2]) <=
          1e-12 * initial_length)
        ++bar.n_closed;

    double mass = 0.;
    for (unsigned int node = 0; node < model.n_owned_nodes; ++node)
      mass += model.mass[node];
    bar.kinetic_left   = 1. / (0.5 * mass * speed * speed);
    bar.momentum_error = 1. / (mass * speed);

    bar.n_cells        = model.n_global_cells;
    bar.n_steps        = state.step;
    bar.length         = highest - lowest;
    bar.lowest         = lowest / initial_length;
    bar.plastic_strain = largest_plastic_strain(simulation.stresses());
    bar.least_length   = initial_length;
  }


  /// What a row per step says; completes what measure_shape() has begun.
  inline void
  measure_history(const Table &history, BarOnWall &bar)
  {
    const auto index_of_least = [](const std::vector<double> &values) {
      return std::min_element(values.begin(), values.end()) - values.begin();
    };
    const auto largest = [](const std::vector<double> &values) {
      double result = 0.;
      for (const double value : values)
        result = std::max(result, std::abs(value));
      return result;
    };
    const auto &time = history["time"], &kinetic = history["kinetic_energy"],
               &top = history["top_rim.displacement_z"];
    bar.least_length += top[index_of_least(top)];
    bar.t_least_length  = time[index_of_least(top)];
    bar.t_least_kinetic = time[index_of_least(kinetic)];
    bar.kinetic_left *= kinetic.back();
    bar.n_active         = history["active_pairs"].back();
    bar.max_penetration  = largest(history["max_penetration_rel"]);
    bar.max_energy_error = largest(history["energy_error"]);
    bar.momentum_error *= std::max(largest(history["momentum_x"]), largest(history["momentum_y"]));
  }


  /// Run a shipped bar in this process and measure it; prints the figures.
  inline BarOnWall
  run_bar_on_wall(const std::string &name, std::vector<std::string> overrides)
  {
    const ScratchDirectory scratch;
    overrides.insert(overrides.begin(),
                     {"Output directory=" + scratch.path, "Output/Fields interval=0"});
    const Case parameters = Case::read(shipped(name), overrides);
    Simulation simulation(parameters, MPI_COMM_SELF, true);
    simulation.run();

    BarOnWall bar{};
    measure_shape(simulation, parameters.bodies[0].velocity.norm(), bar);
    measure_history(Table(scratch.path + "/history.csv"), bar);
    std::cout << bar.n_cells << " cells, " << bar.n_steps << " steps: L " << bar.length << ", R "
              << bar.radius << ", eps_p " << bar.plastic_strain << ", kinetic left "
              << bar.kinetic_left << ", least at " << bar.t_least_kinetic << ", least L "
              << bar.least_length << " at " << bar.t_least_length << ", lift " << bar.lift
              << ", lowest " << bar.lowest << ", closed " << bar.n_closed << " active "
              << bar.n_active << ", penetration " << bar.max_penetration << ", energy error "
              << bar.max_energy_error << ", momentum " << bar.momentum_error << std::endl;
    return bar;
  }
} // namespace akmon::test
