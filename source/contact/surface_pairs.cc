#include <akmon/contact/surface_search.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace akmon
{
  using namespace dealii;

  // Whether a face beside the one with the normal at the foot rises in front of it.
  bool
  SurfaceSearch::forms_valley(const Segment &corners,
                              const Tensor<1, 3> &foot,
                              const Tensor<1, 3> &normal)
  {
    constexpr double nearly_flat = 0.99875; // cosine of 0.05

    const auto area   = area_vector(corners);
    const auto middle = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
    return area * normal <= nearly_flat * area.norm() && (middle - foot) * normal > 0.;
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


  // The candidates of a slave, unless another slave of this search has needed them.
  void
  SurfaceSearch::measure_candidates(const ContactNodes::Field &x, const unsigned int slave)
  {
    for (unsigned int i = slaves[slave].first_candidate; i < slaves[slave + 1].first_candidate; ++i)
      {
        const unsigned int f = candidates[i];
        auto &shape          = shapes[f];
        if (shape.measured_in == n_searches)
          continue;
        shape.measured_in     = n_searches;
        const Segment corners = segment(x, masters[f]);
        shape.normal          = area_vector(corners);
        shape.area            = shape.normal.norm();
        shape.middle          = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
        shape.radius          = 0.;
        for (const auto &corner : corners)
          shape.radius = std::max(shape.radius, (corner - shape.middle).norm_square());
        shape.radius = std::sqrt(shape.radius);
      }
  }


  // Whether a face looks towards the slave's surface and is no part of it.
  bool
  SurfaceSearch::opposes(const MasterFace &face,
                         const Tensor<1, 3> &normal,
                         const unsigned int slave) const
  {
    const auto &outward = outwards[slave];
    return normal * outward <= -opposed * normal.norm() * outward.norm() &&
           std::find(face.nodes.begin(), face.nodes.end(), slaves[slave].number) ==
             face.nodes.end();
  }


  // The closest candidate face that looks towards the slave's surface and is not part of it. The
  // partner of the last search tells how close it is at least; which of equally close faces is
  // taken does not depend on it.
  bool
  SurfaceSearch::closest_face(const ContactNodes::Field &x,
                              const unsigned int slave,
                              Partner &partner) const
  {
    const auto point      = x[slaves[slave].number];
    const auto &outward   = outwards[slave];
    const double size     = outward.norm();
    const auto looks_here = [&](const unsigned int f) {
      return shapes[f].normal * outward <= -opposed * shapes[f].area * size;
    };
    double bound            = std::numeric_limits<double>::max();
    const unsigned int last = last_faces[slave];
    Projection of_last;
    if (last != numbers::invalid_unsigned_int && looks_here(last))
      {
        of_last = project(point, segment(x, masters[last]));
        bound   = of_last.offset.norm();
      }
    double best = std::numeric_limits<double>::max();
    for (unsigned int i = slaves[slave].first_candidate; i < slaves[slave + 1].first_candidate; ++i)
      {
        const unsigned int f = candidates[i];
        if (!looks_here(f))
          continue;
        // No point of the face is closer than its middle less the way to its furthest corner; a
        // thousandth so that rounding excludes no face.
        const double furthest = 1.001 * (shapes[f].radius + std::min(bound, best));
        if ((point - shapes[f].middle).norm_square() > furthest * furthest)
          continue;
        const Projection projection = f == last ? of_last : project(point, segment(x, masters[f]));
        const double distance       = projection.offset.norm();
        if (distance < best)
          {
            best               = distance;
            partner.face       = f;
            partner.projection = projection;
          }
      }
    return best < std::numeric_limits<double>::max();
  }


  bool
  SurfaceSearch::gap_at(const ContactNodes::Field &x, ContactPair &pair, double &gap) const
  {
    const unsigned int slave = pair.row;
    Partner partner;
    partner.face       = pair.face;
    partner.projection = project(x[slaves[slave].number], segment(x, masters[pair.face]));
    if (partner.projection.feature != Projection::Feature::face)
      slide_to_neighbour(x, slave, pair.shares_corner, partner);
    pair.wanders = partner.projection.feature != Projection::Feature::face ||
                   partner.face != pair.face;
    if (pair.shares_corner)
      {
        gap = face_normal(x, partner) * partner.projection.offset;
        return true;
      }
    const bool found = complete(x, slave, partner);
    gap              = partner.gap;
    return found;
  }


  // A step leads no further than to the neighbours. The faces of a corner or valley that the slave
  // has pairs with count for themselves.
  void
  SurfaceSearch::slide_to_neighbour(const ContactNodes::Field &x,
                                    const unsigned int slave,
                                    const bool across_ridges_only,
                                    Partner &partner) const
  {
    const auto point        = x[slaves[slave].number];
    const unsigned int left = partner.face;
    const auto foot         = point - partner.projection.offset;
    const auto normal       = face_normal(x, partner);
    double best             = partner.projection.offset.norm();
    visit_neighbours(left, [&](const unsigned int f) {
      const auto corners = segment(x, masters[f]);
      if (!opposes(masters[f], area_vector(corners), slave) ||
          (across_ridges_only && forms_valley(corners, foot, normal)))
        return;
      const auto projection = project(point, corners);
      if (projection.offset.norm() < best)
        {
          best               = projection.offset.norm();
          partner.face       = f;
          partner.projection = projection;
        }
    });
  }


  ContactPair
  SurfaceSearch::make_pair(const ContactNodes::Field &x,
                           const unsigned int slave,
                           const Partner &partner) const
  {
    ContactPair pair;
    pair.interface  = interface;
    pair.reversed   = reversed;
    pair.slave      = slaves[slave].node;
    pair.slave_id   = slaves[slave].id;
    pair.search     = number;
    pair.row        = slave;
    pair.face       = partner.face;
    pair.normal     = partner.normal;
    pair.gap        = partner.gap;
    pair.size       = slaves[slave].size;
    pair.stiffness  = std::min(slaves[slave].stiffness, masters[partner.face].stiffness);
    pair.nodes[0]   = slaves[slave].number;
    pair.place      = x[slaves[slave].number];
    pair.weights[0] = 1.;

    // Forces along the offset make no couple.
    const auto &offset  = partner.projection.offset;
    const double couple = coupled && has_friction ? offset.norm() :
                                                    (offset - partner.gap * partner.normal).norm();
    const bool levered  = couple > 1e-14 * pair.size &&
                         contact.gap_model == SurfaceContact::GapModel::point_to_segment;
    for (unsigned int k = 0; k < 4; ++k)
      if (levered || partner.projection.N[k] != 0.)
        {
          pair.nodes[pair.n_nodes]     = masters[partner.face].nodes[k];
          pair.weights[pair.n_nodes++] = -partner.projection.N[k];
        }
    if (levered)
      set_lever(segment(x, masters[partner.face]), 1, offset, pair);
    return pair;
  }


  void
  SurfaceSearch::find_pairs(const NodalVector &positions,
                            const ContactNodes::Field &x,
                            const double reach,
                            const double travelled,
                            std::vector<ContactPair> &pairs)
  {
    ++n_searches;
    for (unsigned int s = 0; s + 1 < slaves.size(); ++s)
      {
        if (slaves[s].first_candidate == slaves[s + 1].first_candidate || travelled < rest_until[s])
          continue;
        measure_candidates(x, s);
        outwards[s] = slave_normal(positions, s);
        Partner partner;
        if (!closest_face(x, s, partner))
          {
            // Faces around a fold may turn towards the slave.
            last_faces[s] = numbers::invalid_unsigned_int;
            rest_until[s] = travelled + 0.1 * search_radius;
            continue;
          }
        last_faces[s]         = partner.face;
        const double distance = partner.projection.offset.norm();
        // Whatever is inside stays under watch.
        const bool outside = partner.projection.offset * shapes[partner.face].normal > 0.;
        if (outside && distance > 2. * reach)
          rest_until[s] = travelled + 0.5 * (distance - reach);
        if (!complete(x, s, partner))
          continue;
        pairs.push_back(make_pair(x, s, partner));
        if (coupled && distance <= reach)
          {
            add_valley_pairs(x, reach, partner, pairs);
            add_corner_pairs(x, reach, pairs);
          }
      }
  }
} // namespace akmon
