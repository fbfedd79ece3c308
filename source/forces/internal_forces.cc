#include <akmon/forces/cell_masses.h>
#include <akmon/forces/internal_forces.h>
#include <akmon/forces/one_point_cell.h>
#include <akmon/time/critical_step.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace akmon
{
  namespace
  {
    // A cell's frequency is computed anew when it may have grown by this factor since (squared),
    // and only if the cell is about to govern the step; until then the bound on its growth does.
    constexpr double growth_tolerance = 1.035;
    constexpr double governing_part   = 0.99;


    // Cells that were taken out are computed along, at rest in their initial shape and without
    // stress: their forces, works and strains are zero.
    void
    rest_eroded(const NodalVector &reference,
                const CellBatches &batches,
                const unsigned int batch,
                Lanes (&positions)[8][3],
                Lanes (&increments)[8][3])
    {
      const auto eroded = Lanes::load_aligned(&batches.eroded[std::size_t(batch) * n_lanes]) >
                          Lanes(0.);
      Lanes initial[8][3];
      gather(reference.begin(), batches.nodes(batch), initial);
      for (unsigned int v = 0; v < 8; ++v)
        for (unsigned int d = 0; d < 3; ++d)
          {
            positions[v][d]  = select(eroded, initial[v][d], positions[v][d]);
            increments[v][d] = select(eroded, Lanes(0.), increments[v][d]);
          }
    }


    // Undo what cells that cannot be computed have done to sums and forces.
    void
    keep_valid(const Lanes::batch_bool_type &valid,
               const CellPassSums<Lanes> &before,
               CellPassSums<Lanes> &sums,
               Lanes (&forces)[8][3])
    {
      sums.internal_work  = select(valid, sums.internal_work, before.internal_work);
      sums.plastic_work   = select(valid, sums.plastic_work, before.plastic_work);
      sums.hourglass_work = select(valid, sums.hourglass_work, before.hourglass_work);
      for (auto &of_node : forces)
        for (auto &component : of_node)
          component = select(valid, component, Lanes(0.));
    }
  } // namespace


  InternalForces::InternalForces(const Discretization &discretization)
    : discretization(discretization)
  {
    for (unsigned int body = 0; body < discretization.get_bodies().size(); ++body)
      body_batches.emplace_back(discretization, body);
    calibrate_initially();
  }


  void
  InternalForces::calibrate_initially()
  {
    frequency_squared = 0.;
    for (auto &batches : body_batches)
      {
        to_calibrate.resize(batches.n_cells);
        std::iota(to_calibrate.begin(), to_calibrate.end(), 0);
        calibrate(discretization.reference, batches, to_calibrate);
        for (std::size_t cell = 0; cell < batches.n_cells; ++cell)
          if (batches.frequency_bound(cell) > frequency_squared)
            {
              frequency_squared         = batches.frequency_bound(cell);
              initial_frequency_squared = frequency_squared;
              initially_limiting_cell   = batches.first_cell + cell;
            }
      }
    std::vector<std::size_t>().swap(to_calibrate); // never as many again
  }


  // Compute omega^2 of cells (numbers in the body) anew, as many at a time as there are lanes; a
  // cell's result does not depend on which others share them. Returns the largest.
  double
  InternalForces::calibrate(const NodalVector &x,
                            CellBatches &batches,
                            const std::vector<std::size_t> &wanted)
  {
    double largest = 0.;
    for (std::size_t first = 0; first < wanted.size(); first += n_lanes)
      {
        const unsigned int n_used = std::min<std::size_t>(n_lanes, wanted.size() - first);
        CellBatches::NodeOffsets nodes;
        std::size_t cells[n_lanes];
        for (unsigned int lane = 0; lane < n_lanes; ++lane)
          {
            const std::size_t cell = wanted[first + (lane < n_used ? lane : 0)];
            cells[lane]            = batches.first_cell + cell;
            for (unsigned int v = 0; v < 8; ++v)
              nodes[v][lane] = batches.nodes(cell / n_lanes)[v][cell % n_lanes];
          }
        Lanes positions[8][3], mass[8];
        gather(x.begin(), nodes, positions);
        lump_lane_masses(discretization, batches, nodes, cells, mass);
        const Lanes
          omega_squared = largest_eigenvalue(positions,
                                             mass,
                                             discretization.material_of(batches.body).elasticity(),
                                             discretization.get_bodies()[batches.body].integration);
        for (unsigned int lane = 0; lane < n_used; ++lane)
          {
            batches.set_frequency(wanted[first + lane], omega_squared.get(lane));
            largest = std::max(largest, omega_squared.get(lane));
          }
      }
    return largest;
  }


  void
  InternalForces::update(const NodalVector &x,
                         const NodalVector &dx,
                         NodalVector &force,
                         const double dt)
  {
    frequency_squared = 0.;
    growth_of_bounds  = Growth();
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
    Lanes largest(0.), growth_of_watched(1.), growth_elsewhere(1.);
    to_calibrate.clear();
    for (unsigned int batch = 0; batch < batches.n_batches(); ++batch)
      {
        const unsigned int next = std::min(batch + 1, batches.n_batches() - 1);
        Lanes positions[8][3], increments[8][3], forces[8][3];
        gather(x.begin(), batches.nodes(batch), positions);
        gather(dx.begin(), batches.nodes(batch), increments);
        if (batches.has_eroded[batch])
          rest_eroded(discretization.reference, batches, batch, positions, increments);

        const CellPassSums<Lanes> before = sums;
        const Lanes owned   = Lanes::load_aligned(&batches.owned[std::size_t(batch) * n_lanes]);
        double *const state = batches.state_at(batch);
        CellStep<Lanes> cell;
        if constexpr (integration == CellIntegration::one_point)
          {
            prefetch(batches.state_at(next), batches.batch_stride());
            prefetch(batches.hourglass_at(next), batches.hourglass_stride);
            cell = update_one_point_cell(law,
                                         constants,
                                         positions,
                                         increments,
                                         owned,
                                         state,
                                         batches.hourglass_at(batch),
                                         sums,
                                         forces);
          }
        else
          cell = update_stress_and_force<integration == CellIntegration::mean_dilatation>(
            law, positions, increments, owned, state, batches.state_at(next), sums, forces);

        const auto valid = cell.is_valid();
        if (!xsimd::all(valid))
          {
            remove_invalid(x, batches, batch, valid);
            keep_valid(valid, before, sums, forces);
          }
        scatter_subtract(forces, batches.nodes(batch), batches.n_used_lanes[batch], force.begin());

        const auto recalibrate = bound_frequency(select(valid, cell.strain_squared, Lanes(0.)),
                                                 batches,
                                                 batch,
                                                 largest,
                                                 growth_of_watched,
                                                 growth_elsewhere);
        if (xsimd::any(recalibrate))
          for (unsigned int lane = 0; lane < batches.n_used_lanes[batch]; ++lane)
            if (recalibrate.get(lane))
              to_calibrate.push_back(std::size_t(batch) * n_lanes + lane);
      }
    work += xsimd::hadd(sums.internal_work);
    dissipated += xsimd::hadd(sums.plastic_work);
    hourglass += xsimd::hadd(sums.hourglass_work);
    if (!cell_fault.occurred())
      frequency_squared = std::max(frequency_squared, calibrate(x, batches, to_calibrate));
    for (unsigned int lane = 0; lane < n_lanes; ++lane)
      {
        frequency_squared        = std::max(frequency_squared, largest.get(lane));
        growth_of_bounds.watched = std::max(growth_of_bounds.watched, growth_of_watched.get(lane));
        growth_of_bounds.elsewhere = std::max(growth_of_bounds.elsewhere,
                                              growth_elsewhere.get(lane));
      }
  }


  // Let the bound of each cell's frequency grow with the strain of the step. Returns the cells
  // whose bound has become too loose; the others enter the maximum.
  Lanes::batch_bool_type
  InternalForces::bound_frequency(const Lanes &strain_squared,
                                  CellBatches &batches,
                                  const unsigned int batch,
                                  Lanes &largest,
                                  Lanes &growth_of_watched,
                                  Lanes &growth_elsewhere) const
  {
    double *const frequency = &batches.frequencies[std::size_t(batch) * 2 * n_lanes];
    const Lanes factor = frequency_growth(strain_squared), in_step = factor * factor;
    const Lanes growth = Lanes::load_aligned(frequency + n_lanes) * in_step;
    growth.store_aligned(frequency + n_lanes);
    const Lanes bound      = Lanes::load_aligned(frequency) * growth;
    const auto recalibrate = (growth > Lanes(growth_tolerance)) &&
                             (bound > Lanes(governing_part * governing_frequency_squared));
    largest        = maximum(largest, select(recalibrate, Lanes(0.), bound));
    auto elsewhere = bound > Lanes(watch_threshold);
    if (batches.watched[batch])
      {
        const auto watched = batches.watched_lanes(batch);
        growth_of_watched  = maximum(growth_of_watched, select(watched, in_step, Lanes(1.)));
        elsewhere          = elsewhere && !watched;
      }
    growth_elsewhere = maximum(growth_elsewhere, select(elsewhere, growth, Lanes(1.)));
    return recalibrate;
  }


  double
  InternalForces::largest_cell_bound() const
  {
    double largest = 0.;
    for (const auto &batches : body_batches)
      for (std::size_t cell = 0; cell < batches.n_cells; ++cell)
        largest = std::max(largest, batches.frequency_bound(cell));
    return largest;
  }


  void
  InternalForces::tighten_bounds(const NodalVector &x, const double limit, const double factor)
  {
    for (auto &batches : body_batches)
      {
        to_calibrate.clear();
        for (std::size_t cell = 0; cell < batches.n_cells; ++cell)
          if (batches.frequency_growth(cell) > factor && batches.frequency_bound(cell) > limit)
            {
              to_calibrate.push_back(cell);
              batches.changed[cell / n_lanes] |= 1u << cell % n_lanes;
            }
        calibrate(x, batches, to_calibrate);
      }
  }


  // Cells of bodies that erode are taken out where they have turned inside out; nothing helps
  // against nodes without a place.
  void
  InternalForces::remove_invalid(const NodalVector &x,
                                 CellBatches &batches,
                                 const unsigned int batch,
                                 const Lanes::batch_bool_type &valid)
  {
    Lanes positions[8][3];
    gather(x.begin(), batches.nodes(batch), positions);
    Lanes sum(0.);
    for (const auto &of_node : positions)
      for (const auto &component : of_node)
        sum += component;
    for (unsigned int lane = 0; lane < n_lanes; ++lane)
      if (!valid.get(lane))
        {
          const bool finite = std::isfinite(sum.get(lane));
          if (finite && discretization.get_bodies()[batches.body].erodes)
            erode(batches, std::size_t(batch) * n_lanes + lane);
          else if (!cell_fault.occurred())
            report_fault(x, batches, batch, lane, !finite);
        }
  }


  void
  InternalForces::erode(CellBatches &batches, const std::size_t cell)
  {
    n_eroded_cells += batches.owned[cell] != 0.;
    batches.erode(cell);
  }


  std::size_t
  InternalForces::limiting_cell_now() const
  {
    std::size_t limiting = 0;
    double largest       = 0.;
    for (const auto &batches : body_batches)
      for (std::size_t cell = 0; cell < batches.n_cells; ++cell)
        if (batches.frequency_bound(cell) > largest)
          {
            largest  = batches.frequency_bound(cell);
            limiting = batches.first_cell + cell;
          }
    return limiting;
  }


  void
  InternalForces::erode_beyond(const double frequency_squared_limit)
  {
    frequency_squared = 0.;
    for (auto &batches : body_batches)
      for (std::size_t cell = 0; cell < batches.n_cells; ++cell)
        {
          if (discretization.get_bodies()[batches.body].erodes &&
              batches.frequency_bound(cell) > frequency_squared_limit)
            erode(batches, cell);
          frequency_squared = std::max(frequency_squared, batches.frequency_bound(cell));
        }
  }


  void
  InternalForces::report_fault(const NodalVector &x,
                               const CellBatches &batches,
                               const unsigned int batch,
                               const unsigned int lane,
                               const bool not_a_number)
  {
    const auto &cell        = discretization.cells[batches.index_of(batch, lane)];
    cell_fault.cell         = cell.id;
    cell_fault.body         = discretization.get_bodies()[cell.body].name;
    cell_fault.place        = dealii::Point<3>(at_node(x, cell.nodes[0]));
    cell_fault.not_a_number = not_a_number;
  }
} // namespace akmon
