#pragma once

#include <akmon/model/discretization.h>
#include <akmon/model/nodal_state.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace akmon
{
  /**
   * How far the nodes of each body's contact surfaces move: what tells which of them can meet in a
   * step, body by body, so that fast bodies do not make slow ones look far. What a body's own
   * surfaces may meet in is their motion seen from the mean motion of these nodes.
   */
  class BodyMotions
  {
  public:
    /// @param surface_nodes  owned nodes on any contact surface; referred to
    BodyMotions(const Discretization &discretization,
                const std::vector<unsigned int> &surface_nodes);

    /// Take up the increments to and from the present level (collective).
    void
    measure(const NodalState &state);

    /**
     * Bodies that may meet: in a step forces may hand on the motion of one to the other.
     * @param pairs  any on any rank, in any order (collective)
     */
    void
    set_neighbours(std::vector<std::array<unsigned int, 2>> pairs);

    /// Take this level for the one that approach_since_mark() looks back to.
    void
    mark(const NodalState &state);

    /**
     * By how much two surfaces can have approached each other since the marked level at most, of
     * whatever bodies (collective); length. With the displacements u since then and any vector u_a
     * for body a, here the middle of the box around its u,
     *
     *     |x_i - x_j| >= |x_i - x_j|_marked - |u_a - u_b| - max_a |u - u_a| - max_b |u - u_b|
     *
     * for points i of body a and j of body b, nodes or in faces between them. Bodies that swing
     * come closer by their amplitudes only, for however many steps they do.
     */
    double
    approach_since_mark(const NodalState &state) const;

    /// Largest increment of a node of any body; length
    double
    largest() const
    {
      return largest_increment;
    }

    /// By how much two surfaces can approach each other in the step at most, of whatever bodies;
    /// length
    double
    largest_approach() const
    {
      return largest_relative;
    }

    /// The same, of two bodies, or of one whose surface meets itself; length
    double
    approach(const unsigned int a, const unsigned int b) const
    {
      const double of_means = std::sqrt(std::max((means[a][0] - means[b][0]).norm_square(),
                                                 (means[a][1] - means[b][1]).norm_square()));
      return std::min(of_means + within_bodies[a] + within_bodies[b],
                      largest_of_bodies[a] + largest_of_bodies[b]);
    }

    /// Largest increment of a node of a body or of its neighbours; length
    double
    around(const unsigned int body) const
    {
      return increments[body];
    }

    /// The same seen from the body's mean motion, but for the neighbours'.
    double
    within(const unsigned int body) const
    {
      return increments_within[body];
    }

  private:
    void
    measure_means(const NodalState &state);
    std::vector<dealii::Tensor<1, 3>>
    middles_since_mark(const NodalState &state) const;
    void
    measure_largest_approach();
    void
    include_neighbours();

    const Discretization &discretization;
    const std::vector<unsigned int> &surface_nodes;
    double largest_increment = 0., largest_relative = 0.;
    // By body: the mean increments to and from the present level, the largest increment, and the
    // largest one seen from the mean; then both with neighbours.
    std::vector<std::array<dealii::Tensor<1, 3>, 2>> means;
    std::vector<double> largest_of_bodies, within_bodies, increments, increments_within;
    std::vector<std::array<unsigned int, 2>> neighbours;
    std::vector<dealii::Tensor<1, 3>> marked; ///< positions of the surface nodes; length
  };
} // namespace akmon
