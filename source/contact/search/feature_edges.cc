#include <akmon/contact/search/face_geometry.h>
#include <akmon/contact/search/feature_search.h>

#include <algorithm>
#include <cmath>

// Pairs of sharp edges of rigid bodies with edges between faces.

namespace akmon
{
  using namespace dealii;

  namespace
  {
    constexpr double nearly_along = 0.34; // the same: below, the normal of both is hardly known
    constexpr double normals_off  = 0.35; // radians: of a touching edge from those of the surface
    constexpr double body_off     = 0.1;  // sine: the same from those of the body
    constexpr double end_rounding = 1e-9; // of an edge: no further beyond its end is at it


    // The normals a surface takes at an edge: those within an angle of their mean.
    struct NormalFan
    {
      Tensor<1, 3> mean;
      double half_angle; ///< radians; negative in valleys
    };


    // Behind the rim of a surface its body is taken to turn by a right angle.
    NormalFan
    fan_of(const FeatureSurface &surface,
           const ContactNodes::Field &x,
           const unsigned int e,
           const Tensor<1, 3> &along)
    {
      const auto &edge  = surface.get_edges()[e];
      const auto first  = surface.segment(x, edge.faces[0]);
      const auto n      = unit_normal(first);
      const auto inward = middle_of(first) - x[edge.nodes[0]];
      auto second       = cross_product_3d(along, n);
      if (second * inward > 0.)
        second *= -1.;
      double side = -1.;
      if (edge.n_faces == 2)
        {
          const auto other = surface.segment(x, edge.faces[1]);
          second           = unit_normal(other);
          side             = (middle_of(other) - x[edge.nodes[0]]) * n;
        }
      auto mean = n + second;
      mean -= (mean * along) * along;
      const double angle = std::acos(std::clamp(n * second, -1., 1.));
      return {mean / mean.norm(), side < 0. ? 0.5 * angle : -0.5 * angle};
    }
  } // namespace


  // Whether an edge of the body, and not one of its faces beside it, may touch what has a normal.
  bool
  FeatureSearch::Line::may_touch(const Tensor<1, 3> &normal) const
  {
    const auto along  = u / u.norm();
    auto n            = (normal * along) * along - normal;
    const double size = n.norm();
    if (!(size > 0.))
      return false;
    n /= size;
    auto axis = cross_product_3d(normals[0], normals[1]);
    axis /= axis.norm();
    return n * (normals[0] + normals[1]) > 0. &&
           cross_product_3d(normals[0], n) * axis >= -body_off &&
           cross_product_3d(n, normals[1]) * axis >= -body_off;
  }


  // The normal of both edges, given as either of its directions, if it is one that the surface
  // takes at its edge. Edges that are nearly along each other turn it with every small motion: then
  // it is the closest one that the surface takes.
  bool
  FeatureSearch::choose_normal(const ContactNodes::Field &x,
                               const unsigned int edge,
                               const Tensor<1, 3> &v,
                               const double sine,
                               Tensor<1, 3> &normal) const
  {
    const auto along = v / v.norm();
    const auto fan   = fan_of(surface, x, edge, along);
    if (normal * fan.mean < 0.)
      normal *= -1.;
    const double largest = std::max(0., fan.half_angle) + normals_off;
    const double angle = std::atan2(cross_product_3d(fan.mean, normal) * along, fan.mean * normal);
    if (std::abs(angle) <= largest)
      return true;
    if (sine >= nearly_along)
      return false;
    const double closest = std::clamp(angle, -largest, largest);
    normal = std::cos(closest) * fan.mean + std::sin(closest) * cross_product_3d(along, fan.mean);
    return true;
  }


  // The points a + s u and c + t v whose difference is along the normal, without regard to where
  // the edges end.
  bool
  FeatureSearch::cross(const ContactNodes::Field &x,
                       const Line &line,
                       const unsigned int edge,
                       Crossing &crossing) const
  {
    constexpr double least_sine = 0.02; // below, they do not cross

    const auto &nodes = surface.get_edges()[edge].nodes;
    const auto c      = x[nodes[0]];
    const auto &u     = line.u;
    const auto v = x[nodes[1]] - c, w = c - line.a, both = cross_product_3d(u, v);
    crossing.sine = both.norm() / (u.norm() * v.norm());
    if (!(crossing.sine > least_sine))
      return false;
    crossing.normal = both / both.norm();
    if (!choose_normal(x, edge, v, crossing.sine, crossing.normal) ||
        !line.may_touch(crossing.normal))
      return false;
    const auto v_m = cross_product_3d(v, crossing.normal),
               u_m = cross_product_3d(u, crossing.normal);
    crossing.s     = (w * v_m) / (u * v_m);
    crossing.t     = -(w * u_m) / (v * u_m);
    crossing.gap   = -(w * both) / (crossing.normal * both);
    return true;
  }


