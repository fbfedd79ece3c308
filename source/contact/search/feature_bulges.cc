#include <akmon/contact/search/edge_over_face.h>
#include <akmon/contact/search/face_geometry.h>
#include <akmon/contact/search/feature_search.h>

#include <algorithm>

// Pairs of sharp edges of rigid bodies with the inside of faces that bulge towards them.

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // Pairs of an edge and a face to begin with; each sees what is around it, in parts of the edge
    // over the face.
    constexpr unsigned int n_parts = 3;
    constexpr double seen_around   = 0.25;

  } // namespace


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


  // Where a part of an edge over a face that bulges is closest to it, from and to parts of what is
  // over the face. What is at the ends has other pairs.
  double
  FeatureSearch::closest_over(const ContactNodes::Field &x,
                              const Line &line,
                              const unsigned int face,
                              const std::array<double, 2> &stretch,
                              const double from,
                              const double to) const
  {
    constexpr double from_ends = 5e-3; // of the edge over the face

    const auto at = [&](const double part) {
      return stretch[0] + std::clamp(part, from_ends, 1. - from_ends) * (stretch[1] - stretch[0]);
    };
    return closest_between({line.a, line.u}, surface.segment(x, face), at(from), at(to));
  }


  // The least gap around a pair's point of the edge: where a bulge is highest moves on in a step.
  // Each place is seen by one pair only, as two with one gap would not settle.
  double
  FeatureSearch::least_gap_around(const ContactNodes::Field &x,
                                  const Line &line,
                                  const Record &pair,
                                  const std::array<double, 2> &stretch) const
  {
    const double length = stretch[1] - stretch[0];
    double low = pair.s - seen_around * length, high = pair.s + seen_around * length;
    for (const Record &other : records)
      if (other.is_beside(pair))
        {
          const double middle = 0.5 * (pair.s + other.s);
          if (other.s < pair.s)
            low = std::max(low, middle);
          else if (other.s > pair.s)
            high = std::min(high, middle);
        }
    const double s = closest_over(x,
                                  line,
                                  pair.partner,
                                  stretch,
                                  (low - stretch[0]) / length,
                                  (high - stretch[0]) / length);
    return gap_over(x, line.a + s * line.u, pair.partner);
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


  // Those that carried forces in the last step, and places that are inside already. Others join
  // during the step: edges lie in faces at many places, where pairs would only repeat each other.
  void
  FeatureSearch::find_bulges(const View &view,
                             const std::vector<ContactPair> &previous,
                             std::vector<ContactPair> &pairs)
  {
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
            least_gap_over(view.x, line, f, stretch) > view.reach)
          continue;
        for (unsigned int part = 0; part < n_parts; ++part)
          {
            const double s    = closest_over(view.x,
                                          line,
                                          f,
                                          stretch,
                                          double(part) / n_parts,
                                          (part + 1.) / n_parts);
            const Touch touch = touch_over(view.x, line.a + s * line.u, f);
            const Record record{Kind::bulge, feature, f, part, s};
            if (touch.gap > view.reach || touch.gap < -deepest_part * face.depth ||
                sees(record, seen_around * (stretch[1] - stretch[0])))
              continue;
            const auto pair = make_pair(view, record, touch);
            if ((was_loaded(pair, previous) || is_inside(view.x, line, record, stretch)) &&
                !is_behind(pair, previous))
              pairs.push_back(pair);
            else
              records.pop_back();
          }
      }
  }


  bool
  FeatureSearch::was_loaded(const ContactPair &pair, const std::vector<ContactPair> &previous)
  {
    const auto known = find_pair(previous, pair.key());
    return known != previous.end() && known->normal_force > 0.;
  }


  // Whether an edge is deeper in a face at a place than at both ends of what is over the face.
  bool
  FeatureSearch::is_inside(const ContactNodes::Field &x,
                           const Line &line,
                           const Record &place,
                           const std::array<double, 2> &stretch) const
  {
    constexpr double least = 4e-10; // of the face's size

    const auto gap = [&](const double s) {
      return gap_over(x, line.a + s * line.u, place.partner);
    };
    return gap(place.s) < std::min(gap(stretch[0]), gap(stretch[1])) -
                            least * surface.get_faces()[place.partner].size;
  }


  // Whether there is a pair of the same edge and face no further from a place than a part of the
  // edge.
  bool
  FeatureSearch::sees(const Record &place, const double distance) const
  {
    return std::any_of(records.begin(), records.end(), [&](const Record &record) {
      return record.is_beside(place) && std::abs(record.s - place.s) < distance;
    });
  }


  // The least gap at the ends of what is of an edge over a face, where corners and crossings have
  // pairs: what is no deeper needs no other.
  double
  FeatureSearch::gap_at_ends(const ContactNodes::Field &x,
                             const Line &line,
                             const Record &place,
                             const std::array<double, 2> &stretch) const
  {
    const auto &edges = surface.get_faces()[place.partner].edges;
    double least      = 0.;
    const auto see    = [&](const double s) {
      least = std::min(least,
                       gap_over(x,
                                line.a + std::clamp(s, stretch[0], stretch[1]) * line.u,
                                place.partner));
    };
    for (const Record &record : records)
      if (record.kind == Kind::corner)
        {
          for (const unsigned int end : {0U, 1U})
            if (features.vertices[record.feature].place == features.edges[place.feature].ends[end])
              see(end);
        }
      else if (record.kind == Kind::crossing && record.feature == place.feature &&
               std::find(edges.begin(), edges.end(), record.partner) != edges.end())
        see(record.s);
    return least;
  }


  bool
  FeatureSearch::join_bulges(const View &view,
                             const View &reached,
                             const Pose &pose,
                             const double tolerance,
                             const bool may_move,
                             std::vector<ContactPair> &pairs,
                             std::vector<ContactPair> &joining)
  {
    bool any = false;
    for (const auto &[feature, f] : near_edges)
      {
        const Line line     = line_of(pose, feature);
        const double unseen = tolerance * surface.get_faces()[f].size;
        std::array<double, 2> stretch;
        if (!line.may_touch(unit_normal(surface.segment(reached.x, f))) ||
            !stretch_over(reached.x, line, f, stretch) ||
            least_gap_over(reached.x, line, f, stretch) >= -unseen)
          continue;
        Record place{Kind::bulge, feature, f, 0, closest_over(reached.x, line, f, stretch, 0., 1.)};
        const double length = stretch[1] - stretch[0];
        const double gap    = gap_over(reached.x, line.a + place.s * line.u, f);
        if (gap >= -unseen || sees(place, seen_around * length) ||
            gap >= std::max(-unseen, gap_at_ends(reached.x, line, place, stretch)) - unseen)
          continue;
        place.part = std::min(n_parts - 1,
                              static_cast<unsigned int>(n_parts * (place.s - stretch[0]) / length));
        any        = add_bulge(view, reached, place, gap, unseen, may_move, pairs, joining) || any;
      }
    return any;
  }


  // A pair for a place where an edge will have a gap, and in which it is not yet. Where there is
  // one of the same edge and face it moves there.
  bool
  FeatureSearch::add_bulge(const View &view,
                           const View &reached,
                           Record place,
                           const double gap,
                           const double unseen,
                           const bool may_move,
                           std::vector<ContactPair> &pairs,
                           std::vector<ContactPair> &joining)
  {
    const double size = surface.get_faces()[place.partner].size;
    const Line before = line_of(body.pose(), place.feature);
    const Touch touch = touch_over(view.x, before.a + place.s * before.u, place.partner);
    if (gap >= touch.gap - unseen || touch.gap < -barely_inside * size)
      return false;
    const auto is_beside = [&](const Record &record) { return record.is_beside(place); };
    const auto known     = std::find_if(records.begin(), records.end(), is_beside);
    const bool moves = may_move && std::count_if(records.begin(), records.end(), is_beside) == 1;
    const unsigned int row = known - records.begin();
    if (moves)
      place.part = known->part;
    else
      while (std::any_of(records.begin(), records.end(), [&](const Record &record) {
        return record.is_beside(place) && record.part == place.part;
      }))
        place.part += n_parts;
    auto pair      = make_pair(view, place, touch);
    pair.curvature = gap - pair.gap - pair.normal * pair.relative(reached.dx);
    if (!moves)
      {
        joining.push_back(pair);
        return true;
      }
    records[row] = place;
    records.pop_back();
    pair.row              = row;
    const auto old        = find_pair(pairs, pair.key());
    pair.depth            = old->depth;
    pair.normal_force     = old->normal_force;
    pair.tangential_force = pair.tangential_part(old->tangential_force);
    *old                  = pair;
    return true;
  }
} // namespace akmon
