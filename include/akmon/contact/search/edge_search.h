#pragma once

#include <akmon/contact/contact_nodes.h>
#include <akmon/contact/contact_parameters.h>
#include <akmon/contact/pair.h>
#include <akmon/contact/search/surface_search.h>

#include <array>
#include <set>
#include <vector>

namespace akmon
{
  /// An edge of a body at which its surface turns sharply outward, or any of a narrow face, with
  /// the faces that meet there.
  struct FeatureEdge
  {
    std::array<ContactNodes::Id, 2> ids;                  ///< of its ends, the lower one first
    std::array<std::array<ContactNodes::Id, 4>, 2> faces; ///< ids of the corners, counter-clockwise
    unsigned int n_faces; ///< on the contact surface: one at its rim
    unsigned int body;
    double angle;                        ///< by which the surface turns, initially; radians
    double size;                         ///< least edge of both faces, initially; length
    double depth;                        ///< thickness of the thinner cell behind the faces; length
    double stiffness;                    ///< K A^2/V of the softer cell; force/length
    unsigned char sharp;                 ///< whether the surface turns sharply
    std::array<unsigned char, 2> narrow; ///< whether all corners of a face are at sharp edges
    std::array<unsigned char, 2> end;    ///< whether the edge does not go on there

    // On this rank, once the nodes are numbered.
    unsigned int first;                                 ///< local number of the first end, if owned
    std::array<unsigned int, 2> nodes;                  ///< contact numbers of the ends
    std::array<std::array<unsigned int, 4>, 2> corners; ///< and of the corners

    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int)
    {
      archive &ids &faces &n_faces &body &angle &size &depth &stiffness &sharp &narrow &end;
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
   * Narrow faces, those of bodies one cell wide, have no corner inside the surface that would see
   * the other one. They dip over edges between these crossings if they are twisted, and so do the
   * smooth edges between them where they cross others. There pairs join during a step, where it
   * leads to a dip that no pair tells (the exchange method of semi-infinite programming, Hettich
   * and Kortanek, SIAM Review 35, 1993), and stay while they carry forces.
   *
   * A pair belongs to the owner of the slave edge's first node, or of the slave face's.
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
               std::vector<ContactPair> &pairs);

    /// Whether faces may dip over edges between the pairs; the same on all ranks.
    bool
    may_miss_dips() const
    {
      return has_narrow_faces;
    }

    /**
     * Append pairs for what is deeper, where a step leads, than any of the pairs there are tells.
     * @param x           of the last search
     * @param reached     where the step leads
     * @param increments  to there
     * @param pairs       of the last search, and those that have joined them, sorted by their keys
     */
    void
    join_dips(const ContactNodes::Field &x,
              const ContactNodes::Field &reached,
              const ContactNodes::Field &increments,
              const std::vector<ContactPair> &pairs,
              std::vector<ContactPair> &joining) const;

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

    // A face of an edge.
    struct EdgeFace
    {
      std::array<ContactNodes::Id, 4> ids; ///< counter-clockwise
      unsigned int lowest;                 ///< which corner has the lowest id
      unsigned int local;                  ///< its local number, if owned
      std::array<unsigned int, 4> nodes;   ///< contact numbers

      // Of the corner with the lowest id, and of the one across: no two faces have both.
      std::array<ContactNodes::Id, 2>
      diagonal() const
      {
        return {{ids[lowest], ids[(lowest + 2) % 4]}};
      }

      Segment
      segment(const ContactNodes::Field &x) const
      {
        return {{x[nodes[0]], x[nodes[1]], x[nodes[2]], x[nodes[3]]}};
      }
    };

    // An edge over a face of the other side.
    struct Dip
    {
      bool of_master;          ///< edge of the master and face of the slave, or the other way round
      unsigned int edge, face; ///< numbers there
    };

    static std::vector<FaceEdge>
    edges_of(const Discretization &discretization, const std::vector<BoundaryFace> &faces);
    OwnEdge
    edge_between(const FaceEdge &first,
                 const FaceEdge &second,
                 const std::set<dealii::types::global_cell_index> &surface) const;
    std::vector<OwnEdge>
    sharp_edges(const std::vector<FaceEdge> &edges,
                const std::vector<BoundaryFace> &surface,
                const double least_angle) const;
    static void
    add_edges_of_narrow_faces(const NodalVector &n_at_node,
                              const std::vector<OwnEdge> &others,
                              std::vector<OwnEdge> &edges);
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
    ContactPair
    make_line_pair(const ContactNodes::Field &x,
                   const unsigned int slave,
                   const unsigned int master,
                   const EdgeCrossing &crossing) const;
    double
    margin_of_faces(const NodalVector &x) const;
    static std::vector<EdgeFace>
    faces_of(const ContactNodes &nodes, const std::vector<FeatureEdge> &edges);
    void
    build_dip_candidates(const ContactNodes &nodes,
                         const ContactNodes::Field &x,
                         const double radius);
    void
    find_dips(const ContactNodes::Field &x,
              const double reach,
              const std::vector<ContactPair> &previous,
              std::vector<ContactPair> &pairs);
    bool
    may_dip(const ContactNodes::Field &x, const Dip &dip) const;
    bool
    dips(const ContactNodes::Field &x, const Dip &dip, double &s, double &gap) const;
    bool
    deepest_place(const ContactNodes::Field &x, const Dip &dip, double &s) const;
    ContactPair
    make_dip(const ContactNodes::Field &x, const Dip &dip, const double s) const;
    bool
    dip_gap_at(const ContactNodes::Field &x, const ContactPair &pair, double &gap) const;
    void
    join_lines(const ContactNodes::Field &x,
               const ContactNodes::Field &reached,
               const ContactNodes::Field &increments,
               const std::vector<ContactPair> &pairs,
               std::vector<ContactPair> &joining) const;

    const FeatureEdge &
    edge_of(const Dip &dip) const
    {
      return (dip.of_master ? masters : slaves)[dip.edge];
    }

    const EdgeFace &
    face_of(const Dip &dip) const
    {
      return (dip.of_master ? faces_of_slaves : faces_of_masters)[dip.face];
    }

    const Discretization &discretization;
    const unsigned int interface;
    const bool one_surface, has_friction;
    const double rim_tolerance; ///< of the cell size
    std::vector<OwnEdge> own_slaves, own_masters;
    bool exist            = false; ///< on both sides, on any rank
    bool has_narrow_faces = false; ///< on any side and rank

    std::vector<FeatureEdge> slaves, masters; ///< sorted by ids
    std::vector<EdgeFace> faces_of_slaves, faces_of_masters;
    std::vector<std::array<unsigned int, 2>> candidates;      ///< numbers in slaves and masters
    std::vector<std::array<unsigned int, 2>> line_candidates; ///< the same, not both sharp
    std::vector<std::array<unsigned int, 2>> near_lines;      ///< of these, in this step
    std::vector<Dip> dip_candidates, near_dips;               ///< the latter in this step
  };
} // namespace akmon
