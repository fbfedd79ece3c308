#include <akmon/parameters.h>
#include <akmon/simulation.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <utility>

// When and how cells are to be shared out anew.

namespace akmon
{
  using namespace dealii;

  // Looks at the work since the last checkpoint: the stages in which no rank waits for others. What
  // was lost by waiting must be worth building the model anew, unless the bound is one.
  bool
  Simulation::wants_repartition()
  {
    constexpr double worth = 10.; // seconds

    const double forces = timer.seconds(stages.forces) -
                          std::exchange(forces_before, timer.seconds(stages.forces));
    const double of_pairs = contact.work_seconds() -
                            std::exchange(pairs_before, contact.work_seconds());
    const auto work     = Utilities::MPI::min_max_avg(forces + of_pairs, communicator);
    const double uneven = work.avg > 0. ? work.max / work.avg : 1.;
    const double bound  = parameters.partition.repartition_above;
    if (Utilities::MPI::n_mpi_processes(communicator) == 1 ||
        parameters.time.finished(state.time) || !(uneven >= bound) ||
        (bound > 1. && work.max - work.avg < worth))
      return false;
    auto extra_work = measure_extra_work(forces, of_pairs);
    if (extra_work == continuation.extra_work) // cells alone: they are shared out evenly
      return false;
    continuation.extra_work = std::move(extra_work);
    ++continuation.n_repartitions;
    screen.message("step " + std::to_string(state.step) + ": the busiest rank works " +
                   shortest_text(std::round(100. * uneven) / 100.) +
                   " times as long as the mean one; cells are shared out anew");
    return true;
  }


  // Pairs cost what their search and their forces take, compared with the forces of a cell. They
  // count at a cell of their slave.
  ExtraWork
  Simulation::measure_extra_work(const double seconds_of_forces,
                                 const double seconds_of_pairs) const
  {
    constexpr double most = 1e6; // of a cell's own work, in thousandths

    std::map<unsigned int, unsigned int> pairs_of;
    for (const auto &pair : contact.get_pairs())
      if (pair.has_slave_node())
        ++pairs_of[pair.slave];
    double n_pairs = 0.;
    for (const auto &[slave, n] : pairs_of)
      n_pairs += n;
    const double n_pairs_of_all = Utilities::MPI::sum(n_pairs, communicator);
    const double of_pairs       = Utilities::MPI::sum(seconds_of_pairs, communicator);
    const double of_cells       = Utilities::MPI::sum(seconds_of_forces, communicator);
    if (!(n_pairs_of_all > 0.) || !(of_cells > 0.))
      return {};
    const double of_pair = 1000. * (of_pairs / n_pairs_of_all) / (of_cells / double(n_cells));

    std::vector<std::pair<types::global_cell_index, unsigned int>> own;
    for (const auto &cell : discretization.cells)
      {
        double n = 0.;
        if (cell.owned)
          for (const unsigned int node : cell.nodes)
            if (const auto found = pairs_of.find(node); found != pairs_of.end())
              {
                n += found->second;
                pairs_of.erase(found);
              }
        if (n > 0.)
          own.emplace_back(cell.id, static_cast<unsigned int>(std::min(most, n * of_pair)));
      }
    ExtraWork result;
    for (const auto &of_rank : Utilities::MPI::all_gather(communicator, own))
      result.insert(of_rank.begin(), of_rank.end());
    return result;
  }
} // namespace akmon
