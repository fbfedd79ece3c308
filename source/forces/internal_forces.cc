#include <akmon/forces/internal_forces.h>
#include <akmon/forces/one_point_cell.h>
#include <akmon/time/critical_step.h>

#include <algorithm>

namespace akmon
{
  namespace
  {
    // A cell's frequency is computed anew when it may have grown by this factor since (squared),
    // and only if the cell is about to govern the step; until then the bound on its growth does.
    constexpr double growth_tolerance = 1.035;
    constexpr double governing_part   = 0.99;
  } // namespace


  InternalForces::InternalForces(const Discretization &discretization)
    : discretization(discretization)
  {
    for (unsigned int body = 0; body < discretization.get_bodies().size(); ++body)
      {
        body_batches.emplace_back(discretization, body);
        CellBatches &batches = body_batches.back();
        for (unsigned int batch = 0; batch < batches.n_batches(); ++batch)
          {
            calibrate(discretization.reference, batches, batch, Lanes(0.) < Lanes(1.));
            const double *const omega_squared = &batches
                                                   .frequencies[std::size_t(batch) * 2 * n_lanes];
            for (unsigned int lane = 0; lane < batches.n_used_lanes[batch]; ++lane)
              if (omega_squared[lane] > frequency_squared)
                {
                  frequency_squared       = omega_squared[lane];
                  initially_limiting_cell = batches.first_cell + std::size_t(batch) * n_lanes +
                                            lane;
                }
          }
      }
  }


  void
  InternalForces::calibrate(const NodalVector &x,
                            CellBatches &batches,
                            const unsigned int batch,
                            const Lanes::batch_bool_type &wanted)
  {
    Lanes positions[8][3], reference[8][3], mass[8];
    gather(x.begin(), batches.nodes(batch), positions);
    gather(discretization.reference.begin(), batches.nodes(batch), reference);
    lump_cell_mass(reference, discretization.material_of(batches.body).density, mass);
    const Lanes
      omega_squared = largest_eigenvalue(positions,
                                         mass,
                                         discretization.material_of(batches.body).elasticity(),
                                         discretization.get_bodies()[batches.body].integration);

    // The other lanes keep what they have: a cell's step must not depend on which cells share its
    // batch.
    double *const frequency = &batches.frequencies[std::size_t(batch) * 2 * n_lanes];
    double *const growth    = frequency + n_lanes;
    select(wanted, omega_squared, Lanes::load_aligned(frequency)).store_aligned(frequency);
    select(wanted, Lanes(1.), Lanes::load_aligned(growth)).store_aligned(growth);
  }


  void
  InternalForces::update(const NodalVector &x,
                         const NodalVector &dx,
                         NodalVector &force,
                         const double dt)
  {
    frequency_squared = 0.;
    for (auto &batches : body_batches)
      std::visit(
        [&](const auto &law) {
          switch (discretization.get_bodies()[batches.body].integration)
            {
              case CellIntegration::full:
                update_body<CellIntegration::full>(law, x, dx, dt, batches, force);
                break;
              case CellIntegration::mean_dilatation:
                update_body<CellIntegration::mean_dilatation>(law, x, dx, dt, batches, force);
                break;
              case CellIntegration::one_point:
                update_body<CellIntegration::one_point>(law, x, dx, dt, batches, force);
                break;
            }
        },
        discretization.material_of(batches.body).law);
  }


