#include <akmon/contact/search/face_geometry.h>
#include <akmon/contact/search/feature_search.h>

#include <algorithm>
#include <cmath>

// Pairs of sharp corners of rigid bodies with faces.

namespace akmon
{
  using namespace dealii;

  namespace
  {
    constexpr double opposed  = 0.02; // cosine: a corner and a face look at each other
    constexpr double above    = 1e-3; // of the face's size: beside it by less counts as on it
    constexpr double rounding = 1e-6; // of the face's size
  }                                   // namespace


  ContactPair
  FeatureSearch::make_pair(const View &view, const Record &record, const Touch &touch)
  {
    ContactPair pair;
    const bool of_edge = record.kind == Kind::crossing;
    const auto &edge   = surface.get_edges()[of_edge ? record.partner : 0];
    const auto &face   = surface.get_faces()[of_edge ? edge.faces[0] : record.partner];
    pair.interface     = interface;
    pair.kind          = ContactPair::Kind::rigid_feature;
    pair.slave         = numbers::invalid_unsigned_int;
    pair.slave_id = record.feature + (record.kind == Kind::corner ? 0 : features.vertices.size());
    pair.slot     = static_cast<unsigned int>(record.kind) + record.part;
    if (of_edge)
      pair.others = {{edge.ids[0], edge.ids[1], 0}};
    else
      pair.others = {{face.ids[0], face.ids[1], face.ids[2]}};
    pair.row       = records.size();
    pair.face      = record.partner;
    pair.normal    = touch.normal;
    pair.gap       = touch.gap;
    pair.size      = face.size;
    pair.stiffness = face.stiffness;
    pair.place     = Tensor<1, 3>();
    pair.n_nodes   = 0;
    if (body.moves())
      pair.add_node(view.first_rigid, 1.);
    for (const auto &[node, weight] : touch.masters)
      {
        pair.place += weight * view.x[node];
        if (weight != 0.)
          pair.add_node(node, -weight);
      }
    if (body.moves())
      pair.add_rotation(view.first_rigid + 1, 1., pair.place - body.centre());
    records.push_back(record);
    return pair;
  }


  void
  FeatureSearch::find_pairs(const View &view,
                            const std::vector<ContactPair> &previous,
                            std::vector<ContactPair> &pairs)
  {
    const std::size_t first = pairs.size();
    records.clear();
    find_corner_pairs(view, pairs);
    find_crossings(view, previous, pairs);
    find_bulges(view, previous, pairs);
    std::sort(pairs.begin() + first, pairs.end(), by_key);
  }


  void
  FeatureSearch::find_corner_pairs(const View &view, std::vector<ContactPair> &pairs)
  {
    const Pose pose = body.pose();
    const auto R    = pose.orientation.matrix();
    for (std::size_t begin = 0, end; begin < faces_of_corners.size(); begin = end)
      {
        const unsigned int vertex = faces_of_corners[begin][0];
        end                       = begin;
        while (end < faces_of_corners.size() && faces_of_corners[end][0] == vertex)
          ++end;
        const auto p    = pose.place + R * features.vertices[vertex].place;
        const auto feet = feet_of_corner(view,
                                         begin,
                                         end,
                                         p,
                                         R * features.vertices[vertex].outward);
        if (!feet.empty())
          add_corner(view, vertex, p, feet, pairs);
      }
  }


  // Closest points of candidate faces that look at the corner, not too far. Behind a face the
  // corner is inside only if no other face is closer, which it may be outside of.
  std::vector<FeatureSearch::Foot>
  FeatureSearch::feet_of_corner(const View &view,
                                const std::size_t begin,
                                const std::size_t end,
                                const Tensor<1, 3> &p,
                                const Tensor<1, 3> &outward) const
  {
    std::vector<Foot> feet;
    double nearest = std::numeric_limits<double>::max();
    for (std::size_t i = begin; i < end; ++i)
      {
        const unsigned int f = faces_of_corners[i][1];
        const auto &face     = surface.get_faces()[f];
        const auto corners   = surface.segment(view.x, f);
        if ((p - middle_of(corners)).norm() >
            half_width(corners) + std::max(view.reach, deepest_part * face.depth))
          continue;
        Foot foot{f, project(p, corners), {}, 0.};
        const double distance = foot.projection.offset.norm();
        nearest               = std::min(nearest, distance);
        const auto area       = area_vector(corners);
        if (area * outward > -opposed * area.norm())
          continue;
        foot.normal = segment_normal(corners, foot.projection.xi, foot.projection.eta);
        foot.gap    = foot.normal * foot.projection.offset;
        if (distance <= (foot.gap > 0. ? view.reach : deepest_part * face.depth))
          feet.push_back(foot);
      }
    feet.erase(std::remove_if(feet.begin(),
                              feet.end(),
                              [&](const Foot &foot) {
                                return foot.gap < 0. &&
                                       foot.projection.offset.norm() >
                                         nearest + rounding * surface.get_faces()[foot.face].size;
                              }),
               feet.end());
    return feet;
  }


  // Whether a face beside the one whose border a corner is closest to rises in front of it.
  bool
  FeatureSearch::rises_beside(const ContactNodes::Field &x,
                              const Tensor<1, 3> &p,
                              const Foot &foot) const
  {
    const auto around = surface.faces_around(foot.face, foot.projection);
    return std::any_of(around.begin(), around.end(), [&](const unsigned int f) {
      return f != foot.face &&
             (middle_of(surface.segment(x, f)) - (p - foot.projection.offset)) * foot.normal >
               rounding * surface.get_faces()[f].size;
    });
  }


