#include <akmon/contact/search/edge_over_face.h>
#include <akmon/contact/search/edge_search.h>
#include <akmon/contact/search/edge_wedge.h>
#include <akmon/contact/search/face_geometry.h>

#include <deal.II/base/bounding_box.h>
#include <deal.II/numerics/rtree.h>

#include <boost/iterator/function_output_iterator.hpp>

#include <algorithm>
#include <cmath>

// Pairs of edges with the inside of narrow faces that dip over them, and with smooth edges of such
// faces. They join during a step, and stay while they carry forces.

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // Slots: kinds, and a multiple of their number for further pairs of an edge and a face.
    constexpr unsigned int of_slave_edge = 1, of_slave_face = 2, of_smooth_edge = 3, n_kinds = 4;

    // Of the cell size: what may be deeper than pairs tell. With less there are more pairs where
    // faces lie flat on edges, which nearly repeat each other.
    constexpr double unseen = 1e-7;

    // Of the cell size: deeper ones are no dips, but have been behind the surface before.
    constexpr double inside = 1e-4;

    // Of the edge, on both sides of a pair with a face: where it looks for the least gap.
    constexpr double around = 0.25;


    // Whether boxes along the axes around some points are no further apart than a distance.
    template <std::size_t n, std::size_t m>
    bool
    are_within(const double distance,
               const std::array<Tensor<1, 3>, n> &a,
               const std::array<Tensor<1, 3>, m> &b)
    {
      const auto range = [](const auto &points, const unsigned int d) {
        double low = points[0][d], high = points[0][d];
        for (const auto &point : points)
          {
            low  = std::min(low, point[d]);
            high = std::max(high, point[d]);
          }
        return std::make_pair(low, high);
      };
      for (unsigned int d = 0; d < 3; ++d)
        {
          const auto [low_a, high_a] = range(a, d);
          const auto [low_b, high_b] = range(b, d);
          if (std::max(low_a - high_b, low_b - high_a) > distance)
            return false;
        }
      return true;
    }


    std::array<Tensor<1, 3>, 2>
    ends_of(const ContactNodes::Field &x, const FeatureEdge &edge)
    {
      return {{x[edge.nodes[0]], x[edge.nodes[1]]}};
    }


    StraightEdge
    straight(const ContactNodes::Field &x, const FeatureEdge &edge)
    {
      return {x[edge.nodes[0]], x[edge.nodes[1]] - x[edge.nodes[0]]};
    }


    // The part of the edge at which a pair with a face is.
    double
    part_of(const ContactPair &pair)
    {
      return std::abs(pair.weights[1]);
    }
  } // namespace


  // On a surface that meets itself all edges are slaves once.
  void
  EdgeSearch::build_dip_candidates(const ContactNodes &nodes,
                                   const ContactNodes::Field &x,
                                   const double radius)
  {
    faces_of_masters = faces_of(nodes, masters);
    faces_of_slaves  = one_surface ? std::vector<EdgeFace>() : faces_of(nodes, slaves);
    for (const bool of_master : {false, true})
      {
        const auto &edges = of_master ? masters : slaves;
        const auto &faces = of_master ? faces_of_slaves : faces_of_masters;
        std::vector<std::pair<BoundingBox<3>, unsigned int>> boxes;
        for (unsigned int f = 0; f < faces.size(); ++f)
          if (!of_master || faces[f].local != numbers::invalid_unsigned_int)
            {
              const auto corners = faces[f].segment(x);
              BoundingBox<3> box(std::vector<Point<3>>(corners.begin(), corners.end()));
              box.extend(radius);
              boxes.emplace_back(box, f);
            }
        const auto tree = pack_rtree(boxes);
        for (unsigned int i = 0; i < edges.size(); ++i)
          {
            const auto ends = ends_of(x, edges[i]);
            const BoundingBox<3> box(std::vector<Point<3>>(ends.begin(), ends.end()));
            const std::size_t first = dip_candidates.size();
            tree.query(boost::geometry::index::intersects(box),
                       boost::make_function_output_iterator([&](const auto &entry) {
                         const auto &ids = faces[entry.second].ids;
                         if (std::find_first_of(ids.begin(),
                                                ids.end(),
                                                edges[i].ids.begin(),
                                                edges[i].ids.end()) == ids.end())
                           dip_candidates.push_back({of_master, i, entry.second});
                       }));
            std::sort(dip_candidates.begin() + first,
                      dip_candidates.end(),
                      [](const Dip &a, const Dip &b) { return a.face < b.face; });
          }
      }
  }


  // What the step may lead to, and pairs that were there and carried forces.
  void
  EdgeSearch::find_dips(const ContactNodes::Field &x,
                        const double reach,
                        const std::vector<ContactPair> &previous,
                        std::vector<ContactPair> &pairs)
  {
    near_lines.clear();
    near_dips.clear();
    for (const auto &line : line_candidates)
      if (are_within(reach, ends_of(x, slaves[line[0]]), ends_of(x, masters[line[1]])))
        near_lines.push_back(line);
    for (const auto &dip : dip_candidates)
      if (are_within(reach, ends_of(x, edge_of(dip)), face_of(dip).segment(x)))
        near_dips.push_back(dip);

    std::vector<ContactPair> known;
    for (const auto &pair : previous)
      if (pair.interface == interface && pair.kind == ContactPair::Kind::dip &&
          pair.normal_force > 0.)
        {
          known.push_back(pair);
          known.back().slot %= n_kinds;
        }
    if (known.empty())
      return;
    std::sort(known.begin(), known.end(), by_key);
    for (const auto &[slave, master] : near_lines)
      {
        EdgeCrossing crossing;
        if (!cross(x, slaves[slave], masters[master], crossing) ||
            !are_opposed(x, slaves[slave], masters[master], reach, crossing) ||
            past_end(crossing.s) > 0. || past_end(crossing.t) > 0.)
          continue;
        const auto pair = make_line_pair(x, slave, master, crossing);
        if (find_pair(known, pair.key()) != known.end())
          pairs.push_back(pair);
      }
    for (const auto &dip : near_dips)
      {
        double s;
        if (!may_dip(x, dip) || !deepest_place(x, dip, s))
          continue;
        const auto pair = make_dip(x, dip, s);
        if (pair.gap <= reach && find_pair(known, pair.key()) != known.end())
          pairs.push_back(pair);
      }
  }


  // Whether an edge and a face look at each other.
  bool
  EdgeSearch::may_dip(const ContactNodes::Field &x, const Dip &dip) const
  {
    return EdgeWedge(x, edge_of(dip)).takes(-unit_normal(face_of(dip).segment(x)));
  }


  // Where an edge is deepest in a face, or closest to it; false if that is not between the ends of
  // what is over the face. An edge over a bilinear face has one such place at most.
  bool
  EdgeSearch::deepest_place(const ContactNodes::Field &x, const Dip &dip, double &s) const
  {
    const auto corners = face_of(dip).segment(x);
    const auto edge    = straight(x, edge_of(dip));
    std::array<double, 2> stretch;
    if (!stretch_over(edge, corners, stretch))
      return false;
    s = closest_between(edge, corners, stretch[0], stretch[1]);
    return s > stretch[0] && s < stretch[1];
  }


  // Of edges that cross, one of them smooth.
  ContactPair
  EdgeSearch::make_line_pair(const ContactNodes::Field &x,
                             const unsigned int slave,
                             const unsigned int master,
                             const EdgeCrossing &crossing) const
  {
    auto pair = make_pair(x, slave, master, crossing);
    pair.kind = ContactPair::Kind::dip;
    pair.slot = of_smooth_edge;
    return pair;
  }


  ContactPair
  EdgeSearch::make_dip(const ContactNodes::Field &x, const Dip &dip, const double s) const
  {
    const auto &edge   = edge_of(dip);
    const auto &face   = face_of(dip);
    const auto corners = face.segment(x);
    const auto foot    = project(point_on(x, edge, s), corners);
    const auto normal  = segment_normal(corners, foot.xi, foot.eta);
    const auto across  = face.diagonal();
    // The edge's point less the face's, or the other way round where the face is the slave's.
    const double sign = dip.of_master ? -1. : 1.;

    ContactPair pair;
    pair.interface = interface;
    pair.kind      = ContactPair::Kind::dip;
    pair.slave     = dip.of_master ? face.local : edge.first;
    pair.slave_id  = dip.of_master ? across[0] : edge.ids[0];
    pair.others    = dip.of_master ?
                       std::array<ContactNodes::Id, 3>{{across[1], edge.ids[0], edge.ids[1]}} :
                       std::array<ContactNodes::Id, 3>{{edge.ids[1], across[0], across[1]}};
    pair.slot      = dip.of_master ? of_slave_face : of_slave_edge;
    pair.search    = interface;
    pair.row       = dip.edge;
    pair.face      = dip.face;
    pair.n_nodes   = 0;
    pair.add_node(edge.nodes[0], sign * (1. - s));
    pair.add_node(edge.nodes[1], sign * s);
    for (unsigned int k = 0; k < 4; ++k)
      pair.add_node(face.nodes[k], -sign * foot.N[k]);
    pair.normal    = sign * normal;
    pair.gap       = normal * foot.offset;
    pair.size      = edge.size;
    pair.stiffness = edge.stiffness;
    pair.place     = point_on(x, edge, s);

    const auto offset   = sign * foot.offset;
    const double couple = has_friction ? offset.norm() : (offset - pair.gap * pair.normal).norm();
    if (couple > 1e-14 * pair.size)
      set_lever(corners, 2, offset, pair);
    return pair;
  }


  // The least one around the pair's point of the edge: the place moves on in a step.
  bool
  EdgeSearch::dip_gap_at(const ContactNodes::Field &x, const ContactPair &pair, double &gap) const
  {
    const Dip dip{pair.slot % n_kinds == of_slave_face, pair.row, pair.face};
    const auto corners = face_of(dip).segment(x);
    const auto edge    = straight(x, edge_of(dip));
    std::array<double, 2> stretch;
    if (!stretch_over(edge, corners, stretch))
      return false;
    const double s    = part_of(pair);
    const auto within = [&](const double part) { return std::clamp(part, stretch[0], stretch[1]); };
    gap = gap_over(edge.at(closest_between(edge, corners, within(s - around), within(s + around))),
                   corners);
    return true;
  }


  // Whether an edge is in a face deeper than at the ends of what is over it, and how deep where.
  bool
  EdgeSearch::dips(const ContactNodes::Field &x, const Dip &dip, double &s, double &gap) const
  {
    const auto &edge       = edge_of(dip);
    const auto corners     = face_of(dip).segment(x);
    const double tolerance = unseen * edge.size, twist = twist_of(corners);
    if (0.25 * twist <= tolerance)
      return false;
    const auto normal = unit_normal(corners), middle = middle_of(corners);
    const auto line = straight(x, edge);
    std::array<double, 2> stretch;
    if (std::min(normal * (line.at(0.) - middle), normal * (line.at(1.) - middle)) - twist >=
          -tolerance ||
        !stretch_over(line, corners, stretch) || !deepest_place(x, dip, s) || !may_dip(x, dip))
      return false;
    gap = gap_over(line.at(s), corners);
    return gap <
           std::min(
             {0., gap_over(line.at(stretch[0]), corners), gap_over(line.at(stretch[1]), corners)}) -
             tolerance;
  }


  void
  EdgeSearch::join_dips(const ContactNodes::Field &x,
                        const ContactNodes::Field &reached,
                        const ContactNodes::Field &increments,
                        const std::vector<ContactPair> &pairs,
                        std::vector<ContactPair> &joining) const
  {
    join_lines(x, reached, increments, pairs, joining);
    for (const auto &dip : near_dips)
      {
        double s, gap;
        if (!dips(reached, dip, s, gap))
          continue;
        auto pair              = make_dip(x, dip, s);
        const double tolerance = unseen * pair.size;
        if (pair.gap < -inside * pair.size || gap >= pair.gap - tolerance)
          continue;
        bool is_seen = false;
        for (auto known = find_pair(pairs, pair.key()); known != pairs.end();
             known      = find_pair(pairs, pair.key()))
          {
                 is_seen = is_seen || std::abs(part_of(*known) - s) < around;
                 pair.slot += n_kinds;
          }
        if (is_seen)
          continue;
        pair.curvature = gap - pair.gap - pair.normal * pair.relative(increments);
        joining.push_back(pair);
      }
  }


  // Smooth edges: only where they cross others below what pairs tell.
  void
  EdgeSearch::join_lines(const ContactNodes::Field &x,
                         const ContactNodes::Field &reached,
                         const ContactNodes::Field &increments,
                         const std::vector<ContactPair> &pairs,
                         std::vector<ContactPair> &joining) const
  {
    for (const auto &[slave, master] : near_lines)
      {
        const auto &a = slaves[slave], &b = masters[master];
        const double size = std::min(a.size, b.size), tolerance = unseen * size;
        EdgeCrossing crossing;
        if (!cross(reached, a, b, crossing) || past_end(crossing.s) > 0. ||
            past_end(crossing.t) > 0. || !are_opposed(reached, a, b, 0., crossing) ||
            crossing.gap >= -tolerance)
          continue;
        const double gap = crossing.gap;
        // Where they cross before the step; if they do not, as they will.
        if (EdgeCrossing before;
            cross(x, a, b, before) && past_end(before.s) == 0. && past_end(before.t) == 0.)
          {
            const double way = before.normal * crossing.normal > 0. ? 1. : -1.;
            crossing = {before.s, before.t, way * before.normal, way * before.gap, before.sine};
          }
        else
          crossing.gap = crossing.normal *
                         (point_on(x, a, crossing.s) - point_on(x, b, crossing.t));
        if (crossing.gap < -inside * size || gap >= crossing.gap - tolerance)
          continue;
        auto pair = make_line_pair(x, slave, master, crossing);
        if (find_pair(pairs, pair.key()) != pairs.end())
          continue;
        pair.curvature = gap - pair.gap - pair.normal * pair.relative(increments);
        joining.push_back(pair);
      }
  }
} // namespace akmon
