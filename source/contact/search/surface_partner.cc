#include <akmon/contact/search/face_geometry.h>
#include <akmon/contact/search/surface_search.h>

#include <algorithm>
#include <cmath>

// Normal and gap of a slave's partner whose closest point is known.

namespace akmon
{
  using namespace dealii;

  unsigned int
  SurfaceSearch::faces_sharing(const unsigned int node_a, const unsigned int node_b) const
  {
    unsigned int count = 0;
    for (const unsigned int corner : corners_at[node_a])
      for (const unsigned int node : masters[corner / 4].nodes)
        count += node == node_b;
    return count;
  }


  // Point to point: the partner becomes the closest corner of the closest face.
  void
  SurfaceSearch::snap_to_closest_node(const ContactNodes::Field &x,
                                      const Tensor<1, 3> &slave,
                                      Partner &partner) const
  {
    const Segment corners = segment(x, masters[partner.face]);
    unsigned int closest  = 0;
    for (unsigned int k = 1; k < 4; ++k)
      if ((slave - corners[k]).norm_square() < (slave - corners[closest]).norm_square())
        closest = k;
    auto &projection      = partner.projection;
    projection.N          = {{0., 0., 0., 0.}};
    projection.N[closest] = 1.;
    projection.offset     = slave - corners[closest];
    projection.feature    = Projection::Feature::vertex;
    projection.where      = closest;
  }


  // Normal of the partner's face at the closest point.
  Tensor<1, 3>
  SurfaceSearch::face_normal(const ContactNodes::Field &x, const Partner &partner) const
  {
    return segment_normal(segment(x, masters[partner.face]),
                          partner.projection.xi,
                          partner.projection.eta);
  }


  // Normal of the closest feature: of the face itself, or the mean of the faces that share the edge
  // or vertex. A feature is on the rim where an edge has one face only.
  Tensor<1, 3>
  SurfaceSearch::feature_normal(const ContactNodes::Field &x,
                                const Partner &partner,
                                bool &on_rim) const
  {
    const auto &face       = masters[partner.face].nodes;
    const auto &projection = partner.projection;
    const unsigned int a   = face[projection.where];
    const unsigned int b   = face[(projection.where + 1) % 4];
    on_rim                 = false;
    if (projection.feature == Projection::Feature::face)
      return face_normal(x, partner);

    Tensor<1, 3> sum;
    for (const unsigned int corner : corners_at[a])
      {
        const auto &neighbour   = masters[corner / 4].nodes;
        const unsigned int next = neighbour[(corner + 1) % 4], last = neighbour[(corner + 3) % 4];
        if (projection.feature == Projection::Feature::edge)
          {
            if (next != b && last != b)
              continue;
            on_rim = faces_sharing(a, b) == 1;
          }
        else
          on_rim = on_rim || faces_sharing(a, next) == 1 || faces_sharing(a, last) == 1;
        const auto normal = area_vector(segment(x, neighbour));
        sum += normal / normal.norm();
      }
    return sum / sum.norm();
  }


  // Whether a slave that is behind the mean normal of an edge or vertex is outside nevertheless: in
  // front of one of the faces that share it, where none of them rises from another. That face does
  // not look at the slave, and this one is on another side of the body.
  bool
  SurfaceSearch::is_beside(const ContactNodes::Field &x, const Partner &partner) const
  {
    constexpr double nearly_flat = 0.1, clearly = 0.2; // sines
    constexpr double at_border = 1. - 1e-12;           // in xi, eta

    const auto &projection = partner.projection;
    if (partner.gap >= 0. || projection.feature == Projection::Feature::face ||
        std::max(std::abs(projection.xi), std::abs(projection.eta)) < at_border)
      return false;
    const auto &face      = masters[partner.face].nodes;
    const unsigned int a  = face[projection.where];
    const unsigned int b  = face[(projection.where + 1) % 4];
    const double at_least = clearly * projection.offset.norm();
    std::vector<Segment> around;
    for (const unsigned int corner : corners_at[a])
      {
        const auto &nodes = masters[corner / 4].nodes;
        if (projection.feature == Projection::Feature::vertex ||
            std::find(nodes.begin(), nodes.end(), b) != nodes.end())
          around.push_back(segment(x, masters[corner / 4]));
      }
    bool in_front = false;
    for (const auto &one : around)
      {
        const auto normal = unit_normal(one);
        in_front          = in_front || normal * projection.offset > at_least;
        for (const auto &other : around)
          {
            const auto way = middle_of(other) - x[a];
            if (normal * way > nearly_flat * way.norm())
              return false;
          }
      }
    return in_front;
  }


  // Normal and gap of a partner whose closest point is known; false where it is none: too far
  // outside or inside, or beyond the rim.
  bool
  SurfaceSearch::complete(const ContactNodes::Field &x,
                          const unsigned int slave,
                          Partner &partner) const
  {
    const bool to_points = contact.gap_model == SurfaceContact::GapModel::point_to_point;
    if (to_points)
      snap_to_closest_node(x, x[slaves[slave].number], partner);
    bool on_rim;
    partner.normal = feature_normal(x, partner, on_rim);
    partner.gap    = partner.normal * partner.projection.offset;
    if (partner.gap > search_radius || partner.gap < -deepest_part * masters[partner.face].depth ||
        is_beside(x, partner))
      return false;
    if (!on_rim)
      return true;
    const double overhang  = (partner.projection.offset - partner.gap * partner.normal).norm();
    const double face_size = std::sqrt(area_vector(segment(x, masters[partner.face])).norm());
    return overhang <= (to_points ? 0.5 : contact.rim_tolerance) * face_size;
  }
} // namespace akmon
