#include <akmon/contact/coupled/gather.h>
#include <akmon/contact/search/body_motions.h>
#include <akmon/contact/search/box_grid.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // No two of n vectors differ by more than the corners of the box around all of them.
    template <typename Vectors>
    double
    widest_difference(const unsigned int n, const Vectors &vector)
    {
      Box box{vector(0), vector(0)};
      for (unsigned int i = 1; i < n; ++i)
        box.include(vector(i));
      return (box.upper - box.lower).norm();
    }
  } // namespace


  BodyMotions::BodyMotions(const Discretization &discretization,
                           const std::vector<unsigned int> &surface_nodes)
    : discretization(discretization)
    , surface_nodes(surface_nodes)
    , means(discretization.get_bodies().size())
    , largest_of_bodies(means.size(), 0.)
    , within_bodies(means.size(), 0.)
    , increments(means.size(), 0.)
    , increments_within(means.size(), 0.)
  {
  }


  void
  BodyMotions::measure_means(const NodalState &state)
  {
    std::vector<double> sums(7 * means.size(), 0.);
    for (const unsigned int node : surface_nodes)
      {
        double *const sum   = &sums[7 * discretization.body_of_node[node]];
        const auto previous = at_node(state.dx, node), next = at_node(state.dx_next, node);
        for (unsigned int d = 0; d < 3; ++d)
          {
            sum[d] += previous[d];
            sum[3 + d] += next[d];
          }
        sum[6] += 1.;
      }
    Utilities::MPI::sum(sums, discretization.communicator(), sums);
    for (unsigned int body = 0; body < means.size(); ++body)
      for (unsigned int i = 0; i < 6; ++i)
        means[body][i / 3][i % 3] = sums[7 * body + i] / std::max(sums[7 * body + 6], 1.);
  }


  void
  BodyMotions::measure(const NodalState &state)
  {
    measure_means(state);
    std::vector<double> squares(2 * means.size(), 0.);
    for (const unsigned int node : surface_nodes)
      {
        const unsigned int body = discretization.body_of_node[node];
        const auto previous = at_node(state.dx, node), next = at_node(state.dx_next, node);
        double &largest = squares[2 * body], &within = squares[2 * body + 1];
        largest = std::max({largest, previous.norm_square(), next.norm_square()});
        within  = std::max({within,
                            (previous - means[body][0]).norm_square(),
                            (next - means[body][1]).norm_square()});
      }
    Utilities::MPI::max(squares, discretization.communicator(), squares);
    largest_increment = 0.;
    for (unsigned int body = 0; body < means.size(); ++body)
      {
        largest_of_bodies[body] = std::sqrt(squares[2 * body]);
        within_bodies[body]     = std::sqrt(squares[2 * body + 1]);
        largest_increment       = std::max(largest_increment, largest_of_bodies[body]);
      }
    measure_largest_approach();
    include_neighbours();
  }


  void
  BodyMotions::measure_largest_approach()
  {
    double of_means = 0.;
    for (const unsigned int level : {0U, 1U})
      of_means = std::max(of_means, widest_difference(means.size(), [&](const unsigned int body) {
                            return means[body][level];
                          }));
    const double within = *std::max_element(within_bodies.begin(), within_bodies.end());
    largest_relative    = std::min(of_means + 2. * within, 2. * largest_increment);
  }


  void
  BodyMotions::mark(const NodalState &state)
  {
    marked.clear();
    for (const unsigned int node : surface_nodes)
      marked.push_back(at_node(state.x, node));
  }


  // By body, of the boxes around displacements.
  std::vector<Tensor<1, 3>>
  BodyMotions::middles_since_mark(const NodalState &state) const
  {
    // Greatest values of u and of -u.
    std::vector<double> limits(6 * means.size(), std::numeric_limits<double>::lowest());
    for (unsigned int i = 0; i < surface_nodes.size(); ++i)
      {
        const auto u     = at_node(state.x, surface_nodes[i]) - marked[i];
        double *const of = &limits[6 * discretization.body_of_node[surface_nodes[i]]];
        for (unsigned int d = 0; d < 3; ++d)
          {
            of[d]     = std::max(of[d], u[d]);
            of[3 + d] = std::max(of[3 + d], -u[d]);
          }
      }
    Utilities::MPI::max(limits, discretization.communicator(), limits);
    std::vector<Tensor<1, 3>> middles(means.size());
    for (unsigned int body = 0; body < means.size(); ++body)
      for (unsigned int d = 0; d < 3; ++d)
        middles[body][d] = 0.5 * (limits[6 * body + d] - limits[6 * body + 3 + d]);
    return middles;
  }


  double
  BodyMotions::approach_since_mark(const NodalState &state) const
  {
    const auto middles = middles_since_mark(state);
    double within      = 0.;
    for (unsigned int i = 0; i < surface_nodes.size(); ++i)
      {
        const auto u = at_node(state.x, surface_nodes[i]) - marked[i];
        within       = std::max(within,
                          (u - middles[discretization.body_of_node[surface_nodes[i]]])
                            .norm_square());
      }
    within = std::sqrt(Utilities::MPI::max(within, discretization.communicator()));
    return widest_difference(middles.size(),
                             [&](const unsigned int body) { return middles[body]; }) +
           2. * within;
  }


  void
  BodyMotions::set_neighbours(std::vector<std::array<unsigned int, 2>> pairs)
  {
    const auto make_unique = [](auto &list) {
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
    };
    make_unique(pairs);
    neighbours = gather(pairs, discretization.communicator());
    make_unique(neighbours);
    include_neighbours();
  }


  void
  BodyMotions::include_neighbours()
  {
    increments         = largest_of_bodies;
    increments_within  = within_bodies;
    const auto include = [&](const unsigned int body, const unsigned int neighbour) {
      for (double *const increment : {&increments[body], &increments_within[body]})
        *increment = std::max(*increment, largest_of_bodies[neighbour]);
    };
    for (const auto &[a, b] : neighbours)
      if (a != b)
        {
          include(a, b);
          include(b, a);
        }
  }
} // namespace akmon
