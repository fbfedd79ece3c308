#include <akmon/parameters.h>
#include <akmon/simulation.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

// What the ranks agree on in each step, and the faults that end a run or take cells out of it.

namespace akmon
{
  using namespace dealii;

  std::string
  Simulation::level_text() const
  {
    return "step " + std::to_string(state.step) + ", time " + shortest_text(state.time) + ": ";
  }


  void
  Simulation::refuse_unstable_step() const
  {
    const double critical = 2. / std::sqrt(initial_frequency_squared);
    if (parameters.time.fixed_step > critical && !parameters.time.unstable)
      throw InputError("Time",
                       "Step",
                       shortest_text(parameters.time.fixed_step),
                       "it is above the critical step " + shortest_text(critical) +
                         "; allowed with 'Allow unstable step = true' only");
  }


  // In one exchange: the largest frequency, whether anyone wants a checkpoint, whether a cell is
  // beyond computing or was taken out.
  void
  Simulation::agree_on_step()
  {
    const bool erodes            = internal_forces.n_eroded() != n_eroded_here;
    std::array<double, 6> of_all = {{internal_forces.largest_frequency_squared(),
                                     double(wanted_checkpoint()),
                                     internal_forces.fault().occurred() ? 1. : 0.,
                                     erodes ? 1. : 0.,
                                     internal_forces.growth().watched,
                                     internal_forces.growth().elsewhere}};
    Utilities::MPI::max(ArrayView<const double>(of_all.data(), of_all.size()),
                        communicator,
                        ArrayView<double>(of_all.data(), of_all.size()));
    requested = static_cast<SignalWatch::Request>(int(of_all[1]));
    if (of_all[2] > 0.)
      throw_cell_fault();
    if (of_all[3] > 0.)
      count_eroded();
    double frequency_squared = bound_frequency(of_all[0], {of_all[4], of_all[5]});
    keep_step_from_collapsing(frequency_squared);
    state.dt_next = step_with_penalty(frequency_squared);
    if (!(state.dt_next > 0.))
      throw RunError(ExitStatus::not_a_number, level_text() + "the time step is not a number");
  }


  // Penalty springs stiffen the nodes they act on and cut the step, a fixed one too.
  double
  Simulation::step_with_penalty(const double frequency_squared)
  {
    const double without = parameters.time.choose(state.time, frequency_squared);
    if (parameters.contact_solver.type != ContactSolver::Type::penalty)
      return without;
    const auto limit      = contact.penalty_limit();
    const double together = frequency_squared + limit.frequency_squared;
    const double step     = parameters.time.choose(state.time,
                                               together,
                                               limit.frequency_squared > 0. &&
                                                 !parameters.time.unstable);
    const double cut      = std::sqrt(frequency_squared / together);
    penalty_cut           = std::min(penalty_cut, cut);
    // At the first one that shows, and again where it has become much shorter.
    if (cut < (told_cut == 1. ? 0.99 : 0.8 * told_cut))
      {
        told_cut = cut;
        for (const auto &where : Utilities::MPI::all_gather(communicator, limit.where))
          if (!where.empty())
            {
              screen.message(
                level_text() + "penalty springs of " + where + " cut the critical step to " +
                shortest_text(std::round(1e3 * cut) / 10.) + " % of that of the cells");
              break;
            }
      }
    return step;
  }


  void
  Simulation::warn_of_soft_springs()
  {
    if (soft_springs_told || parameters.contact_solver.type != ContactSolver::Type::penalty ||
        !monitor->beyond_penetration_bound())
      return;
    soft_springs_told = true;
    screen.warning(level_text() +
                   "penalty contact lets surfaces penetrate by more than [Output] "
                   "Penetration bound = " +
                   shortest_text(parameters.output.penetration_bound) +
                   " of the cell size; deepest is " + monitor->deepest_place() +
                   ". Raise [Contact solver] Penalty scale, or use Type = coupled");
  }


