#include <akmon/contact/surface_search.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace akmon
{
  using namespace dealii;

  Segment
  SurfaceSearch::segment(const ContactNodes::Field &x, const MasterFace &face) const
  {
    return {{x[face.nodes[0]], x[face.nodes[1]], x[face.nodes[2]], x[face.nodes[3]]}};
  }


  // Sum of the area vectors of the slave faces around a node.
  Tensor<1, 3>
  SurfaceSearch::slave_normal(const NodalVector &positions, const unsigned int slave) const
  {
    Tensor<1, 3> normal;
    for (unsigned int i = slaves[slave].first_face; i < slaves[slave + 1].first_face; ++i)
      {
        const auto &face = slave_faces[slave_face_list[i]];
        normal += area_vector({{at_node(positions, face.nodes[0]),
                                at_node(positions, face.nodes[1]),
                                at_node(positions, face.nodes[2]),
                                at_node(positions, face.nodes[3])}});
      }
    return normal;
  }


  unsigned int
  SurfaceSearch::faces_sharing(const unsigned int node_a, const unsigned int node_b) const
  {
    unsigned int count = 0;
    for (unsigned int i = faces_at_begin[node_a]; i < faces_at_begin[node_a + 1]; ++i)
      for (const unsigned int node : masters[faces_at[i]].nodes)
        count += node == node_b;
    return count;
  }


  // The closest candidate face that looks towards the slave's surface and is not part of it.
  bool
  SurfaceSearch::closest_segment(const ContactNodes::Field &x,
                                 const unsigned int slave,
                                 const Tensor<1, 3> &outward,
                                 Partner &partner) const
  {
    constexpr double opposed = 0.02; // cosine: sides of an edge do not look at each other

    const auto point = x[slaves[slave].number];
    double best      = std::numeric_limits<double>::max();
    for (unsigned int i = slaves[slave].first_candidate; i < slaves[slave + 1].first_candidate; ++i)
      {
        const auto &face      = masters[candidates[i]];
        const Segment corners = segment(x, face);
        const auto normal     = area_vector(corners);
        if (normal * outward > -opposed * normal.norm() * outward.norm())
          continue;
        // No point of the face is closer than its middle less the way to its furthest corner.
        const auto middle  = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
        const double least = (point - middle).norm() -
                             std::sqrt(std::max({(corners[0] - middle).norm_square(),
                                                 (corners[1] - middle).norm_square(),
                                                 (corners[2] - middle).norm_square(),
                                                 (corners[3] - middle).norm_square()}));
        if (least > 0. && least * least > best)
          continue;
        const Projection projection = project(point, corners);
        const double distance       = projection.offset.norm_square();
        if (distance < best)
          {
            best               = distance;
            partner.face       = candidates[i];
            partner.projection = projection;
          }
      }
    return best < std::numeric_limits<double>::max();
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


  // Normal of the closest feature: of the face itself, or the mean of the faces that share the edge
  // or vertex. A feature is on the rim where an edge has one face only.
  Tensor<1, 3>
  SurfaceSearch::feature_normal(const ContactNodes::Field &x,
                                const Partner &partner,
                                bool &on_rim) const
  {
    const auto &face       = masters[partner.face];
    const auto &projection = partner.projection;
    const unsigned int a   = face.nodes[projection.where];
    const unsigned int b   = face.nodes[(projection.where + 1) % 4];
    on_rim                 = false;
    if (projection.feature == Projection::Feature::face)
      return segment_normal(segment(x, face), projection.xi, projection.eta);

    Tensor<1, 3> sum;
    for (unsigned int i = faces_at_begin[a]; i < faces_at_begin[a + 1]; ++i)
      {
        const auto &neighbour = masters[faces_at[i]];
        const auto corner     = std::find(neighbour.nodes.begin(), neighbour.nodes.end(), a) -
                            neighbour.nodes.begin();
        const unsigned int next = neighbour.nodes[(corner + 1) % 4],
                           last = neighbour.nodes[(corner + 3) % 4];
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


  // The partner of a slave at positions x; false if it has none within the radius.
  bool
  SurfaceSearch::locate(const ContactNodes::Field &x,
                        const unsigned int slave,
                        const Tensor<1, 3> &outward,
                        Partner &partner) const
  {
    // A node further inside than this part of the cell behind the face belongs to another face's
    // side.
    constexpr double deepest_part = 0.5;

    const bool to_points = contact.gap_model == SurfaceContact::GapModel::point_to_point;
    if (!closest_segment(x, slave, outward, partner))
      return false;
    if (to_points)
      snap_to_closest_node(x, x[slaves[slave].number], partner);

    bool on_rim;
    const auto &face       = masters[partner.face];
    partner.normal         = feature_normal(x, partner, on_rim);
    partner.gap            = partner.normal * partner.projection.offset;
    const double overhang  = (partner.projection.offset - partner.gap * partner.normal).norm();
    const double face_size = std::sqrt(area_vector(segment(x, face)).norm());
    const double allowed   = (to_points ? 0.5 : contact.rim_tolerance) * face_size;
    return partner.gap <= search_radius && partner.gap >= -deepest_part * face.depth &&
           !(on_rim && overhang > allowed);
  }


  // What the linear gap n . G dx + g misses while segments turn under the slave: the true gap where
  // the last increment would lead once more, less its linear prediction.
  double
  SurfaceSearch::curvature(const ContactNodes::Field &x_ahead,
                           const ContactNodes::Field &dx,
                           const unsigned int slave,
                           const Tensor<1, 3> &outward,
                           const ContactPair &pair) const
  {
    const auto motion = pair.relative(dx);
    const double size = motion.norm();
    Partner ahead;
    if (pair.gap > 4. * size || !locate(x_ahead, slave, outward, ahead))
      return 0.;
    // A partner of another kind (another side of an edge) is no small turn.
    return std::clamp(ahead.gap - (pair.gap + pair.normal * motion), -0.1 * size, 0.1 * size);
  }


  void
  SurfaceSearch::find_pairs(const NodalVector &positions,
                            const ContactNodes::Field &x,
                            const ContactNodes::Field &x_ahead,
                            const ContactNodes::Field &dx,
                            std::vector<ContactPair> &pairs) const
  {
    for (unsigned int s = 0; s + 1 < slaves.size(); ++s)
      {
        if (slaves[s].first_candidate == slaves[s + 1].first_candidate)
          continue;
        const auto outward = slave_normal(positions, s);
        Partner partner;
        if (!locate(x, s, outward, partner))
          continue;

        ContactPair pair;
        pair.interface  = interface;
        pair.reversed   = reversed;
        pair.slave      = slaves[s].node;
        pair.slave_id   = slaves[s].id;
        pair.normal     = partner.normal;
        pair.gap        = partner.gap;
        pair.size       = slaves[s].size;
        pair.nodes[0]   = slaves[s].number;
        pair.weights[0] = 1.;
        for (unsigned int k = 0; k < 4; ++k)
          if (partner.projection.N[k] != 0.)
            {
              pair.nodes[pair.n_nodes]     = masters[partner.face].nodes[k];
              pair.weights[pair.n_nodes++] = -partner.projection.N[k];
            }
        if (follow_curvature)
          pair.curvature = curvature(x_ahead, dx, s, outward, pair);
        pairs.push_back(pair);
      }
  }
} // namespace akmon
