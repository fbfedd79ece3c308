#include <akmon/contact/search/initial_overlap.h>
#include <akmon/model/hexahedron_cell.h>
#include <akmon/output/directory.h>
#include <akmon/output/summary.h>
#include <akmon/plausibility.h>
#include <akmon/simulation.h>
#include <akmon/time/mass_scaling.h>

#include <deal.II/base/mpi.h>

#include <array>
#include <cmath>
#include <cstdio>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // Beyond this part of the mass of all bodies, what mass scaling adds is worth a warning.
    constexpr double much_added_mass = 0.05;


    std::string
    percent_text(const double part)
    {
      return shortest_text(std::round(1e4 * part) * 1e-2) + " %";
    }


    std::vector<RigidBody>
    make_rigid_bodies(const Case &parameters)
    {
      std::vector<RigidBody> bodies;
      for (const auto &obstacle : parameters.obstacles)
        bodies.emplace_back(obstacle, parameters.body_force.acceleration);
      return bodies;
    }
  } // namespace


  Simulation::Stages::Stages(StageTimer &timer)
    : predict(timer.add("integrator.predict"))
    , search(timer.add("contact.search"))
    , forces(timer.add("forces.update"))
    , time_step(timer.add("time_step.choose"))
    , free_increment(timer.add("integrator.free_increment"))
    , normal(timer.add("contact.resolve_normal"))
    , friction(timer.add("contact.resolve_friction"))
    , correct(timer.add("integrator.correct"))
    , observe(timer.add("monitor.observe"))
    , output(timer.add("output.write"))
    , checkpoint(timer.add("checkpoint.write"))
  {
  }


  Simulation::Simulation(const Case &parameters,
                         MPI_Comm communicator,
                         const bool quiet,
                         const Continuation &from)
    : parameters(parameters)
    , communicator(communicator)
    , continuation(from)
    , screen(communicator, quiet)
    , discretization(parameters.bodies, parameters.materials, communicator, from.extra_work)
    , state(discretization)
    , conditions(discretization, this->parameters.prescribed_motions)
    , rigid_bodies(make_rigid_bodies(this->parameters))
    , external_forces(discretization, this->parameters.surface_loads, this->parameters.body_force)
    , internal_forces(discretization)
    , assembled_frequency(discretization, internal_forces)
    , contact(discretization,
              this->parameters.contact_solver,
              this->parameters.contacts,
              rigid_bodies,
              conditions)
    , integrator(discretization,
                 state,
                 parameters.body_force.damping,
                 parameters.body_force.damping_end)
    , n_cells(discretization.n_global_cells)
    , stages(timer)
  {
    added_mass                = scale_masses(discretization,
                              internal_forces,
                              parameters.time.mass_scaling_limit());
    initial_cell_frequency    = Utilities::MPI::max(internal_forces.largest_frequency_squared(),
                                                 communicator);
    initial_frequency_squared = parameters.time.assembled ? assembled_frequency.estimate(state.x) :
                                                            initial_cell_frequency;
    refuse_body_overlap(discretization);
    contact.search(state);
    contact.refuse_initial_overlap(state);
    refuse_unstable_step();
    // The probes are the only part of the output that the input can make fail.
    Probes(parameters.probes, discretization, internal_forces, integrator);
  }


  Continuation
  Simulation::run(const std::string &checkpoint)
  {
    continuation.checkpoint.clear();
    if (checkpoint.empty())
      prepare_output_directory(parameters.output_directory, communicator);
    checkpoint_tick = parameters.checkpoint.tick;
    monitor         = std::make_unique<Monitor>(parameters,
                                        Monitor::Watched{discretization,
                                                         state,
                                                         integrator,
                                                         internal_forces,
                                                         external_forces,
                                                         conditions,
                                                         contact,
                                                         rigid_bodies});
    wall_start = last_checkpoint = std::chrono::steady_clock::now();
    if (!checkpoint.empty())
      restart(checkpoint);
    run_on_root(communicator, [&]() {
      replace_file(parameters.output_directory + "/parameters.prm", parameters.as_used);
    });
    try
      {
        if (checkpoint.empty())
          start();
        while (!parameters.time.finished(state.time))
          {
            step();
            write_checkpoint_if_due();
            if (!continuation.checkpoint.empty())
              return continuation;
          }
      }
    catch (const RunError &error)
      {
        if (error.status != ExitStatus::terminated && error.status != ExitStatus::output_failed)
          leave_evidence();
        if (error.status != ExitStatus::output_failed)
          stop(error.status);
        throw;
      }
    stop(ExitStatus::done);
    return continuation;
  }


  void
  Simulation::initial_velocity()
  {
    velocity_0 = discretization.make_vector();
    for (unsigned int node = 0; node < discretization.n_owned_nodes; ++node)
      {
        const unsigned int body_index = discretization.body_of_node[node];
        const Body &body              = discretization.get_bodies()[body_index];
        const Point<3> X(at_node(discretization.reference, node));
        auto v = body.velocity +
                 cross_product_3d(body.spin, X - discretization.centre_of(body_index));
        if (!body.velocity_field.identically_zero())
          v += body.velocity_field.vector(X, 0.);
        for (unsigned int d = 0; d < 3; ++d)
          velocity_0.local_element(3 * node + d) = v[d];
      }
    conditions.adjust_initial_velocity(velocity_0);
  }


  void
  Simulation::warn_of_oddities()
  {
    if (velocity_0.size() == 0)
      initial_velocity();
    for (const auto &warning : plausibility_warnings(parameters, discretization, velocity_0))
      screen.warning(warning);
  }


  // The starting step (28)(29), with contact.
  void
  Simulation::start()
  {
    initial_velocity();
    warn_of_oddities();
    state.force = 0.;
    external_forces.add(state, state.force); // the initial stress is zero
    agree_on_step();
    print_header();
    integrator.start(velocity_0, state.dt_next);
    for (auto &body : rigid_bodies)
      body.start(state.dt_next, integrator.damping_rate());
    const double c = integrator.effective_mass_factor();
    conditions.clear_reactions();
    conditions.apply(state, c);
    contact.search(state);
    contact.resolve_normal(state, c);
    contact.resolve_friction(state, c);
    contact.add_increments(state, c);
    conditions.apply(state, c);
    integrator.finish_start(velocity_0);
    velocity_0.reinit(0);
    monitor->observe(false);
    monitor->write(false);
  }


  // Algorithm 1 of the paper; its t_n + dt is the level state.time after predict().
  void
  Simulation::step()
  {
    {
      const StageTimer::Scope timing(stages.predict); // 1
      integrator.predict();
      for (auto &body : rigid_bodies)
        body.predict();
    }
    {
      const StageTimer::Scope timing(stages.search); // 2
      contact.search(state);
    }
    {
      const StageTimer::Scope timing(stages.forces); // 3
      state.force = 0.;
      internal_forces.update(state.x, state.dx, state.force, state.dt);
      external_forces.add(state, state.force);
    }
    {
      const StageTimer::Scope timing(stages.time_step);
      agree_on_step();
    }
    {
      const StageTimer::Scope timing(stages.free_increment); // 4
      integrator.free_increment();
      free_rigid_increments();
      conditions.clear_reactions();
      conditions.apply(state, integrator.effective_mass_factor());
    }
    {
      const StageTimer::Scope timing(stages.normal); // 5
      contact.resolve_normal(state, integrator.effective_mass_factor());
    }
    {
      const StageTimer::Scope timing(stages.friction); // 6
      contact.resolve_friction(state, integrator.effective_mass_factor());
    }
    {
      const StageTimer::Scope timing(stages.correct); // 7, 8
      contact.add_increments(state, integrator.effective_mass_factor());
      conditions.apply(state, integrator.effective_mass_factor());
    }
    {
      const StageTimer::Scope timing(stages.observe); // 9
      monitor->observe(parameters.time.finished(state.time));
    }
    {
      const StageTimer::Scope timing(stages.output);
      monitor->write(parameters.time.finished(state.time));
    }
    warn_of_soft_springs();
    warn_of_driven_bodies();
    show_progress();
  }


  void
  Simulation::free_rigid_increments()
  {
    for (auto &body : rigid_bodies)
      body.free_increment(state.time, state.dt, state.dt_next, integrator.damping_rate());
  }


  void
  Simulation::print_header()
  {
    const double critical = 2. / std::sqrt(initial_frequency_squared);
    // The rank whose cell limits the step says where that is.
    std::string limit;
    if (internal_forces.largest_initial_frequency_squared() == initial_cell_frequency &&
        !discretization.cells.empty())
      {
        const auto &cell = discretization.cells[internal_forces.limiting_cell()];
        const auto place = HexahedronCell().at(discretization.corners_of(cell))->center();
        limit = "cell " + std::to_string(cell.id) + " of '" + parameters.bodies[cell.body].name +
                "' at " + place_text(place);
      }
    for (const auto &of_rank : Utilities::MPI::all_gather(communicator, limit))
      if (limit.empty())
        limit = of_rank;

    if (initial_frequency_squared < initial_cell_frequency)
      limit = "the assembled system; alone, " + limit + " allows " +
              percent_text(std::sqrt(initial_frequency_squared / initial_cell_frequency)) +
              " of that";

    std::string bodies;
    for (const auto &body : parameters.bodies)
      if (body.copy == 0)
        bodies += (bodies.empty() ? "" : ", ") + body.section_name() +
                  (body.family.empty() ? "" : " (" + std::to_string(body.copies.n()) + " copies)");
    screen.header({{"case", parameters.title},
                   {"bodies", bodies},
                   {"cells", std::to_string(n_cells)},
                   {"nodes", std::to_string(discretization.n_global_nodes)},
                   {"ranks", std::to_string(Utilities::MPI::n_mpi_processes(communicator))},
                   {"SIMD lanes", std::to_string(n_lanes)},
                   {"time step",
                    rounded_text(state.dt_next) + ", " + percent_text(state.dt_next / critical) +
                      " of critical" + (parameters.time.automatic() ? " (automatic)" : " (fixed)")},
                   {"limited by", limit},
                   {"end", shortest_text(parameters.time.end)},
                   {"output", parameters.output_directory}});
    for (const auto &obstacle : parameters.obstacles)
      for (const auto &repair : obstacle.repairs)
        screen.warning(repair);
    if (state.dt_next > critical)
      screen.warning("the time step is above the critical step " + rounded_text(critical));
    if (added_mass > much_added_mass && first_step == 0) // a checkpoint keeps what was warned of
      screen.warning("mass scaling adds " + percent_text(added_mass) +
                     " to the mass of the bodies; look at what it does to their motion");
  }


  void
  Simulation::show_progress()
  {
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - wall_start;
    Progress progress;
    progress.time                  = state.time;
    progress.end                   = parameters.time.end;
    progress.dt                    = state.dt;
    progress.step                  = state.step;
    progress.active_pairs          = monitor->active_pairs();
    progress.penetration_rel       = monitor->extremes().penetration_relative;
    progress.energy_error          = monitor->extremes().energy_error;
    progress.cell_steps_per_second = double(n_cells) * (state.step - first_step) / wall.count();
    screen.progress(progress);
  }


  void
  Simulation::stop(const ExitStatus status)
  {
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - wall_start;
    const auto totals                        = timer.totals(communicator);
    screen.closing(totals, wall.count());
    tell_of_dear_estimates(wall.count());

    std::map<std::string, double> seconds, imbalance;
    for (const auto &total : totals)
      {
        seconds[total.name]   = total.seconds;
        imbalance[total.name] = total.imbalance;
      }
    const auto &extremes = monitor->extremes();
    const auto &solver   = monitor->contact_solver();
    if (solver.unconverged > 0.)
      screen.warning("contact: " + shortest_text(solver.unconverged) + " of " +
                     shortest_text(state.step) +
                     " steps ended above the solver's tolerance, the worst with friction or gaps "
                     "wrong by " +
                     rounded_text(solver.residual) + " of the cell size");
    Summary summary;
    summary.set("title", parameters.title);
    summary.set("completed", status == ExitStatus::done);
    summary.set("exit_status", int(status));
    summary.set("time", state.time);
    summary.set("steps", state.step);
    summary.set("cells", n_cells);
    summary.set("ranks", Utilities::MPI::n_mpi_processes(communicator));
    summary.set("wall_seconds", wall.count());
    summary.set("cell_steps_per_second",
                double(n_cells) * (state.step - first_step) / wall.count());
    summary.set("stage_seconds", seconds);
    summary.set("stage_imbalance", imbalance);
    summary.set("repartitions", continuation.n_repartitions);
    summary.set("eroded_cells", n_eroded);
    summary.set("added_mass_rel", added_mass);
    summary.set("max_penetration", extremes.penetration);
    summary.set("max_penetration_rel", extremes.penetration_relative);
    summary.set("energy_error", extremes.energy_error);
    if (parameters.contact_solver.type == ContactSolver::Type::penalty)
      summary.set("penalty_step_cut", penalty_cut);
    summary.set("contact_iterations_mean", solver.iterations / std::max(solver.steps, 1.));
    summary.set("contact_steps_unconverged", solver.unconverged);
    char hash[20];
    std::snprintf(hash, sizeof(hash), "%016llx", static_cast<unsigned long long>(state_hash()));
    summary.set("state_hash", std::string(hash));
    summary.set("warnings", screen.warnings());
    summary.write(parameters.output_directory + "/summary.json", communicator);
  }
} // namespace akmon
