#pragma once

#include <akmon/contact/contact_nodes.h>
#include <akmon/contact/pair.h>
#include <akmon/contact/search/feature_surface.h>
#include <akmon/rigid/rigid_body.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace akmon
{
  /**
   * Finds where sharp corners and edges of a rigid body meet the faces of deformable ones: what the
   * pairs of nodes with the body's shape do not see where faces are larger than it, or its edges
   * run between nodes. Three kinds of pairs, all of a point of the body with one of the surface:
   *
   * - a corner with the closest faces;
   * - an edge with an edge between faces, where both cross;
   * - an edge with the inside of a face that bulges towards it (bilinear faces may be twisted): the
   *   pair's gap is the least one around its point of the edge, as where the bulge is highest may
   *   change in a step.
   *
   * The row of the gap operator is G u = u_c + theta x (q - x_c) - sum_k N_k u_k with the closest
   * point q of the surface: the body's motion continued to q. G vanishes for rigid motions and
   * forces of both sides act at q, so that momenta are conserved exactly while gaps are open too.
   *
   * Rank 0 gets the faces near the body and has the pairs.
   */
  class FeatureSearch
  {
  public:
    /**
     * @param faces      relevant faces of the surfaces that the body stops
     * @param interface  number for its pairs
     */
    FeatureSearch(const Discretization &discretization,
                  const RigidBody &body,
                  const std::vector<BoundaryFace> &faces,
                  const unsigned int interface);

    /// Whether there are features and faces; the same on all ranks.
    bool
    exists() const
    {
      return least_radius > 0.;
    }

    /// Distance over which partners are looked for; length. The same on all ranks.
    double
    radius() const
    {
      return search_radius;
    }

    /// What is looked at also if nothing moves; length.
    double
    least_reach() const
    {
      return 0.1 * least_radius;
    }

    /// Let the radius be at least this, from the next build of candidates on; length.
    void
    look_as_far_as(const double distance)
    {
      search_radius = std::max(least_radius, distance);
    }

    /// Bring the faces near the body to rank 0 (collective). Returns the nodes this rank needs.
    std::vector<ContactNodes::Id>
    fetch_faces(const ContactNodes &nodes, const NodalVector &x);

    /// For every feature the faces and edges within the radius.
    void
    build_candidates(const ContactNodes &nodes, const ContactNodes::Field &x);

    /// Where a search looks, and how far: configuration, last increments, length.
    struct View
    {
      const ContactNodes::Field &x, &dx;
      unsigned int first_rigid; ///< contact number of the body's centre, if it moves
      double reach;             ///< what may be closed in this step; length
    };

    /**
     * Append the pairs in the present configuration, sorted by their keys.
     * @param previous  pairs of the last step: edges found past each other are none
     */
    void
    find_pairs(const View &view,
               const std::vector<ContactPair> &previous,
               std::vector<ContactPair> &pairs);

    /// The gap of a pair in another configuration; false if it has no partner there.
    bool
    gap_at(const ContactNodes::Field &x, const Pose &pose, ContactPair &pair, double &gap) const;

    /**
     * Append pairs of edges with the inside of faces for what is deeper, where a step leads, than
     * any of the pairs there are tells, or move some there: with them gaps settle along all of the
     * edge (the exchange method of semi-infinite programming, Hettich and Kortanek, SIAM Review 35,
     * 1993).
     * @param view       of the last search
     * @param reached    where the step leads: configuration and increments
     * @param pose       of the body there
     * @param tolerance  of what is deeper, over the cell size
     * @param may_move   whether the only pair of an edge and a face moves instead of getting
     * company
     * @param pairs      of the last search, and those that have joined them, sorted by their keys
     * @return           whether any has joined or moved
     */
    bool
    join_bulges(const View &view,
                const View &reached,
                const Pose &pose,
                const double tolerance,
                const bool may_move,
                std::vector<ContactPair> &pairs,
                std::vector<ContactPair> &joining);

    unsigned int
    get_interface() const
    {
      return interface;
    }

  private:
    enum class Kind : unsigned int
    {
      corner,
      crossing, ///< of two edges
      bulge     ///< edge and the inside of a face
    };

    // What a pair was found with.
    struct Record
    {
      Kind kind;
      unsigned int feature;   ///< number of the corner or of the edge
      unsigned int partner;   ///< number of the face or of the edge between faces
      unsigned int part = 0;  ///< of a bulge: which third of the edge over it; beyond, joined later
      double s          = 0.; ///< part of the edge where the pair is, not of a corner

      /// Whether both are of one edge with the inside of one face.
      bool
      is_beside(const Record &other) const
      {
        return kind == Kind::bulge && other.kind == Kind::bulge && feature == other.feature &&
               partner == other.partner;
      }
    };

    // An edge of the body in space.
    struct Line
    {
      dealii::Tensor<1, 3> a, u;                   ///< begin, and from there to the end; length
      std::array<dealii::Tensor<1, 3>, 2> normals; ///< of the body's faces

      bool
      may_touch(const dealii::Tensor<1, 3> &normal) const;

      /// Of a point from the edge; length.
      double
      distance(const dealii::Tensor<1, 3> &x) const
      {
        const double s = std::clamp((x - a) * u / u.norm_square(), 0., 1.);
        return (x - a - s * u).norm();
      }
    };

    // Where an edge of the body is closest to an edge between faces.
    struct Crossing
    {
      double s, t; ///< parts of both
      dealii::Tensor<1, 3> normal;
      double gap, sine;
    };

    // Where a feature touches the surface: nodes with their weights N_k, and the normal there.
    struct Touch
    {
      std::vector<std::pair<unsigned int, double>> masters;
      dealii::Tensor<1, 3> normal;
      double gap; ///< length
    };

    // A corner's closest point of a face.
    struct Foot
    {
      unsigned int face;
      Projection projection;
      dealii::Tensor<1, 3> normal; ///< of the face there
      double gap;                  ///< along it; length
    };

    Line
    line_of(const Pose &pose, const unsigned int edge) const;
    std::vector<Line>
    lines_now() const;
    std::array<dealii::Tensor<1, 3>, 2>
    box_of_features(const double margin) const;
    void
    find_corner_pairs(const View &view, std::vector<ContactPair> &pairs);
    std::vector<Foot>
    feet_of_corner(const View &view,
                   const std::size_t begin,
                   const std::size_t end,
                   const dealii::Tensor<1, 3> &p,
                   const dealii::Tensor<1, 3> &outward) const;
    void
    add_corner(const View &view,
               const unsigned int vertex,
               const dealii::Tensor<1, 3> &p,
               const std::vector<Foot> &feet,
               std::vector<ContactPair> &pairs);
    bool
    rises_beside(const ContactNodes::Field &x,
                 const dealii::Tensor<1, 3> &p,
                 const Foot &foot) const;
    double
    corner_gap(const ContactNodes::Field &x,
               const dealii::Tensor<1, 3> &p,
               ContactPair &pair) const;
    void
    find_crossings(const View &view,
                   const std::vector<ContactPair> &previous,
                   std::vector<ContactPair> &pairs);
    bool
    cross(const ContactNodes::Field &x,
          const Line &line,
          const unsigned int edge,
          Crossing &crossing) const;
    double
    gap_of(const ContactNodes::Field &x,
           const Line &line,
           const unsigned int edge,
           const Crossing &crossing) const;
    bool
    choose_normal(const ContactNodes::Field &x,
                  const unsigned int edge,
                  const dealii::Tensor<1, 3> &v,
                  const double sine,
                  dealii::Tensor<1, 3> &normal) const;
    bool
    is_on(const View &view,
          const Line &line,
          const unsigned int edge,
          const Crossing &crossing) const;
    void
    find_bulges(const View &view,
                const std::vector<ContactPair> &previous,
                std::vector<ContactPair> &pairs);
    static bool
    is_behind(const ContactPair &pair, const std::vector<ContactPair> &previous);
    bool
    stretch_over(const ContactNodes::Field &x,
                 const Line &line,
                 const unsigned int face,
                 std::array<double, 2> &s) const;
    double
    least_gap_over(const ContactNodes::Field &x,
                   const Line &line,
                   const unsigned int face,
                   const std::array<double, 2> &stretch) const;
    double
    closest_over(const ContactNodes::Field &x,
                 const Line &line,
                 const unsigned int face,
                 const std::array<double, 2> &stretch,
                 const double from,
                 const double to) const;
    double
    least_gap_around(const ContactNodes::Field &x,
                     const Line &line,
                     const Record &pair,
                     const std::array<double, 2> &stretch) const;
    static bool
    was_loaded(const ContactPair &pair, const std::vector<ContactPair> &previous);
    bool
    is_inside(const ContactNodes::Field &x,
              const Line &line,
              const Record &place,
              const std::array<double, 2> &stretch) const;
    bool
    sees(const Record &place, const double distance) const;
    double
    gap_at_ends(const ContactNodes::Field &x,
                const Line &line,
                const Record &place,
                const std::array<double, 2> &stretch) const;
    bool
    add_bulge(const View &view,
              const View &reached,
              Record place,
              const double gap,
              const double unseen,
              const bool may_move,
              std::vector<ContactPair> &pairs,
              std::vector<ContactPair> &joining);
    double
    gap_over(const ContactNodes::Field &x,
             const dealii::Tensor<1, 3> &p,
             const unsigned int face) const;
    ContactPair
    make_pair(const View &view, const Record &record, const Touch &touch);
    Touch
    touch_over(const ContactNodes::Field &x,
               const dealii::Tensor<1, 3> &p,
               const unsigned int face) const;
    bool
    is_near(const ContactNodes::Field &x,
            const Line &line,
            const unsigned int face,
            const double reach) const;

    const Discretization &discretization;
    const RigidBody &body;
    const std::vector<BoundaryFace> &surface_faces;
    const unsigned int interface;
    const SharpFeatures features;
    double least_radius = 0., search_radius = 0.;

    FeatureSurface surface;
    std::vector<FeatureSurface::Face> fetched;
    // Numbers of a feature and of its partner, sorted.
    using Candidates = std::vector<std::array<unsigned int, 2>>;
    Candidates faces_of_corners, faces_of_edges, edges_of_edges;
    Candidates near_edges;       ///< of faces_of_edges, those that may touch in the step
    std::vector<Record> records; ///< of the pairs of the last search
  };
} // namespace akmon
