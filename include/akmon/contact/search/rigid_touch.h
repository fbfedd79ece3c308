#pragma once

#include <akmon/contact/contact_nodes.h>
#include <akmon/contact/pair.h>
#include <akmon/contact/search/obstacle_search.h>
#include <akmon/rigid/rigid_body.h>

#include <array>
#include <utility>
#include <vector>

namespace akmon
{
  /**
   * Finds where two rigid bodies touch: the points of one's features that are closest to the other,
   * and the other way round. Rank 0 has the pairs.
   *
   * Where a step leads, the closest points are elsewhere: on a rim that wobbles, far away. A
   * closest point there belongs to the pair next to it, whose gap it tells while it is near; where
   * there is no such pair another one joins.
   */
  class RigidTouch
  {
  public:
    /**
     * @param pair       numbers of the bodies: the interface is the first one's
     * @param interface  number for its pairs
     * @param number     of this touch: its pairs know it as their search
     */
    RigidTouch(const std::vector<RigidBody> &bodies,
               const std::pair<unsigned int, unsigned int> &pair,
               const unsigned int interface,
               const unsigned int number);

    /// Append pairs of the first body's features with the second body, or the other way round.
    void
    find_pairs(const ContactNodes &nodes,
               const RigidNodes &rigid_nodes,
               const bool reversed,
               const double reach,
               std::vector<ContactPair> &pairs);

    /// A point of a feature that the step takes into the other body.
    struct Uncovered
    {
      bool reversed;
      TouchPoint point; ///< where it is then
    };

    /**
     * Set the reached gaps of this touch's pairs with the bodies in other poses. Returns the points
     * that are inside without a pair that tells it.
     */
    std::vector<Uncovered>
    follow(const std::vector<Pose> &poses, const std::vector<ContactPair *> &pairs) const;

    /// The pair of such a point; its gap in those poses is counted on.
    /// @param dx  increments that lead to them, at all contact nodes
    ContactPair
    join(const Uncovered &uncovered,
         const std::vector<Pose> &poses,
         const ContactNodes &nodes,
         const RigidNodes &rigid_nodes,
         const ContactNodes::Field &dx);

    unsigned int
    get_interface() const
    {
      return interface;
    }

  private:
    /// The two bodies as one of them sees them, whose features are looked at.
    struct View
    {
      const RigidShape &shape, &other_shape;
      const Pose pose, other_pose;
      const dealii::Tensor<2, 3> R, other_R; ///< orientations

      SurfacePoint
      other_from(const dealii::Tensor<1, 3> &X) const;
      std::vector<TouchPoint>
      touch_points(const double within) const;
    };

    View
    view(const bool reversed, const Pose &of_first, const Pose &of_second) const;
    View
    present_view(const bool reversed) const;
    bool
    is_same(const TouchPoint &point,
            const View &view,
            const TouchPoint &reversed_point,
            const View &reversed_view) const;
    std::array<std::vector<TouchPoint>, 2>
    touch_points(const View &view, const View &reversed_view, const double within) const;
    double
    range(const ContactPair &pair, const std::vector<ContactPair *> &pairs) const;
    double
    gap_of_spot(const ContactPair &pair, const View &there) const;
    double
    distance_of_spot(const ContactPair &pair,
                     const TouchPoint &point,
                     const View &here,
                     const View &there) const;
    ContactPair *
    pair_next_to(const TouchPoint &point,
                 const std::vector<ContactPair *> &pairs,
                 const View &here,
                 const View &there) const;
    ContactPair
    make_pair(const bool reversed,
              const TouchPoint &point,
              const View &here,
              const ContactNodes &nodes,
              const RigidNodes &rigid_nodes) const;

    const std::vector<RigidBody> &bodies;
    const unsigned int first, second;
    const unsigned int interface, number;
    const double size; ///< of the smaller one; length
    /// Of the pairs of this step, by their row; not reversed and reversed.
    std::array<std::vector<TouchPoint>, 2> spots;
  };
} // namespace akmon