  // Beyond an end there is nothing that could be hit.
  double
  FeatureSearch::gap_of(const ContactNodes::Field &x,
                        const Line &line,
                        const unsigned int e,
                        const Crossing &crossing) const
  {
    const auto &nodes = surface.get_edges()[e].nodes;
    const double off  = past_end(crossing.s) * line.u.norm() +
                       past_end(crossing.t) * (x[nodes[1]] - x[nodes[0]]).norm();
    return off > 0. ? std::max(crossing.gap, off) : crossing.gap;
  }


  // Whether edges cross between their ends, or may do so after this step: if they slide on each
  // other as in the last one.
  bool
  FeatureSearch::is_on(const View &view,
                       const Line &line,
                       const unsigned int e,
                       const Crossing &crossing) const
  {
    constexpr double steps = 2.;

    const auto &edge    = surface.get_edges()[e];
    const double t      = crossing.t;
    const double past_s = past_end(crossing.s), past_t = past_end(t);
    if (past_s <= end_rounding && past_t <= end_rounding)
      return true;
    if (crossing.gap < -barely_inside * surface.get_faces()[edge.faces[0]].size)
      return false;
    const auto q = (1. - t) * view.x[edge.nodes[0]] + t * view.x[edge.nodes[1]];
    auto slip    = -(1. - t) * view.dx[edge.nodes[0]] - t * view.dx[edge.nodes[1]];
    if (body.moves())
      slip += view.dx[view.first_rigid] +
              cross_product_3d(view.dx[view.first_rigid + 1], q - body.centre());
    slip -= (slip * crossing.normal) * crossing.normal;
    const double way = steps * slip.norm() / crossing.sine;
    return past_s * line.u.norm() <= way &&
           past_t * (view.x[edge.nodes[1]] - view.x[edge.nodes[0]]).norm() <= way;
  }


  std::vector<FeatureSearch::Line>
  FeatureSearch::lines_now() const
  {
    const Pose pose = body.pose();
    std::vector<Line> lines;
    lines.reserve(features.edges.size());
    for (unsigned int i = 0; i < features.edges.size(); ++i)
      lines.push_back(line_of(pose, i));
    return lines;
  }


  // Whether an edge of the body is past the surface and was no pair before: then it is outside of
  // another side of the deformable body, seen through it.
  bool
  FeatureSearch::is_behind(const ContactPair &pair, const std::vector<ContactPair> &previous)
  {
    return pair.gap < -barely_inside * pair.size &&
           find_pair(previous, pair.key()) == previous.end();
  }


  void
  FeatureSearch::find_crossings(const View &view,
                                const std::vector<ContactPair> &previous,
                                std::vector<ContactPair> &pairs)
  {
    const auto lines = lines_now();
    for (const auto &[feature, e] : edges_of_edges)
      {
        const auto &edge = surface.get_edges()[e];
        const auto &face = surface.get_faces()[edge.faces[0]];
        const Line &line = lines[feature];
        const auto c = view.x[edge.nodes[0]], d = view.x[edge.nodes[1]];
        if (line.distance(0.5 * (c + d)) >
            0.5 * (d - c).norm() + std::max(view.reach, deepest_part * face.depth))
          continue;
        Crossing crossing;
        if (!cross(view.x, line, e, crossing) || crossing.gap > view.reach ||
            crossing.gap < -deepest_part * face.depth || !is_on(view, line, e, crossing))
          continue;
        // Beyond an end nothing is inside.
        const bool past = std::max(past_end(crossing.s), past_end(crossing.t)) > end_rounding;
        const auto pair = make_pair(view,
                                    {Kind::crossing, feature, e, 0, crossing.s},
                                    {{{edge.nodes[0], 1. - crossing.t},
                                      {edge.nodes[1], crossing.t}},
                                     crossing.normal,
                                     past ? std::max(0., crossing.gap) : crossing.gap});
        if (!is_behind(pair, previous))
          pairs.push_back(pair);
        else
          records.pop_back();
      }
  }
} // namespace akmon
