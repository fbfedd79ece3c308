#include <akmon/forces/cell_masses.h>
#include <akmon/forces/elastic_stiffness.h>
#include <akmon/time/assembled_frequency.h>

#include <deal.II/base/mpi.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>

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
    // Added to omega^2 for what the iteration may have left.
    constexpr double margin = 1.006;
    // Lanczos' method ends when the residual of the largest Ritz pair is below this part of it.
    constexpr double residual_tolerance = 0.01;
    constexpr unsigned int most_steps = 160, steps_between_looks = 4;


    // What n steps from a random vector of N numbers leave goes with (log N/n)^2 (Kuczynski and
    // Wozniakowski, SIAM J. Matrix Anal. Appl. 13, 1992): these leave half a percent on meshes of
    // cubes.
    unsigned int
    least_steps(const double n_numbers)
    {
      return 8 + 3.5 * std::log(n_numbers);
    }


    // Sum of numbers whose partial sums do not exceed a bound, in fixed point: the same bits in any
    // order.
    class FixedPointSum
    {
    public:
      explicit FixedPointSum(const double bound)
        : scale(std::ldexp(1., 61) / bound)
      {
      }

      void
      add(const double term)
      {
        sum += static_cast<std::int64_t>(term * scale);
      }

      double
      total(const MPI_Comm communicator) const
      {
        return double(Utilities::MPI::sum(sum, communicator)) / scale;
      }

    private:
      const double scale;
      std::int64_t sum = 0;
    };


    // A number between -1 and 1 that depends on a number only (splitmix64).
    double
    scatter_number(std::uint64_t number)
    {
      number += 0x9e3779b97f4a7c15u;
      number = (number ^ (number >> 30)) * 0xbf58476d1ce4e5b9u;
      number = (number ^ (number >> 27)) * 0x94d049bb133111ebu;
      return std::ldexp(double(number ^ (number >> 31)), -63) - 1.;
    }


    // Largest Ritz value of Lanczos' tridiagonal matrix and the residual of its pair.
    std::pair<double, double>
    largest_ritz_pair(const std::vector<double> &diagonal, const std::vector<double> &off_diagonal)
    {
      const unsigned int n = diagonal.size();
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
      solver.computeFromTridiagonal(Eigen::Map<const Eigen::VectorXd>(diagonal.data(), n),
                                    Eigen::Map<const Eigen::VectorXd>(off_diagonal.data(), n - 1));
      return {solver.eigenvalues()[n - 1],
              off_diagonal[n - 1] * std::abs(solver.eigenvectors()(n - 1, n - 1))};
    }
  } // namespace


  struct AssembledFrequency::Work
  {
    explicit Work(const Discretization &discretization)
      : v(discretization.make_vector())
      , v_before(discretization.make_vector())
      , force(discretization.make_vector())
      , mass_inside(discretization.n_nodes, 0.)
    {
    }

    NodalVector v, v_before, force;
    std::vector<double> mass_inside; ///< of the cells looked at
    std::vector<unsigned int> nodes; ///< owned ones of the cells looked at
  };


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
  AssembledFrequency::collect_nodes(Work &work) const
  {
    for (const auto &batches : forces.batches())
      for (unsigned int batch = 0; batch < batches.n_batches(); ++batch)
        if (batches.watched[batch])
          {
            Lanes mass[8];
            lump_batch_masses(discretization, batches, batch, mass);
            for (unsigned int lane = 0; lane < batches.n_used_lanes[batch]; ++lane)
              if (batches.watched[batch] >> lane & 1)
                for (unsigned int v = 0; v < 8; ++v)
                  work.mass_inside[batches.nodes(batch)[v][lane] / 3] += mass[v].get(lane);
          }
    for (unsigned int node = 0; node < discretization.n_owned_nodes; ++node)
      if (work.mass_inside[node] > 0.)
        work.nodes.push_back(node);
  }


  // White noise M^{1/2} v: no vector is missed.
  void
  AssembledFrequency::start_vector(Work &work) const
  {
    const std::uint64_t n = discretization.partitioner->size();
    FixedPointSum norm_squared(n);
    for (const unsigned int node : work.nodes)
      {
        const double scale         = 1. / std::sqrt(discretization.mass[node]);
        const std::uint64_t number = 3 * discretization.global_node(node) + n * estimates;
        double sum                 = 0.;
        for (unsigned int d = 0; d < 3; ++d)
          {
            const double value                 = scatter_number(number + d);
            work.v.local_element(3 * node + d) = scale * value;
            sum += value * value;
          }
        norm_squared.add(sum);
      }
    const double norm = std::sqrt(norm_squared.total(discretization.communicator()));
    for (const unsigned int node : work.nodes)
      for (unsigned int d = 0; d < 3; ++d)
        work.v.local_element(3 * node + d) /= norm;
    work.v.update_ghost_values();
  }


  // force = - K_S v, complete at owned nodes
  void
  AssembledFrequency::apply(const NodalVector &x, Work &work)
  {
    work.force = 0.;
    for (const auto &batches : forces.batches())
      {
        const Elasticity elasticity       = discretization.material_of(batches.body).elasticity();
        const CellIntegration integration = discretization.get_bodies()[batches.body].integration;
        for (unsigned int batch = 0; batch < batches.n_batches(); ++batch)
          if (batches.watched[batch])
            {
              Lanes positions[8][3], v[8][3], f[8][3];
              gather(x.begin(), batches.nodes(batch), positions);
              gather(work.v.begin(), batches.nodes(batch), v);
              ElasticCell<Lanes>(TrilinearGradients<Lanes>::evaluate(positions),
                                 elasticity,
                                 integration)
                .apply(v, f);
              const auto watched = batches.watched_lanes(batch);
              for (auto &of_node : f)
                for (auto &component : of_node)
                  component = select(watched, component, Lanes(0.));
              scatter_subtract(f,
                               batches.nodes(batch),
                               batches.n_used_lanes[batch],
                               work.force.begin());
              applications += n_lanes;
            }
      }
  }


  // Lanczos' method in the inner product of the masses: with w = M^{-1} (K_S + outside M_rest) v_j
  // - b_{j-1} v_{j-1}, a_j = v_j . M w and b_j v_{j+1} = w - a_j v_j.
  double
  AssembledFrequency::largest_ritz_value(const NodalVector &x,
                                         const double outside,
                                         const double largest)
  {
    const MPI_Comm communicator = discretization.communicator();
    Work work(discretization);
    collect_nodes(work);
    start_vector(work);
    const unsigned int least = least_steps(3. *
                                           Utilities::MPI::sum(work.nodes.size(), communicator));
    std::vector<double> diagonal, off_diagonal;
    std::pair<double, double> pair;
    double b = 0.;
    for (unsigned int step = 1;; ++step)
      {
        apply(x, work);
        FixedPointSum a(4. * largest), b_squared(16. * largest * largest);
        for (const unsigned int node : work.nodes)
          {
            const double mass = discretization.mass[node], inverse_mass = 1. / mass;
            const double of_rest = outside * (1. - work.mass_inside[node] * inverse_mass);
            double sum           = 0.;
            for (unsigned int i = 3 * node; i < 3 * node + 3; ++i)
              {
                const double v = work.v.local_element(i);
                double &w      = work.v_before.local_element(i);
                w              = of_rest * v - inverse_mass * work.force.local_element(i) - b * w;
                sum += v * w;
              }
            a.add(mass * sum);
          }
        diagonal.push_back(a.total(communicator));
        for (const unsigned int node : work.nodes)
          {
            double sum = 0.;
            for (unsigned int i = 3 * node; i < 3 * node + 3; ++i)
              {
                double &w = work.v_before.local_element(i);
                w -= diagonal.back() * work.v.local_element(i);
                sum += w * w;
              }
            b_squared.add(discretization.mass[node] * sum);
          }
        b = std::sqrt(b_squared.total(communicator));
        off_diagonal.push_back(b);
        const bool invariant = !(b > 1e-6 * largest); // nothing but round-off is left
        if (invariant || (step >= least && step % steps_between_looks == 0))
          {
            pair = largest_ritz_pair(diagonal, off_diagonal);
            if (invariant || step >= most_steps || pair.second < residual_tolerance * pair.first)
              return margin * (pair.first + pair.second);
          }
        for (const unsigned int node : work.nodes)
          for (unsigned int i = 3 * node; i < 3 * node + 3; ++i)
            work.v_before.local_element(i) /= b;
        work.v.swap(work.v_before);
        work.v.update_ghost_values();
      }
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
