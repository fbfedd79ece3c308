#include <akmon/contact/search/face_geometry.h>
#include <akmon/contact/search/normal_cone.h>
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


  // The faces that share the closest edge or vertex. It is on the rim where an edge has one face
  // only.
  SurfaceSearch::Feature
  SurfaceSearch::feature_of(const ContactNodes::Field &x, const Partner &partner) const
  {
    const auto &face       = masters[partner.face].nodes;
    const auto &projection = partner.projection;
    const unsigned int a   = face[projection.where];
    const unsigned int b   = face[(projection.where + 1) % 4];
    Feature feature;
    for (const unsigned int corner : corners_at[a])
      {
        const auto &neighbour   = masters[corner / 4].nodes;
        const unsigned int next = neighbour[(corner + 1) % 4], last = neighbour[(corner + 3) % 4];
        if (projection.feature == Projection::Feature::edge)
          {
            if (next != b && last != b)
              continue;
            feature.on_rim = faces_sharing(a, b) == 1;
          }
        else
          feature.on_rim = feature.on_rim || faces_sharing(a, next) == 1 ||
                           faces_sharing(a, last) == 1;
        feature.faces.push_back(corner / 4);
        feature.normals.push_back(unit_normal(segment(x, neighbour)));
        feature.mean += feature.normals.back();
      }
    feature.mean /= feature.mean.norm();
    return feature;
  }


  // Whether the surface turns sharply at a feature, and outward everywhere.
  bool
  SurfaceSearch::is_ridge(const ContactNodes::Field &x,
                          const Partner &partner,
                          const Feature &feature) const
  {
    constexpr double nearly_flat = 0.1; // sine

    if (!feature.normals.turn_sharply(feature.mean))
      return false;
    const auto foot = x[masters[partner.face].nodes[partner.projection.where]];
    return std::none_of(feature.faces.begin(), feature.faces.end(), [&](const unsigned int face) {
      const auto way      = middle_of(segment(x, masters[face])) - foot;
      const double height = nearly_flat * way.norm();
      return std::any_of(feature.normals.begin(), feature.normals.end(), [&](const auto &normal) {
        return normal * way > height;
      });
    });
  }


  // On a ridge the normal of what touches it counts, as far as the surface takes it there: the one
  // against the slave's own. The other side of a sharp edge says nothing where bodies lie flat on
  // each other.
  Tensor<1, 3>
  SurfaceSearch::ridge_normal(const unsigned int slave, const Feature &feature) const
  {
    const auto against = -outwards[slave] / outwards[slave].norm();
    const auto closest = feature.normals.sides().closest_to(against);
    const double norm  = closest.norm();
    return norm > 0. ? closest / norm : feature.mean;
  }


  // Whether a feature has a face that does not look at a slave.
  bool
  SurfaceSearch::turns_away(const unsigned int slave, const Feature &feature) const
  {
    return std::any_of(feature.normals.begin(), feature.normals.end(), [&](const auto &normal) {
      return !looks_at(slave, normal);
    });
  }


  // Whether a slave behind the plane through a ridge is in front of one of its faces.
  bool
  SurfaceSearch::is_beside(const Partner &partner, const Feature &feature)
  {
    return partner.gap < 0. &&
           std::any_of(feature.normals.begin(), feature.normals.end(), [&](const auto &normal) {
             return normal * partner.projection.offset > 0.;
           });
  }


  // What is further inside a face has not come through it: it belongs to another side of the body.
  // A node of the same body is in the material behind its faces, however thin that is.
  double
  SurfaceSearch::deepest_inside(const unsigned int slave, const unsigned int face) const
  {
    constexpr double of_same_body = 0.02;

    const bool is_same = fetched[face].body == discretization.body_of_node[slaves[slave].node];
    return (is_same ? of_same_body : deepest_part) * masters[face].depth;
  }


  // Normal and gap of a partner whose closest point is known; false where it is none: too far
  // outside or inside, or beyond the rim. A slave next to a ridge that has a face which does not
  // look at it is at the rim of what does: beyond it, or behind, it is beside the body.
  bool
  SurfaceSearch::complete(const ContactNodes::Field &x,
                          const unsigned int slave,
                          Partner &partner) const
  {
    constexpr double at_border = 1. - 1e-12; // in xi, eta
    // Of the tolerance at rims: beyond them the planes of faces side by side differ.
    constexpr double of_ridges = 0.1;
    // Sine over cosine of the angle between the ways to the closest point of a concave corner of
    // three walls and along their mean normal.
    constexpr double deepest_aside = 1.5;

    const bool to_points = contact.gap_model == SurfaceContact::GapModel::point_to_point;
    if (to_points)
      snap_to_closest_node(x, x[slaves[slave].number], partner);
    const auto &projection = partner.projection;
    const auto within      = [&]() {
      return partner.gap <= search_radius &&
             (partner.gap >= 0. || partner.gap >= -deepest_inside(slave, partner.face));
    };
    if (projection.feature == Projection::Feature::face)
      {
        partner.normal = face_normal(x, partner);
        partner.gap    = partner.normal * projection.offset;
        return within();
      }

    const Feature feature       = feature_of(x, partner);
    const bool on_ridge         = !feature.on_rim && !to_points && is_ridge(x, partner, feature);
    partner.normal              = on_ridge ? ridge_normal(slave, feature) : feature.mean;
    partner.gap                 = partner.normal * projection.offset;
    const bool is_inside_border = std::max(std::abs(projection.xi), std::abs(projection.eta)) <
                                  at_border;
    const bool beside = on_ridge && is_beside(partner, feature);
    if (beside && is_inside_border && face_normal(x, partner) * projection.offset > 0.)
      {
        partner.normal = face_normal(x, partner);
        partner.gap    = partner.normal * projection.offset;
        return within();
      }
    if (!within())
      return false;
    const double aside     = (projection.offset - partner.gap * partner.normal).norm();
    const double face_size = std::sqrt(area_vector(segment(x, masters[partner.face])).norm());
    const double tolerance = (to_points ? 0.5 : contact.rim_tolerance) * face_size;
    if (feature.on_rim)
      return aside <= tolerance;
    if (to_points || is_inside_border)
      return true;
    if (on_ridge && (beside || turns_away(slave, feature)))
      return std::max(aside, -partner.gap) <= of_ridges * tolerance;
    return partner.gap >= 0. || aside <= tolerance - deepest_aside * partner.gap;
  }
} // namespace akmon
