#pragma once

#include <akmon/case.h>
#include <akmon/contact/contact.h>
#include <akmon/forces/external_forces.h>
#include <akmon/forces/internal_forces.h>
#include <akmon/model/discretization.h>
#include <akmon/model/essential_conditions.h>
#include <akmon/model/nodal_state.h>
#include <akmon/output/monitor.h>
#include <akmon/output/screen.h>
#include <akmon/output/stage_timer.h>
#include <akmon/time/fidcd.h>

#include <chrono>
#include <memory>

namespace akmon
{
  /// Owns the modules; start, step, stop.
  class Simulation
  {
  public:
    /**
     * Build the model without writing anything. Throws InputError.
     * @param quiet  nothing but warnings on the screen
     */
    Simulation(const Case &parameters, MPI_Comm communicator, const bool quiet = false);

    /// Run to the end. Throws RunError, after the last state was written, when the run must not go
    /// on.
    void
    run();

    const NodalState &
    current_state() const
    {
      return state;
    }

    const Discretization &
    model() const
    {
      return discretization;
    }

    const InternalForces &
    stresses() const
    {
      return internal_forces;
    }

    const Monitor &
    watch() const
    {
      return *monitor;
    }

  private:
    void
    start();
    void
    step();
    void
    stop();
    void
    free_rigid_increments();
    void
    choose_step();
    void
    initial_velocity();
    void
    print_header();
    void
    show_progress();
    void
    check_cells();

    const Case parameters;
    const MPI_Comm communicator;
    Screen screen;
    StageTimer timer;

    Discretization discretization;
    NodalState state;
    EssentialConditions conditions;
    std::vector<RigidBody> rigid_bodies;
    ExternalForces external_forces;
    InternalForces internal_forces;
    Contact contact;
    Fidcd integrator;
    NodalVector velocity_0; ///< initial velocities; emptied after the start

    std::unique_ptr<Monitor> monitor; ///< from the start of run() on
    std::chrono::steady_clock::time_point wall_start;
    unsigned long n_cells = 0;

    struct Stages
    {
      explicit Stages(StageTimer &timer);
      StageTimer::Stage predict, search, forces, time_step, free_increment, normal, friction,
        correct, observe;
    } stages;
  };
} // namespace akmon
