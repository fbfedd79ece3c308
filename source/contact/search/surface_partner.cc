#include <akmon/contact/search/face_geometry.h>
#include <akmon/contact/search/surface_search.h>

#include <algorithm>
#include <cmath>

// Normal and gap of a slave's partner whose closest point is known.

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // The point of the cone of some unit vectors, sum a_i n_i with a_i >= 0, that is closest to a
    // vector v: coordinate by coordinate.
    template <typename Vectors>
    Tensor<1, 3>
    closest_in_cone(const Tensor<1, 3> &v, const Vectors &n)
    {
      constexpr unsigned int most_sweeps = 50;
      constexpr double rounding          = 1e-14;

      boost::container::small_vector<double, 8> a(n.size(), 0.);
      Tensor<1, 3> sum;
      double change = 1.;
      for (unsigned int sweep = 0; sweep < most_sweeps && change > rounding; ++sweep)
        {
          change = 0.;
          for (std::size_t i = 0; i < n.size(); ++i)
            {
              const double next = std::max(0., a[i] + n[i] * (v - sum));
              sum += (next - a[i]) * n[i];
              change = std::max(change, std::abs(next - a[i]));
              a[i]   = next;
            }
        }
      return sum;
    }
  } // namespace


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
    constexpr double smooth = 0.85, nearly_flat = 0.1; // cosine, sine

    if (std::all_of(feature.normals.begin(), feature.normals.end(), [&](const auto &normal) {
          return normal * feature.mean > smooth;
        }))
      return false;
    const auto foot = x[masters[partner.face].nodes[partner.projection.where]];
    for (const auto &normal : feature.normals)
      for (const unsigned int face : feature.faces)
        {
          const auto way = middle_of(segment(x, masters[face])) - foot;
          if (normal * way > nearly_flat * way.norm())
            return false;
        }
    return true;
  }


  // On a ridge the normal of what touches it counts, as far as the surface takes it there: the one
  // against the slave's own. The other side of a sharp edge says nothing where bodies lie flat on
  // each other.
  Tensor<1, 3>
  SurfaceSearch::ridge_normal(const unsigned int slave, const Feature &feature) const
  {
    const auto against = -outwards[slave] / outwards[slave].norm();
    const auto closest = closest_in_cone(against, feature.normals);
    const double norm  = closest.norm();
    return norm > 0. ? closest / norm : feature.mean;
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
    // Sine over cosine of the angle between the ways to the closest point of a concave corner of
    // three walls and along their mean normal.
    constexpr double deepest_aside = 1.5;

    const bool to_points = contact.gap_model == SurfaceContact::GapModel::point_to_point;
    if (to_points)
      snap_to_closest_node(x, x[slaves[slave].number], partner);
    const auto &projection = partner.projection;
    const auto within      = [&]() {
      return partner.gap <= search_radius &&
             partner.gap >= -deepest_part * masters[partner.face].depth;
    };
    if (projection.feature == Projection::Feature::face)
      {
        partner.normal = face_normal(x, partner);
        partner.gap    = partner.normal * projection.offset;
        return within();
      }

    const Feature feature = feature_of(x, partner);
    const bool on_ridge   = !feature.on_rim && !to_points && is_ridge(x, partner, feature);
    partner.normal        = on_ridge ? ridge_normal(slave, feature) : feature.mean;
    partner.gap           = partner.normal * projection.offset;
    if (!within())
      return false;
    const double aside     = (projection.offset - partner.gap * partner.normal).norm();
    const double face_size = std::sqrt(area_vector(segment(x, masters[partner.face])).norm());
    const double tolerance = (to_points ? 0.5 : contact.rim_tolerance) * face_size;
    if (feature.on_rim)
      return aside <= tolerance;
    if (to_points || std::max(std::abs(projection.xi), std::abs(projection.eta)) < at_border)
      return true;
    const bool all_look = std::all_of(feature.faces.begin(),
                                      feature.faces.end(),
                                      [&](const unsigned int face) {
                                        return looks_at(slave,
                                                        area_vector(segment(x, masters[face])));
                                      });
    if (on_ridge && !all_look)
      return aside <= tolerance && partner.gap >= -tolerance;
    return partner.gap >= 0. || aside <= tolerance - deepest_aside * partner.gap;
  }
} // namespace akmon
