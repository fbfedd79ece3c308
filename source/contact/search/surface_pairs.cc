#include <akmon/contact/search/face_geometry.h>
#include <akmon/contact/search/surface_search.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace akmon
{
  using namespace dealii;

  // Whether a face beside the one with the normal at the foot rises in front of it.
  bool
  SurfaceSearch::FaceShape::rises_from(const Tensor<1, 3> &foot, const Tensor<1, 3> &normal) const
  {
    constexpr double nearly_flat = 0.99875; // cosine of 0.05

    return box[2] * normal <= nearly_flat && (middle - foot) * normal > 0.;
  }


  // Sum of the area vectors of the slave faces around a node.
  Tensor<1, 3>
  SurfaceSearch::slave_normal(const NodalVector &positions, const unsigned int slave) const
  {
    Tensor<1, 3> normal;
    for (unsigned int i = slaves[slave].first_face; i < slaves[slave + 1].first_face; ++i)
      {
        const auto &face = slave_faces[slave_face_list[i]];
        normal += area_vector(segment_of(face, positions));
      }
    return normal;
  }


  // The segment is in the convex hull of its corners, and that in the box.
  SurfaceSearch::FaceShape::FaceShape(const Segment &corners)
    : normal(area_vector(corners))
    , middle(0.25 * (corners[0] + corners[1] + corners[2] + corners[3]))
    , area(normal.norm())
  {
    constexpr double for_rounding = 1e-3;

    const auto along = (corners[1] - corners[0]) + (corners[2] - corners[3]);
    box[2]           = normal / area;
    box[0]           = along - (along * box[2]) * box[2];
    box[0] /= box[0].norm();
    box[1]       = cross_product_3d(box[2], box[0]);
    half_widths  = {};
    double width = 0.;
    for (unsigned int d = 0; d < 3; ++d)
      {
        for (const auto &corner : corners)
          half_widths[d] = std::max(half_widths[d], std::abs((corner - middle) * box[d]));
        width = std::max(width, half_widths[d]);
      }
    for (double &half_width : half_widths)
      half_width += for_rounding * width;
  }


  // In the configuration of the search, measured for the first slave that needs it.
  const SurfaceSearch::FaceShape &
  SurfaceSearch::shape_of(const ContactNodes::Field &x, const unsigned int face)
  {
    FaceShape &shape = shapes[face];
    if (shape.measured_in != n_searches)
      {
        shape             = FaceShape(segment(x, masters[face]));
        shape.measured_in = n_searches;
      }
    return shape;
  }


  // Whether a face looks towards the slave's surface and is no part of it.
  bool
  SurfaceSearch::opposes(const MasterFace &face,
                         const FaceShape &shape,
                         const unsigned int slave) const
  {
    const auto &outward = outwards[slave];
    return shape.box[2] * outward <= -opposed * outward.norm() &&
           std::find(face.nodes.begin(), face.nodes.end(), slaves[slave].number) ==
             face.nodes.end();
  }


  // The closest candidate face that looks towards the slave's surface and is not part of it. The
  // partner of the last search tells how close it is at least, and often that no other face can
  // count; which of equally close faces is taken does not depend on it.
  bool
  SurfaceSearch::closest_face(const ContactNodes::Field &x,
                              const unsigned int slave,
                              const double reach,
                              Partner &partner)
  {
    constexpr double largest = std::numeric_limits<double>::max();

    Memory &memory        = memories[slave];
    const auto point      = x[slaves[slave].number];
    const auto &outward   = outwards[slave];
    const double least    = -opposed * outward.norm();
    const auto looks_here = [&](const FaceShape &shape) { return shape.box[2] * outward <= least; };
    double best = largest, bound = largest;
    if (memory.face != numbers::invalid_unsigned_int && looks_here(shape_of(x, memory.face)))
      {
        partner.face       = memory.face;
        partner.projection = project(point, segment(x, masters[memory.face]));
        bound              = partner.projection.offset.norm();
        if (memory.others_clear_of > std::max(bound, reach))
          return true;
      }
    const Projection of_last = partner.projection;
    std::array<double, 2> least_bounds{{largest, largest}}; // of all faces
    unsigned int with_least = numbers::invalid_unsigned_int;
    for (unsigned int i = slaves[slave].first_candidate; i < slaves[slave + 1].first_candidate; ++i)
      {
        const unsigned int f   = candidates[i];
        const double travelled = body_pairs[pair_of_candidate[i]].travelled;
        double at_least        = candidates_clear_of[i] - travelled;
        const bool is_far = f != memory.face && at_least > std::max(reach, std::min(bound, best));
        if (!is_far)
          {
            at_least               = shape_of(x, f).bound_of_distance(point);
            candidates_clear_of[i] = travelled + at_least;
          }
        least_bounds[1] = std::min(least_bounds[1], std::max(at_least, least_bounds[0]));
        if (at_least < least_bounds[0])
          {
            least_bounds[0] = at_least;
            with_least      = f;
          }
        if (is_far || (f != memory.face && at_least > std::min(bound, best)) ||
            !looks_here(shapes[f]))
          continue;
        const Projection projection = f == memory.face ? of_last :
                                                         project(point, segment(x, masters[f]));
        if (const double distance = projection.offset.norm(); distance < best)
          {
            best               = distance;
            partner.face       = f;
            partner.projection = projection;
          }
      }
    const bool found       = best < largest;
    memory.others_clear_of = least_bounds[found && partner.face == with_least ? 1 : 0];
    return found;
  }


  bool
  SurfaceSearch::gap_at(const ContactNodes::Field &x, ContactPair &pair, double &gap) const
  {
    const unsigned int slave = pair.row;
    Partner partner;
    partner.face       = pair.face;
    partner.projection = project(x[slaves[slave].number],
                                 segment(x, masters[pair.face]),
                                 near_border,
                                 pair.foot);
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
      const FaceShape shape(corners);
      if (shape.bound_of_distance(point) > best || !opposes(masters[f], shape, slave) ||
          (across_ridges_only && shape.rises_from(foot, normal)))
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
    pair.foot       = {{partner.projection.xi, partner.projection.eta}};
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


  // A step later. Forces may hand on the motion of a body to its neighbours.
  void
  SurfaceSearch::advance(const BodyMotions &motions)
  {
    for (BodyPair &pair : body_pairs)
      {
        pair.approach  = motions.approach(pair.of_slaves, pair.of_faces);
        pair.increment = pair.of_slaves == pair.of_faces ?
                           motions.within(pair.of_faces) :
                           std::max(motions.around(pair.of_faces), motions.around(pair.of_slaves));
        pair.travelled += pair.approach;
      }
  }


  // The slaves that may have come within their reach of a face.
  void
  SurfaceSearch::choose_looks(const double steps, const double least_reach)
  {
    looks.clear();
    for (unsigned int s = 0; s + 1 < slaves.size(); ++s)
      {
        const unsigned int begin = pairs_around_begin[s], end = pairs_around_begin[s + 1];
        if (begin == end)
          continue;
        double approach = 0., increment = 0.;
        for (unsigned int i = begin; i < end; ++i)
          {
            approach  = std::max(approach, body_pairs[pairs_around[i]].approach);
            increment = std::max(increment, body_pairs[pairs_around[i]].increment);
          }
        memories[s].clear_of -= approach;
        memories[s].others_clear_of -= approach;
        const double reach = std::max(least_reach, steps * increment);
        if (memories[s].clear_of <= reach)
          looks.push_back({s, reach});
      }
  }


  void
  SurfaceSearch::find_pairs(const NodalVector &positions,
                            const ContactNodes::Field &x,
                            const BodyMotions &motions,
                            const double steps,
                            const double least_reach,
                            std::vector<ContactPair> &pairs)
  {
    ++n_searches;
    advance(motions);
    choose_looks(steps, least_reach);
    for (const auto &[slave, reach] : looks)
      {
        outwards[slave] = slave_normal(positions, slave);
        find_pairs_of(x, slave, reach, pairs);
      }
  }


  void
  SurfaceSearch::find_pairs_of(const ContactNodes::Field &x,
                               const unsigned int slave,
                               const double reach,
                               std::vector<ContactPair> &pairs)
  {
    Memory &memory = memories[slave];
    Partner partner;
    if (!closest_face(x, slave, furthest * reach, partner))
      {
        // Faces around a fold may turn towards the slave.
        memory.face     = numbers::invalid_unsigned_int;
        memory.clear_of = reach + 0.1 * search_radius;
        return;
      }
    memory.face           = partner.face;
    const double distance = partner.projection.offset.norm();
    // Whatever is inside stays under watch.
    const bool outside = partner.projection.offset * shapes[partner.face].normal > 0.;
    memory.clear_of    = outside ? distance : 0.;
    if ((outside && distance > reach) || !complete(x, slave, partner))
      return;
    pairs.push_back(make_pair(x, slave, partner));
    if (coupled && distance <= reach && memory.others_clear_of <= furthest * reach)
      {
        add_valley_pairs(x, reach, partner, pairs);
        add_corner_pairs(x, reach, pairs);
      }
  }
} // namespace akmon
