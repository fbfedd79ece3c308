#include <akmon/checkpoint/checkpoint_file.h>
#include <akmon/checkpoint/fingerprint.h>
#include <akmon/output/directory.h>
#include <akmon/parameters.h>
#include <akmon/simulation.h>

#include <deal.II/base/mpi.h>

#include <filesystem>

// Checkpoints of a run, and going on from them.

namespace akmon
{
  using namespace dealii;

  std::uint64_t
  Simulation::state_hash() const
  {
    return akmon::state_hash(discretization, state, internal_forces);
  }


  // This rank's wish; rank 0's clock counts.
  SignalWatch::Request
  Simulation::wanted_checkpoint()
  {
    const auto by_signal                                       = signals.take();
    const double minutes                                       = parameters.checkpoint.wall_minutes;
    const std::chrono::duration<double, std::ratio<60>> passed = std::chrono::steady_clock::now() -
                                                                 last_checkpoint;
    if (by_signal == SignalWatch::none && minutes > 0. && passed.count() >= minutes &&
        Utilities::MPI::this_mpi_process(communicator) == 0)
      return SignalWatch::checkpoint;
    return by_signal;
  }


  void
  Simulation::write_checkpoint_if_due()
  {
    const bool due = checkpoint_tick.due(state.time, state.step);
    if (!due && requested == SignalWatch::none)
      return;
    const StageTimer::Scope timing(stages.checkpoint);
    const std::string &directory = parameters.output_directory;
    write_checkpoint(checkpoint_path(directory, state.step), false);
    run_on_root(communicator, [&]() {
      constexpr std::size_t kept = 2;
      auto checkpoints           = list_checkpoints(directory);
      for (; checkpoints.size() > kept; checkpoints.erase(checkpoints.begin()))
        std::filesystem::remove(checkpoints.front());
    });
    contact.forget_shortcuts();
    last_checkpoint = std::chrono::steady_clock::now();
    if (requested == SignalWatch::stop && !parameters.time.finished(state.time))
      throw RunError(ExitStatus::terminated,
                     level_text() + "stopped by SIGTERM; akmon --restart '" + directory +
                       "' goes on");
    requested = SignalWatch::none;
    if (wants_repartition())
      continuation.checkpoint = checkpoint_path(directory, state.step);
  }


  void
  Simulation::write_checkpoint(const std::string &path, const bool for_looking_only)
  {
    std::string warnings;
    for (const auto &warning : screen.warnings())
      warnings += warning + '\n';
    try
      {
        CheckpointWriter checkpoint(path, communicator);
        checkpoint.text("title", parameters.title);
        checkpoint.integer("for_looking_only", for_looking_only ? 1 : 0);
        checkpoint.integer("n_nodes", discretization.n_global_nodes);
        checkpoint.integer("n_cells", n_cells);
        checkpoint.integer("fingerprint", fingerprint(discretization));
        checkpoint.numbers("checkpoint_tick", {checkpoint_tick.next});
        checkpoint.text("warnings", warnings);
        state.save(checkpoint);
        internal_forces.save(checkpoint);
        assembled_frequency.save(checkpoint);
        contact.save(checkpoint);
        std::vector<double> of_rigid_bodies = {double(rigid_bodies.size())};
        for (auto &body : rigid_bodies)
          body.visit_state([&](const double x) { of_rigid_bodies.push_back(x); });
        checkpoint.numbers("rigid_bodies", of_rigid_bodies);
        monitor->save(checkpoint);
        checkpoint.finish();
      }
    catch (const std::runtime_error &error)
      {
        throw RunError(ExitStatus::output_failed, level_text() + error.what());
      }
  }


  // The state at which a run had to stop, to look at.
  void
  Simulation::leave_evidence()
  {
    try
      {
        monitor->write_fields();
        write_checkpoint(parameters.output_directory + "/checkpoint_fault.h5", true);
      }
    catch (const RunError &error)
      {
        screen.warning(std::string("the last state is not complete on the disk: ") + error.what());
      }
  }


  void
  Simulation::restore_rigid_bodies(const std::vector<double> &numbers)
  {
    if (numbers.at(0) != rigid_bodies.size())
      throw std::runtime_error("its obstacles are not those of the case");
    std::size_t next = 1;
    for (auto &body : rigid_bodies)
      body.visit_state([&](double &x) { x = numbers.at(next++); });
  }


  void
  Simulation::restart(const std::string &checkpoint)
  {
    verify_checkpoint(checkpoint, communicator);
    const auto refuse = [&](const std::string &reason) {
      throw InputError("checkpoint '" + checkpoint + "' is refused: " + reason);
    };
    const auto counts = [](const std::uint64_t n_nodes, const std::uint64_t n_cells) {
      return std::to_string(n_nodes) + " nodes and " + std::to_string(n_cells) + " cells";
    };
    try
      {
        const CheckpointReader reader(checkpoint);
        const std::string here  = counts(discretization.n_global_nodes, n_cells);
        const std::string there = counts(reader.integer("n_nodes"), reader.integer("n_cells"));
        if (reader.integer("for_looking_only") != 0)
          refuse("it shows a state that could not go on");
        if (here != there)
          refuse("its mesh has " + there + ", that of the case " + here);
        if (reader.integer("fingerprint") != fingerprint(discretization))
          refuse("its mesh or its materials are not those of the case");
        state.restore(reader);
        internal_forces.restore(reader);
        assembled_frequency.restore(reader);
        n_eroded_here = internal_forces.n_eroded();
        n_eroded      = Utilities::MPI::sum(n_eroded_here, communicator);
        contact.restore(reader);
        restore_rigid_bodies(reader.numbers("rigid_bodies"));
        monitor->restore(reader);
        checkpoint_tick.next = reader.numbers("checkpoint_tick").at(0);
        screen.recall(reader.text("warnings"));
      }
    catch (const InputError &)
      {
        throw;
      }
    catch (const std::exception &error)
      {
        refuse(error.what());
      }
    if (parameters.time.finished(state.time))
      refuse("it is at time " + shortest_text(state.time) + ", at or behind the end of the run");
    remove_results_behind(parameters.output_directory,
                          state.step,
                          monitor->n_field_files(),
                          communicator);
    monitor->continue_output();
    first_step = state.step;
    print_header();
  }
} // namespace akmon