  // A corner stays before all faces that it is above; on a ridge before the mean of both sides.
  void
  FeatureSearch::add_corner(const View &view,
                            const unsigned int vertex,
                            const Tensor<1, 3> &p,
                            const std::vector<Foot> &feet,
                            std::vector<ContactPair> &pairs)
  {
    const std::size_t first = pairs.size();
    const auto add          = [&](const Foot &foot, const Tensor<1, 3> &normal, const double gap) {
      Touch touch{{}, normal, gap};
      for (unsigned int k = 0; k < 4; ++k)
        touch.masters.emplace_back(surface.get_faces()[foot.face].nodes[k], foot.projection.N[k]);
      pairs.push_back(make_pair(view, {Kind::corner, vertex, foot.face}, touch));
      pairs.back().foot = {{foot.projection.xi, foot.projection.eta}};
    };
    const auto closest = *std::min_element(feet.begin(),
                                           feet.end(),
                                           [](const Foot &a, const Foot &b) {
                                             return a.projection.offset.norm_square() <
                                                    b.projection.offset.norm_square();
                                           });
    for (const Foot &foot : feet)
      {
        const double size   = surface.get_faces()[foot.face].size;
        const double beside = (foot.projection.offset - foot.gap * foot.normal).norm();
        const bool is_above = foot.projection.feature == Projection::Feature::face ||
                              (beside <= above * size && rises_beside(view.x, p, foot));
        if (is_above)
          add(foot, foot.normal, foot.gap);
      }
    if (pairs.size() > first && (closest.projection.feature == Projection::Feature::face ||
                                 rises_beside(view.x, p, closest)))
      {
        for (auto pair = pairs.begin() + first; pair != pairs.end(); ++pair)
          pair->shares_corner = pairs.size() > first + 1;
        return;
      }
    bool on_rim;
    const auto normal = surface.feature_normal(view.x, closest.face, closest.projection, on_rim);
    const double gap  = normal * closest.projection.offset;
    const double overhang = (closest.projection.offset - gap * normal).norm();
    if (!on_rim || overhang <= above * surface.get_faces()[closest.face].size)
      {
        pairs.erase(std::remove_if(pairs.begin() + first,
                                   pairs.end(),
                                   [&](const ContactPair &pair) {
                                     return pair.face == closest.face;
                                   }),
                    pairs.end());
        add(closest, normal, gap);
      }
  }


  // Of the place that the corner has come to, from the face that it was above.
  double
  FeatureSearch::corner_gap(const ContactNodes::Field &x,
                            const Tensor<1, 3> &p,
                            ContactPair &pair) const
  {
    constexpr unsigned int most_faces = 16; // that it has passed

    Foot foot{pair.face, project(p, surface.segment(x, pair.face), near_border, pair.foot), {}, 0.};
    const auto normal_there = [&]() {
      return segment_normal(surface.segment(x, foot.face), foot.projection.xi, foot.projection.eta);
    };
    bool moved = foot.projection.feature != Projection::Feature::face;
    for (unsigned int n = 0; moved && n < most_faces; ++n)
      {
        moved       = false;
        foot.normal = normal_there();
        Foot best   = foot;
        for (const unsigned int f : surface.faces_around(foot.face, foot.projection))
          {
            const auto corners = surface.segment(x, f);
            const auto rise    = (middle_of(corners) - (p - foot.projection.offset)) * foot.normal;
            if (f == foot.face ||
                (pair.shares_corner && rise > rounding * surface.get_faces()[f].size))
              continue;
            const auto projection = project(p, corners);
            if (projection.offset.norm() < best.projection.offset.norm())
              {
                best  = {f, projection, {}, 0.};
                moved = true;
              }
          }
        foot = best;
      }
    pair.wanders = foot.face != pair.face || foot.projection.feature != Projection::Feature::face;
    if (pair.shares_corner)
      return normal_there() * foot.projection.offset;
    bool on_rim;
    const auto normal = surface.feature_normal(x, foot.face, foot.projection, on_rim);
    const double gap  = normal * foot.projection.offset;
    const double size = surface.get_faces()[foot.face].size;
    const bool beyond = on_rim && (foot.projection.offset - gap * normal).norm() > above * size;
    return beyond ? foot.projection.offset.norm() : gap;
  }


  bool
  FeatureSearch::gap_at(const ContactNodes::Field &x,
                        const Pose &pose,
                        ContactPair &pair,
                        double &gap) const
  {
    const Record &record = records[pair.row];
    if (record.kind == Kind::corner)
      {
        const auto &X = features.vertices[record.feature].place;
        gap           = corner_gap(x, pose.place + pose.orientation.matrix() * X, pair);
        return true;
      }
    const Line line = line_of(pose, record.feature);
    if (record.kind == Kind::bulge)
      {
        std::array<double, 2> stretch;
        if (!stretch_over(x, line, record.partner, stretch))
          return false;
        gap = least_gap_around(x, line, record, stretch);
        return true;
      }
    Crossing crossing;
    if (!cross(x, line, record.partner, crossing))
      return false;
    gap = gap_of(x, line, record.partner, crossing);
    return true;
  }
} // namespace akmon
