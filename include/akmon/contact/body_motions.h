#pragma once

#include <akmon/model/discretization.h>
#include <akmon/model/nodal_state.h>

#include <array>
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
    /// The motion of a body's fastest node; length
    struct Motion
    {
      double increment = 0.; ///< in the step
      double way       = 0.; ///< in all steps so far
    };

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

    /// Largest increment of a node of any body; length
    double
    largest() const
    {
      return largest_increment;
    }

    /// Of a body, with the increments of its neighbours.
    const Motion &
    of(const unsigned int body) const
    {
      return motions[body];
    }

    /// The same seen from the body's mean motion.
    const Motion &
    within(const unsigned int body) const
    {
      return motions_within[body];
    }

  private:
    std::vector<std::array<dealii::Tensor<1, 3>, 2>>
    mean_increments(const NodalState &state) const;
    void
    include_neighbours();

    const Discretization &discretization;
    const std::vector<unsigned int> &surface_nodes;
    double largest_increment = 0.;
    std::vector<double> largest_of_bodies; ///< without neighbours; then from the mean motion
    std::vector<Motion> motions, motions_within;
    std::vector<std::array<unsigned int, 2>> neighbours;
  };
} // namespace akmon
