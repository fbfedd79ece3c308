#pragma once

#include <akmon/contact/contact_nodes.h>
#include <akmon/contact/contact_parameters.h>
#include <akmon/contact/pair.h>
#include <akmon/contact/search/surface_search.h>

#include <array>
#include <vector>

namespace akmon
{
  /// A convex edge of a body at which its surface turns sharply, with the faces that meet there.
  struct FeatureEdge
  {
    std::array<ContactNodes::Id, 2> ids;                  ///< of its ends, the lower one first
    std::array<std::array<ContactNodes::Id, 4>, 2> faces; ///< ids of the corners, counter-clockwise
    unsigned int n_faces; ///< on the contact surface: one at its rim
    unsigned int body;
    double angle;                     ///< by which the surface turns, initially; radians
    double size;                      ///< least edge of both faces, initially; length
    double depth;                     ///< thickness of the thinner cell behind the faces; length
    double stiffness;                 ///< K A^2/V of the softer cell; force/length
    std::array<unsigned char, 2> end; ///< whether the edge does not go on there

    // On this rank, once the nodes are numbered.
    unsigned int first;                                 ///< local number of the first end, if owned
    std::array<unsigned int, 2> nodes;                  ///< contact numbers of the ends
    std::array<std::array<unsigned int, 4>, 2> corners; ///< and of the corners

    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int)
    {
      archive &ids &faces &n_faces &body &angle &size &depth &stiffness &end;
    }
  };


  /// Where the lines through two edges are closest.
  struct EdgeCrossing
  {
    double s, t;                 ///< parts of the slave's and the master's edge
    dealii::Tensor<1, 3> normal; ///< of both, outward from the master
    double gap;                  ///< along the normal; length
    double sine;                 ///< of the angle between the edges
  };


  /**
   * Finds the edges of the two sides of a contact that cross: where corners of cells meet, neither
   * side's nodes see the other side's faces. Two edges are a pair if their closest points are on
   * both, and if both bodies lie on their sides of the plane in between: the common normal is one
   * of the normals that the surface takes as it turns about the edge, for both.
   *
   * A pair belongs to the owner of the slave edge's first node.
   */
  class EdgeSearch
  {
  public:
    /**
     * @param surfaces  search of the same contact, not reversed: its faces
     * @param interface  number of the contact
     */
    EdgeSearch(const Discretization &discretization,
               const SurfaceContact &contact,
               const SurfaceSearch &surfaces,
               const unsigned int interface);

    /// Get the master's edges near this rank's from their owners (collective). Returns the nodes of
    /// all edges here. @param radius  over which partners are looked for; length
    std::vector<ContactNodes::Id>
    fetch_edges(const ContactNodes &nodes, const NodalVector &x, const double radius);

    /// For every slave edge those of the master within the radius.
    void
    build_candidates(const ContactNodes &nodes, const ContactNodes::Field &x, const double radius);

    /**
     * Append the pairs of this rank in configuration @p x, sorted by their keys.
     * @param next      where the last increment would lead from there
     * @param reach     what may be closed in this step; length
     * @param previous  pairs of the last step: edges that have passed each other before the search
     *                  saw them are none, those that were a pair remain one
     */
    void
    find_pairs(const ContactNodes::Field &x,
               const ContactNodes::Field &next,
               const double reach,
               const std::vector<ContactPair> &previous,
               std::vector<ContactPair> &pairs) const;

    /// The gap of a pair in another configuration; false if its edges do not cross there.
    bool
    gap_at(const ContactNodes::Field &x, const ContactPair &pair, double &gap) const;

  private:
    // On the rank that owns its first node.
    struct OwnEdge
    {
      FeatureEdge edge;
      std::array<unsigned int, 2> nodes; ///< local numbers
      std::array<std::array<unsigned int, 4>, 2> faces;
    };

    // An edge of a boundary face, from its corner k to the next one.
    struct FaceEdge
    {
      std::array<unsigned int, 2> nodes; ///< local numbers, in the order of the global ones
      const BoundaryFace *face;
      unsigned int k;
    };

    static std::vector<FaceEdge>
    edges_of(const Discretization &discretization, const std::vector<BoundaryFace> &faces);
    std::vector<OwnEdge>
    sharp_edges(const std::vector<FaceEdge> &edges,
                const std::vector<BoundaryFace> &surface,
                const double least_angle) const;
    std::vector<FeatureEdge>
    named(const std::vector<OwnEdge> &own, const ContactNodes &nodes) const;
    bool
    cross(const ContactNodes::Field &x,
          const FeatureEdge &slave,
          const FeatureEdge &master,
          EdgeCrossing &crossing) const;
    bool
    are_opposed(const ContactNodes::Field &x,
                const FeatureEdge &slave,
                const FeatureEdge &master,
                const double reach,
                EdgeCrossing &crossing) const;
    static bool
    are_on(const ContactNodes::Field &x,
           const ContactNodes::Field &next,
           const FeatureEdge &slave,
           const FeatureEdge &master,
           const EdgeCrossing &crossing);
    bool
    meet(const ContactNodes::Field &x,
         const ContactNodes::Field &next,
         const FeatureEdge &slave,
         const FeatureEdge &master,
         const double reach,
         EdgeCrossing &crossing) const;
    ContactPair
    make_pair(const ContactNodes::Field &x,
              const unsigned int slave,
              const unsigned int master,
              const EdgeCrossing &crossing) const;

    const Discretization &discretization;
    const unsigned int interface;
    const bool one_surface, has_friction;
    const double rim_tolerance; ///< of the cell size
    std::vector<OwnEdge> own_slaves, own_masters;
    bool exist = false; ///< on both sides, on any rank

    std::vector<FeatureEdge> slaves, masters;            ///< sorted by ids
    std::vector<std::array<unsigned int, 2>> candidates; ///< numbers in slaves and masters
  };
} // namespace akmon
