#pragma once

#include <akmon/case.h>
#include <akmon/contact/contact.h>
#include <akmon/forces/external_forces.h>
#include <akmon/forces/internal_forces.h>
#include <akmon/model/essential_conditions.h>
#include <akmon/output/energy_balance.h>
#include <akmon/output/fields.h>
#include <akmon/output/history.h>
#include <akmon/output/probes.h>
#include <akmon/time/fidcd.h>

#include <stdexcept>

namespace akmon
{
  /// The run cannot go on or must not be trusted: exit status 1 with the step and place.
  class RunError : public std::runtime_error
  {
  public:
    using std::runtime_error::runtime_error;
  };


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
     * Step 9: account for the time level and write what is due (collective).
     * @param last  the final level: everything is written
     * Throws RunError if the energy error is beyond its bound.
     */
    void
    observe(const bool last);

    /// Write the fields of the current level whatever is due, to look at what went wrong.
    void
    write_fields();

    struct Extremes
    {
      double penetration = 0., penetration_relative = 0., energy_error = 0., momentum_error = 0.;
    };

    const Extremes &
    extremes() const
    {
      return worst;
    }

    /// Pairs that carried a force at the last level (this rank's).
    unsigned int
    active_pairs() const
    {
      return report.active_pairs;
    }

  private:
    void
    account_work();
    RigidBody::Work
    rigid_work(RigidBody::Work (RigidBody::*of_body)() const) const;
    void
    sum_energies();
    void
    write_row();
    std::vector<double>
    momenta() const;
    void
    check_energy() const;

    const Case &parameters;
    Watched watched;
    OutputTick field_tick, history_tick;
    History history;
    Fields fields;
    Probes probes;

    WorkLine external, damping, friction, impact;
    EnergyBalance balance;
    double initial_energy = 0., largest_energy = 0.;
    ContactReport report;
    double penetration = 0., penetration_relative = 0.; ///< since the last row
    Extremes worst;
    bool level_written = false; ///< whether the fields of this level are on disk
  };
} // namespace akmon
