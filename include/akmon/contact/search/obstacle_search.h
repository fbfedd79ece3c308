#pragma once

#include <akmon/contact/contact_nodes.h>
#include <akmon/contact/pair.h>
#include <akmon/rigid/rigid_body.h>

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
      for (auto &group : groups)
        group.clear_of = 0.;
    }

  private:
    struct Slave
    {
      unsigned int node;    ///< local number
      double size;          ///< least edge of its faces, initially; length
      double stiffness;     ///< mean of its faces' K A^2/V; force/length
      double clear_of = 0.; ///< nothing is closer than this minus what was travelled; length
    };

    // Slaves that follow each other are near each other, mostly.
    struct Group
    {
      double size     = 0.; ///< the largest of the slaves; length
      double clear_of = 0.; ///< the least of the slaves; length
    };

    static constexpr std::size_t n_in_group = 8;

    // The body in a step.
    struct Place
    {
      Pose pose;
      dealii::Tensor<2, 3> orientation;
      dealii::Tensor<1, 3> centre; ///< length
      unsigned int first_rigid;
      double travelled; ///< length
    };

    void
    find_pairs_of(const Place &place,
                  const double within,
                  const ContactNodes &nodes,
                  const ContactNodes::Field &x,
                  Slave &slave,
                  std::vector<ContactPair> &pairs);

    const RigidBody &body;
    const unsigned int interface;
    std::vector<BoundaryFace> faces;
    std::vector<Slave> slaves;
    std::vector<Group> groups; ///< n_in_group slaves each, the last one fewer
    std::vector<SurfacePoint> parts;
  };


  // Slaves this close, over their size, always get their pairs: bodies may be about to start.
  inline constexpr double always_near = 0.1;

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

  /// Remember the plane a pair was found with at @p x, in the frame of its rigid partner.
  void
  set_plane(ContactPair &pair, const Pose &pose, const dealii::Tensor<1, 3> &x);
} // namespace akmon
