#include <akmon/contact/search/face_box.h>
#include <akmon/contact/search/face_geometry.h>
#include <akmon/contact/search/surface_search.h>

#include <algorithm>
#include <array>
#include <cmath>

// How far faces are from slaves at least, and which way they look.

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // Corners of as many segments as there are lanes.
    struct LaneCorners
    {
      alignas(lane_alignment) double values[4][3][n_lanes] = {};

      void
      set(const unsigned int lane, const Segment &corners)
      {
        for (unsigned int k = 0; k < 4; ++k)
          for (unsigned int d = 0; d < 3; ++d)
            values[k][d][lane] = corners[k][d];
      }

      FaceBox<Lanes>
      boxes() const
      {
        std::array<FaceBox<Lanes>::Vector, 4> corners;
        for (unsigned int k = 0; k < 4; ++k)
          for (unsigned int d = 0; d < 3; ++d)
            load(values[k][d], corners[k][d]);
        return FaceBox<Lanes>(corners);
      }
    };
  } // namespace


  // Sum of the area vectors of the slave faces around a node.
  Tensor<1, 3>
  SurfaceSearch::slave_normal(const ContactNodes::Field &x, const unsigned int slave)
  {
    Tensor<1, 3> normal;
    for (unsigned int i = slaves[slave].first_face; i < slaves[slave + 1].first_face; ++i)
      {
        FaceArea &area = face_areas[slave_face_list[i]];
        if (area.look != n_configurations)
          area = {n_configurations, area_vector(segment(x, nodes_of_slave_faces[i]))};
        normal += area.vector;
      }
    return normal;
  }


  void
  SurfaceSearch::box_masters(const ContactNodes::Field &x)
  {
    LaneCorners corners;
    boxes_of_masters.resize(masters.size());
    for (unsigned int begin = 0; begin < masters.size(); begin += n_lanes)
      {
        const unsigned int n_here = std::min<unsigned int>(masters.size() - begin, n_lanes);
        for (unsigned int lane = 0; lane < n_here; ++lane)
          corners.set(lane, segment(x, masters[begin + lane]));
        corners.boxes().split(n_here, &boxes_of_masters[begin]);
      }
  }


  // The candidates that may be within reach, of the slaves for which it matters.
  void
  SurfaceSearch::choose_near_candidates()
  {
    near.resize(candidates.size());
    n_near = 0;
    for (const auto &[slave, reach] : looks)
      {
        const Memory &memory   = memories[slave];
        const double within    = furthest * reach;
        const bool one_will_do = !memory.was_outside && memory.others_clear_of > within &&
                                 memory.face != numbers::invalid_unsigned_int;
        if (!one_will_do)
          for (unsigned int i = slaves[slave].first_candidate;
               i < slaves[slave + 1].first_candidate;
               ++i)
            {
              near[n_near] = {slaves[slave].number, i};
              n_near += bound_of_distance(i) <= within; // without a branch
            }
      }
  }


  // By the boxes around them.
  void
  SurfaceSearch::bound_distances(const ContactNodes::Field &x)
  {
    LaneCorners corners;
    alignas(lane_alignment) double places[3][n_lanes] = {}, distances[n_lanes];
    for (unsigned int begin = 0; begin < n_near; begin += n_lanes)
      {
        const unsigned int n_here = std::min(n_near - begin, n_lanes);
        for (unsigned int lane = 0; lane < n_here; ++lane)
          {
            const auto &[node, candidate] = near[begin + lane];
            corners.set(lane, segment(x, masters[candidates[candidate].face]));
            const auto place = x[node];
            for (unsigned int d = 0; d < 3; ++d)
              places[d][lane] = place[d];
          }
        FaceBox<Lanes>::Vector points;
        for (unsigned int d = 0; d < 3; ++d)
          load(places[d], points[d]);
        store(corners.boxes().bound_of_distance(points), distances);
        for (unsigned int lane = 0; lane < n_here; ++lane)
          {
            Candidate &candidate = candidates[near[begin + lane].candidate];
            candidate.clear_of   = body_pairs[candidate.pair].travelled + distances[lane];
          }
      }
  }


  // Whether a face with an area vector looks towards the slave's surface: its mean, or one of its
  // faces clearly. The mean alone would leave out the small face of a corner that is bent.
  bool
  SurfaceSearch::looks_at(const unsigned int slave, const Tensor<1, 3> &area) const
  {
    constexpr double clearly = 0.5; // cosine

    const double area_2 = area.norm_square();
    const auto opposes  = [&](const Tensor<1, 3> &outward, const double cosine) {
      const double product = area * outward;
      return product <= 0. && product * product >= cosine * cosine * area_2 * outward.norm_square();
    };
    if (!(area_2 > 0.))
      return false;
    if (opposes(outwards[slave], opposed))
      return true;
    for (unsigned int i = slaves[slave].first_face; i < slaves[slave + 1].first_face; ++i)
      if (opposes(face_areas[slave_face_list[i]].vector, clearly))
        return true;
    return false;
  }


  // Whether a face looks towards the slave's surface, or is of another body and the slave in front
  // of it, not beside a sharp edge: then it is outside, however its own surface is bent.
  bool
  SurfaceSearch::faces_slave(const ContactNodes::Field &x,
                             const unsigned int slave,
                             const Segment &corners,
                             const Partner &partner) const
  {
    constexpr double in_front = -0.01, beside = 0.5; // of the cell size; of the gap

    const auto area = area_vector(corners);
    if (looks_at(slave, area))
      return true;
    const auto &offset  = partner.projection.offset;
    const double gap    = area * offset / area.norm();
    const double within = -in_front * slaves[slave].size;
    if (fetched[partner.face].body == discretization.body_of_node[slaves[slave].node] ||
        gap <= -within)
      return false;
    if (partner.projection.feature == Projection::Feature::face)
      return true;
    if ((offset - gap * area / area.norm()).norm() > std::max(within, beside * gap))
      return false;
    const Feature feature = feature_of(x, partner);
    return !feature.on_rim && !feature.normals.turn_sharply(feature.mean);
  }


  // Whether it is no part of that surface besides.
  bool
  SurfaceSearch::opposes(const ContactNodes::Field &x,
                         const unsigned int face,
                         const unsigned int slave) const
  {
    const auto &nodes = masters[face].nodes;
    return looks_at(slave, area_vector(segment(x, nodes))) &&
           std::find(nodes.begin(), nodes.end(), slaves[slave].number) == nodes.end();
  }


  // Whether a face is seen from behind, through the body that both are of.
  bool
  SurfaceSearch::is_through_body(const unsigned int slave,
                                 const unsigned int face,
                                 const Segment &corners,
                                 const Projection &projection) const
  {
    return fetched[face].body == discretization.body_of_node[slaves[slave].node] &&
           unit_normal(corners) * projection.offset < -deepest_inside(slave, face);
  }


  // False where bodies that are flush touch along parallel edges only: a slave at a sharp edge of
  // its body is at the border of a face, and all of its own faces that lie flat against that one
  // are next to it.
  bool
  SurfaceSearch::lies_on(const ContactNodes::Field &x,
                         const unsigned int slave,
                         const Segment &corners,
                         const Projection &projection) const
  {
    constexpr double touching = 1e-3, flat = 0.9, next_to = 1e-3; // of the cell size; cosine, sine

    if (projection.feature == Projection::Feature::face ||
        projection.offset.norm() > touching * slaves[slave].size)
      return true;
    const auto normal    = unit_normal(corners);
    const auto goes_over = [&](const Tensor<1, 3> &way, const unsigned int k) {
      const auto inward = cross_product_3d(normal, corners[(k + 1) % 4] - corners[k]);
      return inward * way > next_to * inward.norm() * way.norm();
    };
    NormalCone own_normals;
    bool any = false;
    for (unsigned int i = slaves[slave].first_face; i < slaves[slave + 1].first_face; ++i)
      {
        const auto own = segment(x, nodes_of_slave_faces[i]);
        own_normals.push_back(unit_normal(own));
        if (own_normals.back() * normal > -flat)
          continue;
        any            = true;
        const auto way = middle_of(own) - x[slaves[slave].number];
        if (goes_over(way, projection.where) && (projection.feature == Projection::Feature::edge ||
                                                 goes_over(way, (projection.where + 3) % 4)))
          return true;
      }
    return !any || !own_normals.turn_sharply(outwards[slave] / outwards[slave].norm());
  }


  // Whether a face rises in front of the one beside it with a normal at a foot.
  bool
  SurfaceSearch::rises_from(const Segment &corners,
                            const Tensor<1, 3> &foot,
                            const Tensor<1, 3> &normal)
  {
    constexpr double nearly_flat = 0.99875; // cosine of 0.05

    return (middle_of(corners) - foot) * normal > 0. &&
           unit_normal(corners) * normal <= nearly_flat;
  }
} // namespace akmon
