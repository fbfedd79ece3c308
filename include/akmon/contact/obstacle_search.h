#pragma once

#include <akmon/contact/contact_nodes.h>
#include <akmon/contact/pair.h>
#include <akmon/rigid/rigid_body.h>

#include <utility>
#include <vector>

namespace akmon
{
  /// The contact nodes of rigid bodies that move: two each, numbered among the common ones.
  struct RigidNodes
  {
    static constexpr unsigned int none = -1;

    explicit RigidNodes(const std::vector<RigidBody> &bodies);

    unsigned int n = 0;              ///< of common nodes
    std::vector<unsigned int> first; ///< by body, or none: centre; the rotation comes next
  };


  /// Finds the pairs of slave nodes with one rigid obstacle.
  class ObstacleSearch
  {
  public:
    /// Throws InputError for unknown surfaces. @param interface  number for its pairs
    ObstacleSearch(const Discretization &discretization,
                   const RigidBody &body,
                   const unsigned int interface);

    /// Relevant faces of the surfaces the obstacle stops.
    const std::vector<BoundaryFace> &
    surface_faces() const
    {
      return faces;
    }

    /**
     * Append the pairs of this rank's slaves in configuration @p x, in the order of global node
     * numbers. Slaves that are further from the obstacle than @p reach, and than a part of their
     * size, are left out.
     * @param first_rigid  contact number of the body's centre, if it moves
     * @param travelled    how far nodes may have moved against the obstacle so far; length
     */
    void
    find_pairs(const ContactNodes &nodes,
               const ContactNodes::Field &x,
               const unsigned int first_rigid,
               const double reach,
               const double travelled,
               std::vector<ContactPair> &pairs);

    /// Look at all slaves again: what was travelled is counted from zero.
    void
    forget_rests()
    {
      for (auto &slave : slaves)
        slave.clear_of = 0.;
    }

  private:
    struct Slave
    {
      unsigned int node;    ///< local number
      double size;          ///< least edge of its faces, initially; length
      double stiffness;     ///< mean of its faces' K A^2/V; force/length
      double clear_of = 0.; ///< nothing is closer than this minus what was travelled; length
    };

    const RigidBody &body;
    const unsigned int interface;
    std::vector<BoundaryFace> faces;
    std::vector<Slave> slaves;
    std::vector<SurfacePoint> parts;
  };


  /// Finds where two rigid bodies touch. Rank 0 has the pairs.
  class RigidTouch
  {
  public:
    /**
     * @param pair       numbers of the bodies: the interface is the first one's
     * @param interface  number for its pairs
     * @param number     of this touch, for the names of its pairs
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
               std::vector<ContactPair> &pairs) const;

    /// The gap of a pair's feature with the bodies in other poses; false if there is none.
    bool
    gap_at(const ContactPair &pair, const std::vector<Pose> &poses, double &gap) const;

    unsigned int
    get_interface() const
    {
      return interface;
    }

  private:
    std::vector<TouchPoint>
    touch_points(const bool reversed,
                 const Pose &of_first,
                 const Pose &of_second,
                 const double within) const;

    const std::vector<RigidBody> &bodies;
    const unsigned int first, second;
    const unsigned int interface, number;
    double size; ///< of the smaller one; length
  };


  /// The distance of x from a body in some pose, with its normal in space.
  SurfacePoint
  closest_in_space(const RigidShape &shape, const Pose &pose, const dealii::Tensor<1, 3> &x);

  /**
   * The gap of a node at @p x from the obstacle in a pose: of the closest point, unless it looks
   * the other way, as on the back of a thin wall; there, and for the further sides of a concave
   * corner, of the plane that the pair was found with.
   */
  double
  obstacle_gap(const RigidShape &shape,
               const Pose &pose,
               const ContactPair &pair,
               const dealii::Tensor<1, 3> &x);
} // namespace akmon