  template <CellIntegration integration, typename Law>
  void
  InternalForces::update_body(const Law &law,
                              const NodalVector &x,
                              const NodalVector &dx,
                              const double dt,
                              CellBatches &batches,
                              NodalVector &force)
  {
    const Body &body         = discretization.get_bodies()[batches.body];
    const Material &material = discretization.material_of(batches.body);
    const HourglassConstants constants(body.hourglass_control,
                                       body.hourglass_coefficient,
                                       material.elasticity(),
                                       material.density,
                                       dt);
    CellPassSums<Lanes> sums;
    Lanes largest(0.);
    to_calibrate.clear();
    for (unsigned int batch = 0; batch < batches.n_batches(); ++batch)
      {
        const unsigned int next = std::min(batch + 1, batches.n_batches() - 1);
        for (const NodalVector *const vector : {&x, &dx, static_cast<const NodalVector *>(&force)})
          prefetch_nodes(vector->begin(), batches.nodes(next));

        Lanes positions[8][3], increments[8][3], forces[8][3];
        gather(x.begin(), batches.nodes(batch), positions);
        gather(dx.begin(), batches.nodes(batch), increments);

        const Lanes owned   = Lanes::load_aligned(&batches.owned[std::size_t(batch) * n_lanes]);
        double *const state = batches.state_at(batch);
        CellStep<Lanes> cell;
        if constexpr (integration == CellIntegration::one_point)
          cell = update_one_point_cell(law,
                                       constants,
                                       positions,
                                       increments,
                                       owned,
                                       state,
                                       &batches.hourglass[std::size_t(batch) * 12 * n_lanes],
                                       sums,
                                       forces);
        else
          cell = update_stress_and_force<integration == CellIntegration::mean_dilatation>(
            law, positions, increments, owned, state, batches.state_at(next), sums, forces);
        scatter_subtract(forces, batches.nodes(batch), batches.n_used_lanes[batch], force.begin());

        // A comparison with NaN is false: this finds inverted and non-finite cells.
        const auto valid = cell.smallest_jacobian > Lanes(0.);
        if (!xsimd::all(valid) && !cell_fault.occurred())
          for (unsigned int lane = 0; lane < n_lanes; ++lane)
            if (!valid.get(lane))
              {
                report_fault(x, batches, batch, lane);
                break;
              }

        const auto recalibrate = bound_frequency(cell.strain_squared, batches, batch, largest);
        if (xsimd::any(recalibrate))
          to_calibrate.emplace_back(batch, recalibrate);
      }
    work += xsimd::hadd(sums.internal_work);
    dissipated += xsimd::hadd(sums.plastic_work);
    hourglass += xsimd::hadd(sums.hourglass_work);
    if (!cell_fault.occurred())
      for (const auto &[batch, wanted] : to_calibrate)
        {
          calibrate(x, batches, batch, wanted);
          const Lanes omega_squared = Lanes::load_aligned(
            &batches.frequencies[std::size_t(batch) * 2 * n_lanes]);
          largest = maximum(largest, select(wanted, omega_squared, Lanes(0.)));
        }
    for (unsigned int lane = 0; lane < n_lanes; ++lane)
      frequency_squared = std::max(frequency_squared, largest.get(lane));
  }


  // Let the bound of each cell's frequency grow with the strain of the step. Returns the cells
  // whose bound has become too loose; the others enter the maximum.
  Lanes::batch_bool_type
  InternalForces::bound_frequency(const Lanes &strain_squared,
                                  CellBatches &batches,
                                  const unsigned int batch,
                                  Lanes &largest) const
  {
    double *const frequency = &batches.frequencies[std::size_t(batch) * 2 * n_lanes];
    const Lanes factor      = frequency_growth(strain_squared);
    const Lanes growth      = Lanes::load_aligned(frequency + n_lanes) * factor * factor;
    growth.store_aligned(frequency + n_lanes);
    const Lanes bound      = Lanes::load_aligned(frequency) * growth;
    const auto recalibrate = (growth > Lanes(growth_tolerance)) &&
                             (bound > Lanes(governing_part * governing_frequency_squared));
    largest = maximum(largest, select(recalibrate, Lanes(0.), bound));
    return recalibrate;
  }


  void
  InternalForces::report_fault(const NodalVector &x,
                               const CellBatches &batches,
                               const unsigned int batch,
                               const unsigned int lane)
  {
    const std::size_t index = batches.first_cell + std::size_t(batch) * n_lanes +
                              (lane < batches.n_used_lanes[batch] ? lane : 0);
    const auto &cell = discretization.cells[index];
    cell_fault.cell  = cell.id;
    cell_fault.body  = discretization.get_bodies()[cell.body].name;
    cell_fault.place = dealii::Point<3>(at_node(x, cell.nodes[0]));
  }
} // namespace akmon
