#include <akmon/output/monitor.h>

#include <deal.II/base/mpi.h>

// The parts of Monitor that make a run go on from a checkpoint.

namespace akmon
{
  using namespace dealii;

  void
  Monitor::save(CheckpointWriter &checkpoint)
  {
    const MPI_Comm communicator = watched.discretization.communicator();
    std::vector<double> works;
    for (const WorkLine *const line : {&external, &damping})
      for (const double part : line->parts())
        works.push_back(part);
    checkpoint.part_of_rank("work_lines", works);
    checkpoint.numbers("energies", {initial_energy, largest_energy});
    checkpoint.numbers("penetration",
                       {Utilities::MPI::max(penetration, communicator),
                        Utilities::MPI::max(penetration_relative, communicator)});
    checkpoint.numbers("extremes",
                       {worst.penetration, worst.penetration_relative, worst.energy_error});
    checkpoint.numbers("contact_solver",
                       {solver_record.iterations,
                        solver_record.steps,
                        solver_record.unconverged,
                        solver_record.residual});
    checkpoint.numbers("output_ticks", {field_tick.next, history_tick.next});
    checkpoint.integer("history_size", history.secure());
    interfaces.save(checkpoint);
    fields.save(checkpoint);
  }


  void
  Monitor::restore(const CheckpointReader &checkpoint)
  {
    const auto works  = checkpoint.sum_of_rank("work_lines", watched.discretization.communicator());
    unsigned int next = 0;
    for (WorkLine *const line : {&external, &damping})
      {
        line->continue_from({{works.at(next), works.at(next + 1)}});
        next += 2;
      }
    const auto energies        = checkpoint.numbers("energies");
    initial_energy             = energies.at(0);
    largest_energy             = energies.at(1);
    const auto of_interval     = checkpoint.numbers("penetration");
    penetration                = of_interval.at(0);
    penetration_relative       = of_interval.at(1);
    const auto of_run          = checkpoint.numbers("extremes");
    worst.penetration          = of_run.at(0);
    worst.penetration_relative = of_run.at(1);
    worst.energy_error         = of_run.at(2);
    const auto of_solver       = checkpoint.numbers("contact_solver");
    solver_record     = {of_solver.at(0), of_solver.at(1), of_solver.at(2), of_solver.at(3)};
    const auto ticks  = checkpoint.numbers("output_ticks");
    field_tick.next   = ticks.at(0);
    history_tick.next = ticks.at(1);
    history_size      = checkpoint.integer("history_size");
    fields.restore(checkpoint);
    history.check_beginning(history_size);
    interfaces.restore(checkpoint);
  }


  void
  Monitor::continue_output()
  {
    history.continue_behind(history_size);
    interfaces.continue_output();
  }
} // namespace akmon
