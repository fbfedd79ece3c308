#include <akmon/contact/body_motions.h>
#include <akmon/contact/gather.h>

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
    , largest_of_bodies(2 * discretization.get_bodies().size(), 0.)
    , motions(discretization.get_bodies().size())
    , motions_within(motions)
  {
  }


  // By body: to and from the present level.
  std::vector<std::array<Tensor<1, 3>, 2>>
  BodyMotions::mean_increments(const NodalState &state) const
  {
    std::vector<double> sums(7 * motions.size(), 0.);
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
    std::vector<std::array<Tensor<1, 3>, 2>> means(motions.size());
    for (unsigned int body = 0; body < means.size(); ++body)
      for (unsigned int i = 0; i < 6; ++i)
        means[body][i / 3][i % 3] = sums[7 * body + i] / std::max(sums[7 * body + 6], 1.);
    return means;
  }


  void
  BodyMotions::measure(const NodalState &state)
  {
    const auto means = mean_increments(state);
    std::fill(largest_of_bodies.begin(), largest_of_bodies.end(), 0.);
    for (const unsigned int node : surface_nodes)
      {
        const unsigned int body = discretization.body_of_node[node];
        const auto previous = at_node(state.dx, node), next = at_node(state.dx_next, node);
        double &largest = largest_of_bodies[body],
               &within  = largest_of_bodies[motions.size() + body];
        largest         = std::max({largest, previous.norm_square(), next.norm_square()});
        within          = std::max({within,
                                    (previous - means[body][0]).norm_square(),
                                    (next - means[body][1]).norm_square()});
      }
    for (double &largest : largest_of_bodies)
      largest = std::sqrt(largest);
    Utilities::MPI::max(largest_of_bodies, discretization.communicator(), largest_of_bodies);
    largest_increment = 0.;
    for (unsigned int body = 0; body < motions.size(); ++body)
      {
        largest_increment = std::max(largest_increment, largest_of_bodies[body]);
        motions[body].way += largest_of_bodies[body];
        motions_within[body].way += largest_of_bodies[motions.size() + body];
      }
    include_neighbours();
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
    for (unsigned int body = 0; body < motions.size(); ++body)
      {
        motions[body].increment        = largest_of_bodies[body];
        motions_within[body].increment = largest_of_bodies[motions.size() + body];
      }
    const auto include = [&](const unsigned int body, const unsigned int neighbour) {
      for (Motion *const motion : {&motions[body], &motions_within[body]})
        motion->increment = std::max(motion->increment, largest_of_bodies[neighbour]);
    };
    for (const auto &[a, b] : neighbours)
      if (a != b)
        {
          include(a, b);
          include(b, a);
        }
  }
} // namespace akmon
