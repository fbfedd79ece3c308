#include <akmon/time/assembled_frequency.h>

#include <deal.II/base/mpi.h>

#include <algorithm>

// When the bound is estimated anew, and from which cells; the estimate itself is in
// assembled_lanczos.cc.

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // The bound is estimated anew when omega^2 may be too large by this factor.
    constexpr double growth_tolerance = 1.03;
    // Cells whose omega^2 may have grown by this factor since the last full estimate have changed.
    constexpr double change_tolerance = 1.01;
    // A full estimate wants the bounds of cells to be this close.
    constexpr double cell_tolerance = 1.003;
    // Threshold of the cells that are looked at, over the last bound; without one, over the largest
    // cell's.
    constexpr double part_of_bound = 0.9, part_of_cells = 0.5;
    // Layers of further cells around them, in a full estimate and around what has changed.
    constexpr unsigned int n_layers = 1, n_layers_of_changed = 3;
    // A full estimate is due when this part of its cells has changed, or the bound by this factor.
    constexpr double most_changed = 0.4, largest_change = 1.25;
  } // namespace


  AssembledFrequency::AssembledFrequency(const Discretization &discretization,
                                         InternalForces &forces)
    : discretization(discretization)
    , forces(forces)
  {
  }


  double
  AssembledFrequency::follow(const NodalVector &x,
                             const InternalForces::Growth &growth,
                             const double largest_of_cells)
  {
    growth_since *= growth.watched;
    if (!(growth_since <= growth_tolerance && growth.elsewhere <= growth_tolerance))
      return estimate_anew(x);
    latest = std::min(largest_of_cells,
                      std::max(of_changed * growth_since, of_all * growth.elsewhere));
    return latest;
  }


  double
  AssembledFrequency::estimate(const NodalVector &x)
  {
    ++estimates;
    growth_since = 1.;
    of_all = of_changed = estimate_of_all(x);
    latest              = std::min(of_all, largest_of_cells());
    return latest;
  }


  double
  AssembledFrequency::estimate_anew(const NodalVector &x)
  {
    if (!(of_changed < largest_change * of_all))
      return estimate(x);
    forces.tighten_bounds(x, forces.watch_threshold, change_tolerance);
    const unsigned long n_all     = watch(false, n_layers),
                        n_changed = watch(true, n_layers_of_changed);
    if (n_changed >= most_changed * n_all)
      return estimate(x);
    ++estimates;
    growth_since = 1.;
    of_changed   = n_changed > 0 ? largest_ritz_value(x, of_all, largest_of_cells()) : of_all;
    latest       = std::min(std::max(of_changed, of_all * change_tolerance), largest_of_cells());
    return latest;
  }


  double
  AssembledFrequency::largest_of_cells() const
  {
    return Utilities::MPI::max(forces.largest_cell_bound(), discretization.communicator());
  }


  double
  AssembledFrequency::estimate_of_all(const NodalVector &x)
  {
    double threshold = of_changed > 0. ? part_of_bound * of_changed :
                                         part_of_cells * largest_of_cells();
    while (true)
      {
        forces.tighten_bounds(x, threshold, cell_tolerance);
        forces.watch_threshold = threshold;
        for (auto &batches : forces.batches())
          std::fill(batches.changed.begin(), batches.changed.end(), 0);
        watch(false, n_layers);
        const double largest = largest_of_cells();
        if (!(largest > 0.))
          return 0.;
        const double value = largest_ritz_value(x, threshold, largest);
        // What rests on the threshold says nothing about the cells below it.
        if (value > threshold / part_of_bound)
          return value;
        threshold *= part_of_bound * part_of_bound;
      }
  }


  // Watch the cells beyond the threshold, or those of them that have changed, and layers around
  // them. Returns their number on all ranks.
  unsigned long
  AssembledFrequency::watch(const bool changed_only, const unsigned int n_layers)
  {
    for (auto &batches : forces.batches())
      {
        std::fill(batches.watched.begin(), batches.watched.end(), 0);
        for (std::size_t cell = 0; cell < batches.n_cells; ++cell)
          if (batches.frequency_bound(cell) > forces.watch_threshold &&
              (!changed_only || batches.changed[cell / n_lanes] >> cell % n_lanes & 1))
            batches.watch(cell);
      }
    for (unsigned int layer = 0; layer < n_layers; ++layer)
      add_layer();
    unsigned long n_watched = 0;
    for (const auto &batches : forces.batches())
      for (std::size_t cell = 0; cell < batches.n_cells; ++cell)
        n_watched += batches.owned[cell] > 0. &&
                     (batches.watched[cell / n_lanes] >> cell % n_lanes & 1);
    return Utilities::MPI::sum(n_watched, discretization.communicator());
  }


  // All cells at nodes of watched cells. A rank knows all cells of the nodes it owns.
  void
  AssembledFrequency::add_layer()
  {
    NodalVector marks = discretization.make_vector();
    for (const auto &batches : forces.batches())
      for (unsigned int batch = 0; batch < batches.n_batches(); ++batch)
        if (batches.watched[batch])
          for (unsigned int lane = 0; lane < batches.n_used_lanes[batch]; ++lane)
            if (batches.watched[batch] >> lane & 1)
              for (unsigned int v = 0; v < 8; ++v)
                marks.local_element(batches.nodes(batch)[v][lane]) = 1.;
    // What ghost nodes have got here is not complete.
    marks.update_ghost_values();
    for (auto &batches : forces.batches())
      for (unsigned int batch = 0; batch < batches.n_batches(); ++batch)
        for (unsigned int lane = 0; lane < batches.n_used_lanes[batch]; ++lane)
          for (unsigned int v = 0; v < 8; ++v)
            if (marks.local_element(batches.nodes(batch)[v][lane]) > 0.)
              batches.watch(std::size_t(batch) * n_lanes + lane);
  }


  void
  AssembledFrequency::save(CheckpointWriter &checkpoint) const
  {
    checkpoint.numbers("assembled_frequency",
                       {of_all, of_changed, growth_since, latest, forces.watch_threshold});
    checkpoint.integer("frequency_estimates", estimates);
  }


  void
  AssembledFrequency::restore(const CheckpointReader &checkpoint)
  {
    const auto numbers     = checkpoint.numbers("assembled_frequency");
    of_all                 = numbers.at(0);
    of_changed             = numbers.at(1);
    growth_since           = numbers.at(2);
    latest                 = numbers.at(3);
    forces.watch_threshold = numbers.at(4);
    estimates              = checkpoint.integer("frequency_estimates");
  }
} // namespace akmon
