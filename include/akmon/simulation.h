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
#include <akmon/signal_watch.h>
#include <akmon/time/assembled_frequency.h>
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
     * @param from   what an earlier part of the run tells about the partition
     */
    Simulation(const Case &parameters,
               MPI_Comm communicator,
               const bool quiet         = false,
               const Continuation &from = {});

    /**
     * Run to the end, or to a checkpoint from which another Simulation is to go on with cells
     * shared out anew, as the result tells. Throws RunError, after the last state was written, when
     * the run must not go on.
     * @param checkpoint  to go on from, in the case's output directory; empty: from the beginning.
     *                    Throws InputError before anything is written if it cannot be.
     */
    Continuation
    run(const std::string &checkpoint = "");

    /// Show what looks like a mistake in the case (collective); run() does it too.
    void
    warn_of_oddities();

    /// See akmon::state_hash().
    std::uint64_t
    state_hash() const;

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

    const Contact &
    watch_contact() const
    {
      return contact;
    }

    const AssembledFrequency &
    frequency() const
    {
      return assembled_frequency;
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
    restart(const std::string &checkpoint);
    void
    restore_rigid_bodies(const std::vector<double> &numbers);
    void
    step();
    void
    stop(const ExitStatus status);
    void
    free_rigid_increments();
    void
    agree_on_step();
    double
    bound_frequency(const double largest_of_cells, const InternalForces::Growth &growth);
    SignalWatch::Request
    wanted_checkpoint();
    void
    write_checkpoint_if_due();
    void
    write_checkpoint(const std::string &path, const bool for_looking_only);
    bool
    wants_repartition();
    ExtraWork
    measure_extra_work(const double seconds_of_forces, const double seconds_of_pairs) const;
    void
    leave_evidence();
    void
    initial_velocity();
    void
    print_header();
    void
    show_progress();
    void
    tell_of_dear_estimates(const double seconds_of_run);
    void
    refuse_unstable_step() const;
    [[noreturn]] void
    throw_cell_fault() const;
    void
    keep_step_from_collapsing(double &frequency_squared);
    void
    count_eroded();
    double
    step_with_penalty(const double frequency_squared);
    void
    warn_of_soft_springs();
    void
    warn_of_driven_bodies();
    std::string
    level_text() const;

    const Case parameters;
    const MPI_Comm communicator;
    Continuation continuation;
    Screen screen;
    StageTimer timer;

    Discretization discretization;
    NodalState state;
    EssentialConditions conditions;
    std::vector<RigidBody> rigid_bodies;
    ExternalForces external_forces;
    InternalForces internal_forces;
    AssembledFrequency assembled_frequency;
    Contact contact;
    Fidcd integrator;
    NodalVector velocity_0; ///< initial velocities; emptied after the start

    std::unique_ptr<Monitor> monitor; ///< from the start of run() on
    SignalWatch signals;
    OutputTick checkpoint_tick;
    SignalWatch::Request requested = SignalWatch::none; ///< in this step, the same on all ranks
    std::chrono::steady_clock::time_point wall_start, last_checkpoint;
    double forces_before = 0., pairs_before = 0.;  ///< seconds on this rank at the last checkpoint
    unsigned long n_cells = 0, first_step = 0;     ///< first_step: where this part of the run began
    double added_mass      = 0.;                   ///< by mass scaling, over the mass there was
    unsigned long n_eroded = 0, n_eroded_here = 0; ///< of all ranks, of this one
    double initial_frequency_squared = 0.;         ///< bound of omega_max^2 at the start
    double initial_cell_frequency    = 0.;         ///< largest omega^2 of a cell of any rank there
    double penalty_cut     = 1.;    ///< least critical step with penalty springs over that without
    double told_cut        = 1.;    ///< the last one on the screen
    bool soft_springs_told = false; ///< that penetrations are beyond their bound

    struct Stages
    {
      explicit Stages(StageTimer &timer);
      StageTimer::Stage predict, search, forces, time_step, free_increment, normal, friction,
        correct, observe, output, checkpoint;
    } stages;
  };
} // namespace akmon
