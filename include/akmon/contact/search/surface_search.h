#pragma once

#include <akmon/contact/buckets.h>
#include <akmon/contact/contact_nodes.h>
#include <akmon/contact/contact_parameters.h>
#include <akmon/contact/pair.h>
#include <akmon/contact/search/body_motions.h>
#include <akmon/contact/search/box_grid.h>
#include <akmon/contact/search/face_box.h>
#include <akmon/contact/search/master_face.h>
#include <akmon/contact/search/projection.h>
#include <akmon/contact/search/rank_regions.h>
#include <akmon/contact/search/surface_records.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace akmon
{
  /// Whether slaves and masters of a contact are the same faces, in whatever order and by whatever
  /// names: then one search finds the pairs of both sides.
  bool
  is_one_surface(const Discretization &discretization, const SurfaceContact &contact);


  /**
   * Finds the partner of every slave node of one contact. In two stages: candidates (bounding
   * boxes, across ranks, valid while bodies cannot have come closer than the search radius allows)
   * and pairs (closest feature among the candidates, every step).
   *
   * A node's pair belongs to the node's owner, who gets the master faces it may meet, and their
   * neighbours, from the other ranks.
   */
  class SurfaceSearch
  {
  public:
    /**
     * Throws InputError for unknown surfaces.
     * @param number    of this search among all, for its pairs
     * @param reversed  the contact's masters are the slaves of this search and the other way round
     * @param coupled   for the coupled solver: corners have a pair per face
     */
    SurfaceSearch(const Discretization &discretization,
                  const SurfaceContact &contact,
                  const unsigned int interface,
                  const unsigned int number,
                  const bool reversed,
                  const bool coupled);

    unsigned int
    get_interface() const
    {
      return interface;
    }

    /// Distance over which partners are looked for; length. The same on all ranks.
    double
    radius() const
    {
      return search_radius;
    }

    /// Let the radius be at least this, from the next build of candidates on; length.
    void
    look_as_far_as(const double distance)
    {
      search_radius = std::max(least_radius, distance);
    }

    /// Get the master faces near this rank's slaves from their owners (collective). Returns their
    /// nodes.
    std::vector<ContactNodes::Id>
    fetch_master_faces(const ContactNodes &nodes, const NodalVector &x);

    /**
     * For every slave the faces within the radius, from boxes around the faces at positions @p x.
     * @param moved  how far surfaces may have moved against each other since the last build, as far
     *   as what has been found out about distances still holds; length
     */
    void
    build_candidates(const ContactNodes &nodes, const ContactNodes::Field &x, const double moved);

    /// Append the bodies of slaves and of their candidates.
    void
    collect_neighbours(std::vector<std::array<unsigned int, 2>> &bodies) const;

    /// Look at all slaves again when candidates are built next.
    void
    forget_distances();

    /**
     * Append the pairs of this rank's slaves in configuration @p x, in the order of global node
     * numbers: those that are inside, and those that are no further outside than the step may lead,
     * `steps` times what bodies nearby move in it and `least_reach` (length) at least.
     */
    void
    find_pairs(const ContactNodes::Field &x,
               const BodyMotions &motions,
               const double steps,
               const double least_reach,
               std::vector<ContactPair> &pairs);

    /**
     * The gap of a pair's slave in another configuration, which a step has led to from the one the
     * pair was found in; false if it has no partner there. Tells whether that is another face.
     */
    bool
    gap_at(const ContactNodes::Field &x, ContactPair &pair, double &gap) const;

    /// Let a pair be one of the configuration that a step leads to, with its normal and closest
    /// point there; false if it must stay as it is. Parameters as for join_entering().
    bool
    refit(const ContactNodes::Field &x,
          const ContactNodes::Field &reached,
          const ContactNodes::Field &increments,
          ContactPair &pair) const;

    /// Whether there are slaves near bodies that they have no pair with.
    bool
    watches_slaves() const
    {
      return !watched.empty();
    }

    /**
     * Append pairs for slaves that a step leads into a body although they had no pair, or have lost
     * theirs.
     * @param x           of the last search
     * @param reached     where the step leads
     * @param increments  to there
     * @param pairs       of the last search, and those that have joined them, sorted by their keys
     */
    void
    join_entering(const ContactNodes::Field &x,
                  const ContactNodes::Field &reached,
                  const ContactNodes::Field &increments,
                  const std::vector<ContactPair> &pairs,
                  std::vector<ContactPair> &joining) const;

    /// Owned and ghost faces of both surfaces.
    const std::vector<BoundaryFace> &
    surface_faces() const
    {
      return faces;
    }

    /// Relevant faces of either side.
    const std::vector<BoundaryFace> &
    get_slave_faces() const
    {
      return slave_faces;
    }

    const std::vector<BoundaryFace> &
    get_master_faces() const
    {
      return master_faces;
    }

    /// Fetch from memory what gap_at() of the pair that is this many further on will read first.
    static constexpr unsigned int prefetched = 4;

    void
    prefetch(const ContactPair &pair) const
    {
      prefetch_face(pair.face);
    }

  private:
    using Slave      = surface_search::Slave;
    using BodyPair   = surface_search::BodyPair;
    using Candidate  = surface_search::Candidate;
    using PairAround = surface_search::PairAround;
    using Look       = surface_search::Look;
    using Near       = surface_search::Near;
    using ValleyFace = surface_search::ValleyFace;
    using Memory     = surface_search::Memory;
    using FaceArea   = surface_search::FaceArea;
    using Partner    = surface_search::Partner;
    using Feature    = surface_search::Feature;

    static constexpr double
      furthest                      = 1.1; ///< times the reach: with what is beside it, in a corner
    static constexpr double opposed = 0.02; ///< cosine: sides of an edge do not face each other

    void
    prefetch_face(const unsigned int face) const
    {
      if (face < masters.size())
        __builtin_prefetch(&masters[face]);
    }
    void
    prefetch_corners(const ContactNodes::Field &x, const unsigned int face) const
    {
      if (face < masters.size())
        for (const unsigned int node : masters[face].nodes)
          x.prefetch(node);
    }
    void
    collect_slaves();
    RankRegions
    regions_of_slaves(const NodalVector &x) const;
    static Segment
    segment(const ContactNodes::Field &x, const FaceNodes &nodes)
    {
      return {{x[nodes[0]], x[nodes[1]], x[nodes[2]], x[nodes[3]]}};
    }
    static Segment
    segment(const ContactNodes::Field &x, const MasterFace &face)
    {
      return segment(x, face.nodes);
    }
    template <typename Visit>
    void
    visit_neighbours(const unsigned int face, const Visit &visit) const;
    void
    number_slaves(const ContactNodes &nodes);
    void
    settle_distances(const double moved);
    void
    find_last_faces(const std::vector<FaceMessage> &arrived);
    void
    box_masters(const ContactNodes::Field &x);
    void
    add_candidates_of(const ContactNodes::Field &x, const unsigned int slave);
    unsigned int
    number_of_pair(const unsigned int of_slaves,
                   const unsigned int of_faces,
                   std::vector<std::vector<unsigned int>> &known);
    void
    collect_body_pairs();
    void
    advance(const BodyMotions &motions);
    void
    choose_looks(const double steps, const double least_reach);
    bool
    is_still_outside(const Look &look);
    void
    find_pairs_of(const ContactNodes::Field &x,
                  const unsigned int slave,
                  const double reach,
                  std::vector<ContactPair> &pairs);
    dealii::Tensor<1, 3>
    slave_normal(const ContactNodes::Field &x, const unsigned int slave);
    double
    bound_of_distance(const unsigned int candidate) const
    {
      return candidates[candidate].clear_of - body_pairs[candidates[candidate].pair].travelled;
    }
    void
    choose_near_candidates();
    void
    bound_distances(const ContactNodes::Field &x);
    double
    distance_of_last(const ContactNodes::Field &x,
                     const unsigned int slave,
                     Partner &partner) const;
    bool
    closest_face(const ContactNodes::Field &x,
                 const unsigned int slave,
                 const double reach,
                 Partner &partner);
    bool
    may_face(const unsigned int face,
             const unsigned int slave,
             const dealii::Tensor<1, 3> &outward) const;
    bool
    is_in_front_of(const dealii::Tensor<1, 3> &point, const unsigned int face) const;
    bool
    looks_at(const unsigned int slave, const dealii::Tensor<1, 3> &area) const;
    bool
    is_near_others(const unsigned int slave, const double reach, const unsigned int partner) const;
    bool
    faces_slave(const ContactNodes::Field &x,
                const unsigned int slave,
                const Segment &corners,
                const Partner &partner) const;
    bool
    opposes(const ContactNodes::Field &x, const unsigned int face, const unsigned int slave) const;
    bool
    lies_on(const ContactNodes::Field &x,
            const unsigned int slave,
            const Segment &corners,
            const Projection &projection) const;
    static bool
    rises_from(const Segment &corners,
               const dealii::Tensor<1, 3> &foot,
               const dealii::Tensor<1, 3> &normal);
    void
    slide_to_neighbour(const ContactNodes::Field &x,
                       const unsigned int slave,
                       const bool across_ridges_only,
                       Partner &partner) const;
    dealii::Tensor<1, 3>
    face_normal(const ContactNodes::Field &x, const Partner &partner) const;
    Feature
    feature_of(const ContactNodes::Field &x, const Partner &partner) const;
    bool
    is_ridge(const ContactNodes::Field &x, const Partner &partner, const Feature &feature) const;
    double
    deepest_inside(const unsigned int slave, const unsigned int face) const;
    bool
    is_through_body(const unsigned int slave,
                    const unsigned int face,
                    const Segment &corners,
                    const Projection &projection) const;
    bool
    turns_away(const unsigned int slave, const Feature &feature) const;
    static bool
    is_beside(const Partner &partner, const Feature &feature);
    dealii::Tensor<1, 3>
    ridge_normal(const unsigned int slave, const Feature &feature) const;
    bool
    complete(const ContactNodes::Field &x, const unsigned int slave, Partner &partner) const;
    void
    add_pair(const ContactNodes::Field &x,
             const unsigned int slave,
             const Partner &partner,
             std::vector<ContactPair> &pairs) const;
    void
    find_valley(const ContactNodes::Field &x,
                const unsigned int slave,
                const double reach,
                const Partner &partner,
                const dealii::Tensor<1, 3> &normal);
    void
    add_valley_pairs(const ContactNodes::Field &x,
                     const double reach,
                     Partner partner,
                     const std::size_t first,
                     std::vector<ContactPair> &pairs);
    void
    add_corner_pairs(const ContactNodes::Field &x,
                     const double reach,
                     const std::size_t first,
                     std::vector<ContactPair> &pairs);
    bool
    partner_at(const ContactNodes::Field &x, const ContactPair &pair, Partner &partner) const;
    void
    take_back(const ContactNodes::Field &x, const unsigned int slave, Partner &partner) const;
    bool
    entered_face(const ContactNodes::Field &reached,
                 const unsigned int slave,
                 Partner &partner) const;
    void
    trace_back(const ContactNodes::Field &x,
               const ContactNodes::Field &reached,
               const unsigned int slave,
               Partner &partner) const;
    void
    snap_to_closest_node(const ContactNodes::Field &x,
                         const dealii::Tensor<1, 3> &slave,
                         Partner &partner) const;
    unsigned int
    faces_sharing(const unsigned int node_a, const unsigned int node_b) const;

    const Discretization &discretization;
    const SurfaceContact &contact;
    const unsigned int interface, number;
    const bool reversed, coupled, has_friction;
    double least_radius, search_radius;
    double built_radius = 0.; ///< that the candidates have been looked for within
    std::vector<BoundaryFace> slave_faces, master_faces, faces; ///< relevant faces
    std::vector<double> stiffness_of_masters; ///< of those faces, for penalties; force/length

    std::vector<Slave> slaves; ///< and one past the end
    std::vector<unsigned int> slave_face_list;
    std::vector<Candidate> candidates;
    std::vector<FaceNodes> nodes_of_slave_faces;        ///< in the order of slave_face_list
    std::vector<FaceArea> face_areas;                   ///< by slave face
    unsigned long n_configurations = 0, n_searches = 0; ///< looked at; among them for pairs
    std::vector<dealii::Tensor<1, 3>> outwards;         ///< by slave: area vector of its faces
    std::vector<Memory> memories;                       ///< by slave
    std::vector<BodyPair> body_pairs;
    std::vector<PairAround> pairs_around; ///< by slave
    std::vector<Look> looks;              ///< in this search
    std::vector<unsigned int> watched;    ///< slaves near bodies that they have no pair with
    std::vector<Near> near;               ///< in this search, the first n_near ones
    unsigned int n_near = 0;
    std::vector<ValleyFace> valley;                ///< of a slave
    std::vector<FaceMessage> fetched;              ///< sorted by id
    std::vector<MasterFace> masters;               ///< in the same order
    std::vector<FaceBox<double>> boxes_of_masters; ///< when candidates were built last
    BoxGrid grid;                                  ///< of the master faces, widened by the radius
    Buckets corners_at; ///< of the master faces, 4 f + k, by contact number
  };


  // visit(f) for every face that shares a node with a face: at the first of these nodes, and
  // perhaps at others again.
  template <typename Visit>
  void
  SurfaceSearch::visit_neighbours(const unsigned int face, const Visit &visit) const
  {
    for (const unsigned int node : masters[face].nodes)
      for (const unsigned int corner : corners_at[node])
        if (corner / 4 != face)
          visit(corner / 4);
  }
} // namespace akmon
