#include <akmon/contact/coupled/gather.h>
#include <akmon/contact/search/body_motions.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

namespace akmon
{
  using namespace dealii;

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


  // No two means are further apart than the corners of the box around all of them.
  void
  BodyMotions::measure_largest_approach()
  {
    double of_means = 0.;
    for (const unsigned int level : {0U, 1U})
      {
        Tensor<1, 3> widths;
        for (unsigned int d = 0; d < 3; ++d)
          {
            const auto [least, largest] = std::minmax_element(means.begin(),
                                                              means.end(),
                                                              [&](const auto &a, const auto &b) {
                                                                return a[level][d] < b[level][d];
                                                              });
            widths[d]                   = (*largest)[level][d] - (*least)[level][d];
          }
        of_means = std::max(of_means, widths.norm());
      }
    const double within = *std::max_element(within_bodies.begin(), within_bodies.end());
    largest_relative    = std::min(of_means + 2. * within, 2. * largest_increment);
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
