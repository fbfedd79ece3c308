#include <akmon/forces/cell_masses.h>
#include <akmon/forces/elastic_stiffness.h>
#include <akmon/time/assembled_frequency.h>

#include <deal.II/base/mpi.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstdint>

// Lanczos' method on the cells that AssembledFrequency watches.

namespace akmon
{
  using namespace dealii;

  namespace
  {
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
      : discretization(discretization)
      , v(discretization.make_vector())
      , v_before(discretization.make_vector())
      , force(discretization.make_vector())
      , mass_inside(discretization.n_nodes, 0.)
    {
    }

    void
    step(const double outside, const double largest);
    void
    go_on();

    const Discretization &discretization;
    NodalVector v, v_before, force;
    std::vector<double> mass_inside;            ///< of the cells looked at
    std::vector<unsigned int> nodes;            ///< owned ones of the cells looked at
    std::vector<double> diagonal, off_diagonal; ///< a_j and b_j
  };


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
  // - b_{j-1} v_{j-1}, a_j = v_j . M w and b_j v_{j+1} = w - a_j v_j. Here force is - K_S v_j;
  // b_j v_{j+1} takes the place of v_{j-1}. Sums are bounded by those with the largest frequency.
  void
  AssembledFrequency::Work::step(const double outside, const double largest)
  {
    const MPI_Comm communicator = discretization.communicator();
    const double b              = off_diagonal.empty() ? 0. : off_diagonal.back();
    FixedPointSum a(4. * largest), b_squared(16. * largest * largest);
    for (const unsigned int node : nodes)
      {
        const double mass = discretization.mass[node], inverse_mass = 1. / mass;
        const double of_rest = outside * (1. - mass_inside[node] * inverse_mass);
        double sum           = 0.;
        for (unsigned int i = 3 * node; i < 3 * node + 3; ++i)
          {
            const double v_i = v.local_element(i);
            double &w        = v_before.local_element(i);
            w                = of_rest * v_i - inverse_mass * force.local_element(i) - b * w;
            sum += v_i * w;
          }
        a.add(mass * sum);
      }
    diagonal.push_back(a.total(communicator));
    for (const unsigned int node : nodes)
      {
        double sum = 0.;
        for (unsigned int i = 3 * node; i < 3 * node + 3; ++i)
          {
            double &w = v_before.local_element(i);
            w -= diagonal.back() * v.local_element(i);
            sum += w * w;
          }
        b_squared.add(discretization.mass[node] * sum);
      }
    off_diagonal.push_back(std::sqrt(b_squared.total(communicator)));
  }


  // To v_{j+1}.
  void
  AssembledFrequency::Work::go_on()
  {
    for (const unsigned int node : nodes)
      for (unsigned int i = 3 * node; i < 3 * node + 3; ++i)
        v_before.local_element(i) /= off_diagonal.back();
    v.swap(v_before);
    v.update_ghost_values();
  }


  double
  AssembledFrequency::largest_ritz_value(const NodalVector &x,
                                         const double outside,
                                         const double largest)
  {
    Work work(discretization);
    collect_nodes(work);
    start_vector(work);
    const unsigned int least = least_steps(
      3. * Utilities::MPI::sum(work.nodes.size(), discretization.communicator()));
    for (unsigned int step = 1;; ++step)
      {
        apply(x, work);
        work.step(outside, largest);
        // Else nothing but round-off is left.
        const bool goes_on = work.off_diagonal.back() > 1e-6 * largest;
        if (!goes_on || (step >= least && step % steps_between_looks == 0))
          {
            const auto [value, residual] = largest_ritz_pair(work.diagonal, work.off_diagonal);
            if (!goes_on || step >= most_steps || residual < residual_tolerance * value)
              return margin * (value + residual);
          }
        work.go_on();
      }
  }
} // namespace akmon
