#include <akmon/output/monitor.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // An energy that grows without bound doubles within a few steps; checking more often stops no
    // earlier.
    constexpr unsigned int levels_between_energies = 16;
  } // namespace


  Monitor::Monitor(const Case &parameters, const Watched &watched)
    : parameters(parameters)
    , watched(watched)
    , field_tick(parameters.output.fields)
    , history_tick(parameters.output.history)
    , history(parameters.output_directory + "/history.csv", watched.discretization.communicator())
    , interfaces(parameters.output_directory, watched.contact, watched.state)
    , fields(parameters.output_directory,
             watched.discretization,
             watched.internal_forces,
             watched.contact,
             watched.integrator,
             parameters.output.deformed)
    , probes(parameters.probes, watched.discretization, watched.internal_forces, watched.integrator)
  {
    history.add_columns({"time",
                         "dt",
                         "kinetic_energy",
                         "strain_energy",
                         "plastic_dissipation",
                         "damping_dissipation",
                         "friction_dissipation",
                         "impact_dissipation",
                         "hourglass_energy",
                         "contact_energy",
                         "bond_energy",
                         "external_work",
                         "energy_error",
                         "momentum_x",
                         "momentum_y",
                         "momentum_z",
                         "angular_momentum_x",
                         "angular_momentum_y",
                         "angular_momentum_z",
                         "max_penetration",
                         "max_penetration_rel",
                         "active_pairs",
                         "sticking_pairs",
                         "contact_iterations"});
    for (const auto &name : watched.contact.names())
      for (const char *const axis : {"x", "y", "z"})
        history.add_column(name + ".force_" + axis);
    for (const auto &body : watched.rigid_bodies)
      if (body.moves())
        for (const char *const quantity : {".displacement_", ".rotation_", ".velocity_", ".spin_"})
          for (const char *const axis : {"x", "y", "z"})
            history.add_column(body.parameters().name + quantity + axis);
    history.add_columns(probes.columns());
  }


  void
  Monitor::observe(const bool last)
  {
    level_written = false;
    account_work();
    report = watched.contact.report(watched.state);
    solver_record.iterations += report.iterations;
    solver_record.steps += report.iterations > 0;
    solver_record.unconverged += !report.converged;
    solver_record.residual = std::max(solver_record.residual, report.residual);
    interfaces.observe(report);
    if (report.max_penetration_relative > deepest.size)
      deepest = {report.max_penetration_relative,
                 report.place,
                 report.deepest == numbers::invalid_unsigned_int ?
                   0 :
                   watched.discretization.body_of_node[report.deepest]};
    penetration          = std::max(penetration, report.max_penetration);
    penetration_relative = std::max(penetration_relative, report.max_penetration_relative);

    const auto step = watched.state.step;
    row_due         = history_tick.due(watched.state.time, step) || last || step == 0;
    if (row_due || step % levels_between_energies == 0)
      sum_energies();
    row_due = row_due || energy_fault() || hourglass_fault();
  }


  void
  Monitor::write(const bool last)
  {
    if (row_due)
      write_row();
    const bool fields_due = field_tick.due(watched.state.time, watched.state.step);
    if (fields_due || last || watched.state.step == 0)
      write_fields();
    check_contact();
    check_energy();
  }


  void
  Monitor::write_fields()
  {
    if (!level_written)
      fields.write(watched.state);
    level_written = true;
  }


  // Of all rigid bodies, on rank 0: they are the same on all.
  RigidBody::Work
  Monitor::rigid_work(RigidBody::Work (RigidBody::*of_body)() const) const
  {
    RigidBody::Work sum;
    if (Utilities::MPI::this_mpi_process(watched.discretization.communicator()) == 0)
      for (const auto &body : watched.rigid_bodies)
        {
          const RigidBody::Work work = (body.*of_body)();
          sum.external += work.external;
          sum.damping += work.damping;
        }
    return sum;
  }


  void
  Monitor::account_work()
  {
    const auto &dx = watched.state.dx, &dx_next = watched.state.dx_next;
    const RigidBody::Work before = rigid_work(&RigidBody::work_before),
                          after  = rigid_work(&RigidBody::work_after);
    const auto add               = [&](WorkLine &line, const auto &work) {
      if (watched.state.step == 0)
        line.add_start(work(dx, before), work(dx_next, after));
      else
        line.add_level(work(dx, before), work(dx_next, after));
    };
    add(external, [&](const NodalVector &increment, const RigidBody::Work &rigid) {
      return watched.external_forces.work(increment) + watched.conditions.reaction_work(increment) +
             rigid.external;
    });
    add(damping, [&](const NodalVector &increment, const RigidBody::Work &rigid) {
      return rigid.damping - watched.integrator.damping_work(increment);
    });
  }


  // What rounding of coordinates X to eps |X| looks like: nodes that move by a thousand times that
  // in each step, M (1000 eps max|X| / dt)^2. Energies below it say nothing about their balance.
  double
  Monitor::energy_of_rounding() const
  {
    const double eps = 1e3 * std::numeric_limits<double>::epsilon();
    double mass = 0., furthest = 0.;
    for (unsigned int node = 0; node < watched.discretization.n_owned_nodes; ++node)
      {
        mass += watched.discretization.mass[node];
        furthest = std::max(furthest, at_node(watched.state.x, node).norm());
      }
    const MPI_Comm communicator = watched.discretization.communicator();
    const double moved          = eps * Utilities::MPI::max(furthest, communicator);
    return Utilities::MPI::sum(mass, communicator) * std::pow(moved / watched.state.dt_next, 2);
  }


  void
  Monitor::sum_energies()
  {
    const std::array<double, 10> local = {{watched.integrator.kinetic_energy(),
                                           watched.internal_forces.internal_work(),
                                           watched.internal_forces.plastic_work(),
                                           damping.value(),
                                           interfaces.friction_dissipation(),
                                           interfaces.impact_dissipation(),
                                           watched.internal_forces.hourglass_work(),
                                           external.value(),
                                           interfaces.contact_energy(),
                                           interfaces.bond_energy()}};
    std::array<double, 10> all;
    Utilities::MPI::sum(ArrayView<const double>(local.data(), local.size()),
                        watched.discretization.communicator(),
                        ArrayView<double>(all.data(), all.size()));
    balance.kinetic = all[0];
    for (const auto &body : watched.rigid_bodies)
      balance.kinetic += body.kinetic_energy();
    balance.strain               = all[1] - all[2];
    balance.plastic_dissipation  = all[2];
    balance.damping_dissipation  = all[3];
    balance.friction_dissipation = all[4];
    balance.impact_dissipation   = all[5];
    balance.hourglass            = all[6];
    balance.external_work        = all[7];
    balance.contact              = all[8];
    balance.bond                 = all[9];
    if (watched.state.step == 0)
      {
        initial_energy = balance.sum();
        largest_energy = energy_of_rounding();
      }
    largest_energy = std::max({largest_energy, balance.kinetic, std::abs(balance.external_work)});
    const double error = energy_error();
    if (!(std::abs(error) <= std::abs(worst.energy_error)))
      worst.energy_error = error;
  }


  // Linear momentum sum m v_n and angular momentum about the origin, sum m x_n x v_n.
  std::vector<double>
  Monitor::momenta() const
  {
    // v_n = (dx_{n-1}/dt + dx_n/dt')/2 in plain arrays: this runs over all nodes for every row.
    const double before = 0.5 / watched.state.dt, after = 0.5 / watched.state.dt_next;
    const double *const x = watched.state.x.begin(), *const dx = watched.state.dx.begin(),
                        *const dx_next = watched.state.dx_next.begin();
    std::vector<double> sums(6, 0.);
    for (unsigned int node = 0; node < watched.discretization.n_owned_nodes; ++node)
      {
        const double m = watched.discretization.mass[node];
        double p[3];
        for (unsigned int d = 0; d < 3; ++d)
          {
            p[d] = m * (before * dx[3 * node + d] + after * dx_next[3 * node + d]);
            sums[d] += p[d];
          }
        const double *const X = x + 3 * node;
        sums[3] += X[1] * p[2] - X[2] * p[1];
        sums[4] += X[2] * p[0] - X[0] * p[2];
        sums[5] += X[0] * p[1] - X[1] * p[0];
      }
    Utilities::MPI::sum(sums, watched.discretization.communicator(), sums);
    for (const auto &body : watched.rigid_bodies)
      for (unsigned int d = 0; d < 3; ++d)
        {
          sums[d] += body.momentum()[d];
          sums[3 + d] += body.angular_momentum()[d];
        }
    return sums;
  }


  void
  Monitor::write_row()
  {
    const MPI_Comm communicator = watched.discretization.communicator();
    std::vector<double> row     = {watched.state.time,
                                   watched.state.dt_next,
                                   balance.kinetic,
                                   balance.strain,
                                   balance.plastic_dissipation,
                                   balance.damping_dissipation,
                                   balance.friction_dissipation,
                                   balance.impact_dissipation,
                                   balance.hourglass,
                                   balance.contact,
                                   balance.bond,
                                   balance.external_work,
                                   energy_error()};
    const auto append           = [&](const std::vector<double> &values) {
      row.insert(row.end(), values.begin(), values.end());
    };
    append(momenta());
    std::vector<double> maxima = {penetration, penetration_relative, report.driven_penetration};
    Utilities::MPI::max(maxima, communicator, maxima);
    append({maxima[0], maxima[1]});
    worst.penetration          = std::max(worst.penetration, maxima[0]);
    worst.penetration_relative = std::max(worst.penetration_relative, maxima[1]);
    is_driven                  = maxima[2] > 0.;
    penetration = penetration_relative = 0.;

    std::vector<double> sums = {double(report.active_pairs), double(report.sticking_pairs)};
    for (const auto &interface : report.interfaces)
      for (unsigned int d = 0; d < 3; ++d)
        sums.push_back(interface.force()[d]);
    Utilities::MPI::sum(sums, communicator, sums);
    n_active_pairs = sums[0];
    sums.insert(sums.begin() + 2, double(report.iterations));
    append(sums);
    for (const auto &body : watched.rigid_bodies)
      if (body.moves())
        for (const auto &value :
             {body.displacement(), body.rotation(), body.velocity(), body.spin()})
          append({value[0], value[1], value[2]});
    append(probes.values(watched.state));
    history.write_row(row);
    interfaces.write_row(report);
  }
} // namespace akmon
