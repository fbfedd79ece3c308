#include <akmon/forces/internal_forces.h>
#include <akmon/time/critical_step.h>

namespace akmon
{
  namespace
  {
    // A cell's frequency is computed anew when its tracker has changed by this much; in between the
    // calibrated tracker follows it.
    constexpr double tracker_tolerance = 0.02;
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
        calibrate(discretization.reference, batches, batch);
        const double *const scale = &batches.step_scale[std::size_t(batch) * 2 * n_lanes];
        for (unsigned int lane = 0; lane < batches.n_used_lanes[batch]; ++lane)
          if (scale[lane] * scale[n_lanes + lane] > frequency_squared)
          {
            frequency_squared       = scale[lane] * scale[n_lanes + lane];
            initially_limiting_cell = batches.first_cell + std::size_t(batch) * n_lanes + lane;
          }
      }
    }
  }


  void
  InternalForces::calibrate(const NodalVector &x, CellBatches &batches, const unsigned int batch)
  {
    Lanes positions[8][3], reference[8][3], zero[8][3], mass[8];
    gather(x.begin(), batches.nodes(batch), positions);
    gather(discretization.reference.begin(), batches.nodes(batch), reference);
    for (auto &node : zero)
      for (auto &component : node)
        component = Lanes(0.);

    lump_cell_mass(reference, discretization.material_of(batches.body).density, mass);

    const Lanes
      omega_squared     = largest_eigenvalue(positions,
                                         mass,
                                         discretization.material_of(batches.body).elasticity(),
                                         discretization.get_bodies()[batches.body].integration);
    const Lanes tracker = frequency_tracker(CellGeometry<Lanes>(positions, zero));

    // Lanes whose shape has hardly changed keep their calibration: a cell's step must not depend on
    // which cells share its batch.
    double *const scale     = &batches.step_scale[std::size_t(batch) * 2 * n_lanes];
    const Lanes old_scale   = Lanes::load_aligned(scale);
    const Lanes old_tracker = Lanes::load_aligned(scale + n_lanes);
    const auto changed      = xsimd::abs(tracker - old_tracker) > tracker_tolerance * old_tracker;
    select(changed, Lanes(omega_squared / tracker), old_scale).store_aligned(scale);
    select(changed, tracker, old_tracker).store_aligned(scale + n_lanes);
  }


  void
  InternalForces::update(const NodalVector &x, const NodalVector &dx, NodalVector &force)
  {
    frequency_squared = 0.;
    for (auto &batches : body_batches)
      std::visit(
        [&](const auto &law) {
          if (discretization.get_bodies()[batches.body].integration ==
              CellIntegration::mean_dilatation)
            update_body<true>(law, x, dx, batches, force);
          else
            update_body<false>(law, x, dx, batches, force);
        },
        discretization.material_of(batches.body).law);
  }


  template <bool mean_dilatation, typename Law>
  void
  InternalForces::update_body(const Law &law,
                              const NodalVector &x,
                              const NodalVector &dx,
                              CellBatches &batches,
                              NodalVector &force)
  {
    CellPassSums sums;
    Lanes largest(0.);
    to_calibrate.clear();
    for (unsigned int batch = 0; batch < batches.n_batches(); ++batch)
    {
      Lanes positions[8][3], increments[8][3], forces[8][3];
      gather(x.begin(), batches.nodes(batch), positions);
      gather(dx.begin(), batches.nodes(batch), increments);

      const CellGeometry<Lanes> cell(positions, increments);
      const Lanes owned = Lanes::load_aligned(&batches.owned[batch * n_lanes]);
      update_stress_and_force<mean_dilatation>(law,
                                               cell,
                                               owned,
                                               batches.state_at(batch),
                                               sums,
                                               forces);
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

      const double *const scale = &batches.step_scale[std::size_t(batch) * 2 * n_lanes];
      const Lanes tracker       = frequency_tracker(cell);
      const Lanes calibrated_at = Lanes::load_aligned(scale + n_lanes);
      largest                   = maximum(largest, Lanes(Lanes::load_aligned(scale) * tracker));
      if (xsimd::any(xsimd::abs(tracker - calibrated_at) > tracker_tolerance * calibrated_at))
        to_calibrate.push_back(batch);
    }
    work += xsimd::hadd(sums.internal_work);
    dissipated += xsimd::hadd(sums.plastic_work);
    for (unsigned int lane = 0; lane < n_lanes; ++lane)
      frequency_squared = std::max(frequency_squared, largest.get(lane));
    if (!cell_fault.occurred())
      for (const unsigned int batch : to_calibrate)
        calibrate(x, batches, batch);
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
