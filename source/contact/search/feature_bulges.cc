#include <akmon/contact/search/edge_over_face.h>
#include <akmon/contact/search/face_geometry.h>
#include <akmon/contact/search/feature_search.h>

#include <algorithm>

// Pairs of sharp edges of rigid bodies with the inside of faces that bulge towards them.

namespace akmon
{
  using namespace dealii;

  // The part of an edge that is above a face; false if there is none.
  bool
  FeatureSearch::stretch_over(const ContactNodes::Field &x,
                              const Line &line,
                              const unsigned int face,
                              std::array<double, 2> &s) const
  {
    return akmon::stretch_over({line.a, line.u}, surface.segment(x, face), s);
  }


  double
  FeatureSearch::gap_over(const ContactNodes::Field &x,
                          const Tensor<1, 3> &p,
                          const unsigned int face) const
  {
    return akmon::gap_over(p, surface.segment(x, face));
  }


  // How far the middle of an edge over a face is closer to it than its ends are in the mean.
  double
  FeatureSearch::sag_over(const ContactNodes::Field &x,
                          const Line &line,
                          const unsigned int face,
                          const std::array<double, 2> &stretch) const
  {
    return akmon::sag_over({line.a, line.u}, surface.segment(x, face), stretch);
  }


  // A lower bound of the gap along an edge over a face, without looking for where it is least: the
  // twist of a bilinear face bulges by a quarter of itself at most.
  double
  FeatureSearch::least_gap_over(const ContactNodes::Field &x,
                                const Line &line,
                                const unsigned int face,
                                const std::array<double, 2> &stretch) const
  {
    constexpr double surely = 0.5; // of the twist

    const auto corners = surface.segment(x, face);
    return std::min(gap_over(x, line.a + stretch[0] * line.u, face),
                    gap_over(x, line.a + stretch[1] * line.u, face)) -
           surely * twist_of(corners);
  }


  // Where a third of an edge over a face that bulges is closest to it: at one of its ends, or where
  // it is parallel to the face. What is at the ends of the edge over the face has other pairs.
  double
  FeatureSearch::closest_over(const ContactNodes::Field &x,
                              const Line &line,
                              const unsigned int face,
                              const std::array<double, 2> &stretch,
                              const unsigned int part) const
  {
    constexpr double from_ends = 5e-3; // of the edge over the face

    const auto at = [&](const double third) {
      return stretch[0] +
             std::clamp(third / 3., from_ends, 1. - from_ends) * (stretch[1] - stretch[0]);
    };
    return closest_between({line.a, line.u}, surface.segment(x, face), at(part), at(part + 1.));
  }


  FeatureSearch::Touch
  FeatureSearch::touch_over(const ContactNodes::Field &x,
                            const Tensor<1, 3> &p,
                            const unsigned int face) const
  {
    const auto corners = surface.segment(x, face);
    const auto foot    = project(p, corners);
    Touch touch;
    touch.normal = segment_normal(corners, foot.xi, foot.eta);
    touch.gap    = touch.normal * foot.offset;
    for (unsigned int k = 0; k < 4; ++k)
      touch.masters.emplace_back(surface.get_faces()[face].nodes[k], foot.N[k]);
    return touch;
  }


  // Whether an edge may touch a face that is no further than a distance.
  bool
  FeatureSearch::is_near(const ContactNodes::Field &x,
                         const Line &line,
                         const unsigned int f,
                         const double reach) const
  {
    const auto &face   = surface.get_faces()[f];
    const auto corners = surface.segment(x, f);
    return line.distance(middle_of(corners)) <=
             half_width(corners) + std::max(reach, deepest_part * face.depth) &&
           line.may_touch(unit_normal(corners));
  }


  // What the twist of a face may add to its bulge in a step, from the last one.
  double
  FeatureSearch::bulge_to_come(const View &view, const unsigned int face) const
  {
    constexpr double steps = 4.;

    const auto &nodes = surface.get_faces()[face].nodes;
    return steps *
           (view.dx[nodes[0]] - view.dx[nodes[1]] + view.dx[nodes[2]] - view.dx[nodes[3]]).norm();
  }


  void
  FeatureSearch::find_bulges(const View &view,
                             const std::vector<ContactPair> &previous,
                             std::vector<ContactPair> &pairs)
  {
    constexpr double least_sag = 1e-9; // of the face's size: less is no bulge

    const auto lines = lines_now();
    near_edges.clear();
    for (const auto &[feature, f] : faces_of_edges)
      {
        const auto &face = surface.get_faces()[f];
        const Line &line = lines[feature];
        if (!is_near(view.x, line, f, view.reach))
          continue;
        near_edges.push_back({{feature, f}});
        std::array<double, 2> stretch;
        if (!stretch_over(view.x, line, f, stretch) ||
            least_gap_over(view.x, line, f, stretch) > view.reach ||
            sag_over(view.x, line, f, stretch) + bulge_to_come(view, f) < least_sag * face.size)
          continue;
        for (unsigned int part = 0; part < 3; ++part)
          {
            const double s    = closest_over(view.x, line, f, stretch, part);
            const Touch touch = touch_over(view.x, line.a + s * line.u, f);
            if (touch.gap > view.reach || touch.gap < -deepest_part * face.depth)
              continue;
            const auto pair = make_pair(view, {Kind::bulge, feature, f, part, s}, touch);
            if (!is_behind(pair, previous))
              pairs.push_back(pair);
          }
      }
  }


  // The pairs of an edge and a face tell how deep it is at their points of the edge. Where it is
  // deeper by more than gaps are settled to there has to be another one.
  void
  FeatureSearch::join_bulges(const View &view,
                             const View &reached,
                             const Pose &pose,
                             const std::vector<ContactPair> &pairs,
                             const double tolerance,
                             std::vector<ContactPair> &joining)
  {
    for (const auto &[feature, f] : near_edges)
      {
        const Line line   = line_of(pose, feature);
        const double size = surface.get_faces()[f].size;
        std::array<double, 2> stretch;
        if (!line.may_touch(unit_normal(surface.segment(reached.x, f))) ||
            !stretch_over(reached.x, line, f, stretch) ||
            least_gap_over(reached.x, line, f, stretch) >= -tolerance * size)
          continue;
        double seen         = 0.;
        unsigned int number = 0;
        for (const auto &pair : pairs)
          if (pair.kind == ContactPair::Kind::rigid_feature && pair.interface == interface)
            if (const Record &record = records[pair.row];
                record.kind == Kind::bulge && record.feature == feature && record.partner == f)
              {
                seen   = std::min(seen, gap_over(reached.x, line.a + record.s * line.u, f));
                number = std::max(number, record.part + 1);
              }
        for (unsigned int part = 0; part < 3; ++part)
          {
            const double s   = closest_over(reached.x, line, f, stretch, part);
            const double gap = gap_over(reached.x, line.a + s * line.u, f);
            if (gap >= seen - tolerance * size)
              continue;
            const Line before = line_of(body.pose(), feature);
            const Touch touch = touch_over(view.x, before.a + s * before.u, f);
            if (gap >= touch.gap - tolerance * size || touch.gap < -barely_inside * size)
              continue;
            auto pair      = make_pair(view,
                                  {Kind::bulge, feature, f, std::max(number++, 3U), s},
                                  touch);
            pair.curvature = gap - pair.gap - pair.normal * pair.relative(reached.dx);
            joining.push_back(pair);
          }
      }
  }
} // namespace akmon