  // Once, also if the run has been restarted.
  void
  Simulation::warn_of_driven_bodies()
  {
    const std::string driven = "driven into";
    if (!monitor->bodies_are_driven() || screen.has_warned_of(driven))
      return;
    if (const std::string bodies = contact.driven_bodies(state); !bodies.empty())
      screen.warning(level_text() + bodies);
  }


  // Where the step is that of the assembled system, cells need no tight bounds but at its
  // estimates.
  double
  Simulation::bound_frequency(const double largest_of_cells, const InternalForces::Growth &growth)
  {
    if (!parameters.time.assembled || !parameters.time.automatic())
      {
        internal_forces.govern(largest_of_cells);
        return largest_of_cells;
      }
    internal_forces.govern(std::numeric_limits<double>::infinity());
    return assembled_frequency.follow(state.x, growth, largest_of_cells);
  }


  // Where every step strains the cells that limit it, the estimates take longer than the steps that
  // they save.
  void
  Simulation::tell_of_dear_estimates(const double seconds_of_run)
  {
    constexpr double dear = 0.4;

    const double part = timer.seconds(stages.time_step) / seconds_of_run;
    if (parameters.time.assembled && parameters.time.automatic() && part > dear)
      screen.message("estimates of the assembled system took " +
                     shortest_text(std::round(100. * part)) +
                     " % of the time: [Time] Critical step = cells is faster here");
  }


  void
  Simulation::throw_cell_fault() const
  {
    const auto &fault = internal_forces.fault();
    std::string message;
    if (fault.occurred())
      message = "cell " + std::to_string(fault.cell) + " of body '" + fault.body + "' " +
                (fault.not_a_number ? "has a node whose place is not a number" : "is inverted") +
                ", near " + place_text(fault.place);
    const auto numbers  = Utilities::MPI::all_gather(communicator, fault.not_a_number);
    const auto messages = Utilities::MPI::all_gather(communicator, message);
    for (std::size_t rank = 0; rank < messages.size(); ++rank)
      if (!messages[rank].empty())
        throw RunError(numbers[rank] ? ExitStatus::not_a_number : ExitStatus::inverted_cell,
                       level_text() + messages[rank]);
    throw RunError(ExitStatus::unexpected_error, level_text() + "a cell fault without a cell");
  }


  // The critical step must not fall below its bound: cells that cause it are taken out where their
  // body erodes, else the run stops.
  void
  Simulation::keep_step_from_collapsing(double &frequency_squared)
  {
    const double smallest = parameters.time.smallest;
    const double limit    = initial_frequency_squared / (smallest * smallest);
    if (!parameters.time.automatic() || !(frequency_squared > limit))
      return;
    internal_forces.erode_beyond(limit);
    count_eroded();
    const double of_rank = internal_forces.largest_frequency_squared(),
                 of_all  = Utilities::MPI::max(of_rank, communicator);
    frequency_squared = parameters.time.assembled ? assembled_frequency.estimate(state.x) : of_all;
    if (!(frequency_squared > limit))
      return;
    std::string message;
    if (of_rank == of_all)
      {
        const auto &cell = discretization.cells[internal_forces.limiting_cell_now()];
        message          = "the critical step has fallen from " +
                  rounded_text(2. / std::sqrt(initial_frequency_squared)) + " to " +
                  rounded_text(2. / std::sqrt(frequency_squared)) +
                  ", below [Time] Smallest step, by cell " + std::to_string(cell.id) +
                  " of body '" + parameters.bodies[cell.body].name + "', near " +
                  place_text(at_node(state.x, cell.nodes[0]));
      }
    for (const auto &of_rank : Utilities::MPI::all_gather(communicator, message))
      if (!of_rank.empty())
        throw RunError(ExitStatus::step_collapsed, level_text() + of_rank);
  }


  void
  Simulation::count_eroded()
  {
    n_eroded_here              = internal_forces.n_eroded();
    const unsigned long before = n_eroded;
    n_eroded                   = Utilities::MPI::sum(n_eroded_here, communicator);
    if (n_eroded == before)
      return;
    const std::string text = level_text() + std::to_string(n_eroded) + " cells eroded so far";
    if (before == 0)
      screen.warning(text);
    else
      screen.message(text);
  }
} // namespace akmon
