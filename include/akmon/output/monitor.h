#pragma once

#include <akmon/case.h>
#include <akmon/contact/contact.h>
#include <akmon/exit_status.h>
#include <akmon/forces/external_forces.h>
#include <akmon/forces/internal_forces.h>
#include <akmon/model/essential_conditions.h>
#include <akmon/output/energy_balance.h>
#include <akmon/output/fields.h>
#include <akmon/output/history.h>
#include <akmon/output/interface_history.h>
#include <akmon/output/probes.h>
#include <akmon/time/fidcd.h>

#include <string>

namespace akmon
{
  /// Watches the run: energies and momenta, penetration, probes, output ticks.
  class Monitor
  {
  public:
    /// The modules it watches; all outlive it.
    struct Watched
    {
      const Discretization &discretization;
      const NodalState &state;
      const Fidcd &integrator;
      const InternalForces &internal_forces;
      const ExternalForces &external_forces;
      const EssentialConditions &conditions;
      const Contact &contact;
      const std::vector<RigidBody> &rigid_bodies;
    };

    Monitor(const Case &parameters, const Watched &watched);

    /**
     * Step 9: account for the time level (collective). Energies are summed where a history row is
     * due, and at least every 16 levels to guard their bound.
     * @param last  the final level
     */
    void
    observe(const bool last);

    /**
     * Write the history row and the fields that are due, both at the first and the last level
     * (collective). Throws RunError if the energy error or the hourglass energy is beyond its
     * bound.
     */
    void
    write(const bool last);

    /// Write the fields of the current level whatever is due, to look at what went wrong.
    void
    write_fields();

    /// Sums, extremes, ticks and how far the output files have come (collective).
    void
    save(CheckpointWriter &checkpoint);

    /// Take them back. Throws InputError if the history there does not fit (collective).
    void
    restore(const CheckpointReader &checkpoint);

    /// Make the output files what they were at the checkpoint (collective).
    void
    continue_output();

    /// Field files written so far.
    std::size_t
    n_field_files() const
    {
      return fields.n_files();
    }

    struct Extremes
    {
      double penetration = 0., penetration_relative = 0., energy_error = 0., momentum_error = 0.;
    };

    const Extremes &
    extremes() const
    {
      return worst;
    }

    /// Whether bodies whose motion is prescribed were inside each other in the last row.
    bool
    bodies_are_driven() const
    {
      return is_driven;
    }

    /// Whether a penetration was deeper than the bound: contact is lost, or penalty springs are
    /// soft.
    bool
    beyond_penetration_bound() const;

    /// Where that is (collective).
    std::string
    deepest_place() const
    {
      return describe(deepest);
    }

    /// What the coupled contact solver took and reached in the run so far.
    struct SolverRecord
    {
      double iterations  = 0.;
      double steps       = 0.; ///< that it iterated in
      double unconverged = 0.; ///< steps that ended above its tolerance
      double residual    = 0.; ///< the largest, over the cell size
    };

    const SolverRecord &
    contact_solver() const
    {
      return solver_record;
    }

    /// Pairs of all ranks that carried a force at the last row of the history.
    unsigned int
    active_pairs() const
    {
      return n_active_pairs;
    }

  private:
    void
    account_work();
    RigidBody::Work
    rigid_work(RigidBody::Work (RigidBody::*of_body)() const) const;
    void
    sum_energies();
    double
    energy_of_rounding() const;
    double
    energy_error() const
    {
      return (balance.sum() - initial_energy) / largest_energy;
    }
    void
    write_row();
    std::vector<double>
    momenta() const;
    bool
    energy_fault() const;
    bool
    hourglass_fault() const;
    void
    check_contact() const;
    void
    check_energy() const;

    // Where something is largest on this rank.
    struct Extremum
    {
      double size = 0.;
      dealii::Point<3> place;
      unsigned int body = 0;
    };

    std::string
    describe(const Extremum &of_rank) const;
    std::string
    level() const;

    const Case &parameters;
    Watched watched;
    OutputTick field_tick, history_tick;
    History history;
    InterfaceHistory interfaces;
    Fields fields;
    Probes probes;

    WorkLine external, damping;
    EnergyBalance balance;
    double initial_energy = 0., largest_energy = 0.;
    ContactReport report;
    unsigned int n_active_pairs = 0;                    ///< of all ranks, in the last row
    double penetration = 0., penetration_relative = 0.; ///< since the last row
    Extremum deepest;                                   ///< penetration over the cell size so far
    Extremes worst;
    SolverRecord solver_record;
    bool is_driven             = false; ///< see bodies_are_driven()
    bool row_due               = false;
    bool level_written         = false; ///< whether the fields of this level are on disk
    std::uint64_t history_size = 0;     ///< at the checkpoint the run goes on from; bytes
  };
} // namespace akmon
