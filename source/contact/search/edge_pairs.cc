#include <akmon/contact/search/edge_search.h>
#include <akmon/contact/search/edge_wedge.h>
#include <akmon/contact/search/face_geometry.h>

#include <algorithm>
#include <cmath>

// Pairs of edges that cross.

namespace akmon
{
  using namespace dealii;

  namespace
  {
    constexpr double least_sine = 0.2;  // between edges, 12 degrees: below, nodes and edges meet
    constexpr double first_sine = 0.22; // the same of new pairs, 13 degrees
    constexpr double steps      = 2.;   // that edges may slide beyond their ends until they meet


    // How far edges that cross do so beyond corners, where there is nothing that could be hit: but
    // for a corner that is in the other body by then.
    double
    past_corners(const ContactNodes::Field &x,
                 const FeatureEdge &slave,
                 const FeatureEdge &master,
                 const double s,
                 const double t)
    {
      const auto past = [&](const FeatureEdge &edge,
                            const double part,
                            const FeatureEdge &other,
                            const double other_part) {
        const unsigned int end = part > 0.5;
        if (!edge.end[end] || past_end(part) == 0.)
          return 0.;
        const auto from_other = x[edge.nodes[end]] - point_on(x, other, other_part);
        return EdgeWedge(x, other).contains(from_other) ?
                 0. :
                 past_end(part) * (x[edge.nodes[1]] - x[edge.nodes[0]]).norm();
      };
      return past(slave, s, master, t) + past(master, t, slave, s);
    }


    // From a part of an edge to the corner of the body where the edge ends, on the same side.
    Tensor<1, 3>
    to_corner(const ContactNodes::Field &x, const FeatureEdge &edge, const double part)
    {
      return x[edge.nodes[part > 0.5]] - point_on(x, edge, part);
    }


    // Whether a crossing is left to the corner of a body that it is beside: to the node there,
    // where that is on a face. Else what rounding leaves of an overlap would stop corners that
    // slide over an edge.
    bool
    is_at_corner(const ContactNodes::Field &x,
                 const FeatureEdge &edge,
                 const double part,
                 const FeatureEdge &other,
                 const EdgeWedge &of_other)
    {
      constexpr double beside = 0.1, rounding = 1e-10; // of the cell size

      if (!edge.end[part > 0.5])
        return false;
      const auto way    = to_corner(x, edge, part);
      const double size = std::min(edge.size, other.size), distance = way.norm();
      return distance <= beside * size &&
             of_other.is_under(way, distance <= barely_inside * size ? distance : rounding * size);
    }


    // Whether corners of both bodies are where their edges cross: their nodes meet, beyond the rims
    // of surfaces too, as far as these hold them.
    bool
    are_at_corners(const ContactNodes::Field &x,
                   const FeatureEdge &slave,
                   const FeatureEdge &master,
                   const EdgeCrossing &crossing,
                   const double rim_tolerance)
    {
      const bool at_rims = slave.n_faces == 1 && master.n_faces == 1;
      const double far   = std::min(slave.size, master.size) *
                         (at_rims ? rim_tolerance : barely_inside);
      const auto is_near = [&](const FeatureEdge &edge, const double part) {
        return edge.end[part > 0.5] && to_corner(x, edge, part).norm() <= far;
      };
      return is_near(slave, crossing.s) && is_near(master, crossing.t);
    }
  } // namespace


  // Without regard to where the edges end. The normal looks out of the master.
  bool
  EdgeSearch::cross(const ContactNodes::Field &x,
                    const FeatureEdge &slave,
                    const FeatureEdge &master,
                    EdgeCrossing &crossing) const
  {
    const auto a = x[slave.nodes[0]], b = x[master.nodes[0]];
    const auto u = x[slave.nodes[1]] - a, v = x[master.nodes[1]] - b, w = b - a;
    const auto both   = cross_product_3d(u, v);
    const double size = both.norm_square();
    if (!(size > least_sine * least_sine * u.norm_square() * v.norm_square()))
      return false;
    crossing.s      = cross_product_3d(w, v) * both / size;
    crossing.t      = cross_product_3d(w, u) * both / size;
    crossing.normal = both / std::sqrt(size);
    crossing.gap    = -(crossing.normal * w);
    crossing.sine   = std::sqrt(size / (u.norm_square() * v.norm_square()));
    return true;
  }


  // Whether both bodies lie on their sides of the plane between their edges, not too far from each
  // other; turns the normal outward from the master.
  bool
  EdgeSearch::are_opposed(const ContactNodes::Field &x,
                          const FeatureEdge &slave,
                          const FeatureEdge &master,
                          const double reach,
                          EdgeCrossing &crossing) const
  {
    if (std::abs(crossing.gap) >
        std::max(reach, deepest_part * std::min(slave.depth, master.depth)))
      return false;
    const EdgeWedge of_master(x, master), of_slave(x, slave);
    if (!of_master.takes(crossing.normal))
      {
        crossing.normal *= -1.;
        crossing.gap *= -1.;
        if (!of_master.takes(crossing.normal))
          return false;
      }
    return crossing.gap <= reach && of_slave.takes(-crossing.normal) &&
           !are_at_corners(x, slave, master, crossing, rim_tolerance) &&
           !is_at_corner(x, slave, crossing.s, master, of_master) &&
           !is_at_corner(x, master, crossing.t, slave, of_slave);
  }


  // Whether edges meet between their ends, or may do so after this step if they slide on each other
  // as in the last one. Above a node where an edge goes on and turns a little, the crossings with
  // both its parts may be beyond it, by less than the gap.
  bool
  EdgeSearch::are_on(const ContactNodes::Field &x,
                     const ContactNodes::Field &next,
                     const FeatureEdge &slave,
                     const FeatureEdge &master,
                     const EdgeCrossing &crossing)
  {
    if (past_end(crossing.s) == 0. && past_end(crossing.t) == 0.)
      return true;
    if (crossing.gap < -barely_inside * std::min(slave.size, master.size))
      return false;
    const auto moved = [&](const FeatureEdge &edge, const double part) {
      return point_on(next, edge, part) - point_on(x, edge, part);
    };
    auto slip = moved(slave, crossing.s) - moved(master, crossing.t);
    slip -= (slip * crossing.normal) * crossing.normal;
    const auto is_near = [&](const FeatureEdge &edge, const double part) {
      const double way = steps * slip.norm() + (edge.end[part > 0.5] ? 0. : std::abs(crossing.gap));
      return past_end(part) * (x[edge.nodes[1]] - x[edge.nodes[0]]).norm() <= way / crossing.sine;
    };
    return is_near(slave, crossing.s) && is_near(master, crossing.t);
  }


  // Edges meet where they are, or where the last increment, repeated, leads them past each other:
  // then where they would come through.
  bool
  EdgeSearch::meet(const ContactNodes::Field &x,
                   const ContactNodes::Field &next,
                   const FeatureEdge &slave,
                   const FeatureEdge &master,
                   const double reach,
                   EdgeCrossing &crossing) const
  {
    if (cross(x, slave, master, crossing) && are_opposed(x, slave, master, reach, crossing) &&
        are_on(x, next, slave, master, crossing))
      return true;
    if (!cross(next, slave, master, crossing) ||
        !are_opposed(next, slave, master, reach, crossing) || crossing.gap > 0. ||
        past_end(crossing.s) > 0. || past_end(crossing.t) > 0.)
      return false;
    const auto offset = point_on(x, slave, crossing.s) - point_on(x, master, crossing.t);
    crossing.gap      = crossing.normal * offset;
    return crossing.gap >= -barely_inside * std::min(slave.size, master.size) &&
           crossing.gap <= reach;
  }


  bool
  EdgeSearch::gap_at(const ContactNodes::Field &x, const ContactPair &pair, double &gap) const
  {
    if (pair.n_nodes > 4)
      return dip_gap_at(x, pair, gap);
    const FeatureEdge &slave = slaves[pair.row], &master = masters[pair.face];
    EdgeCrossing crossing;
    if (!cross(x, slave, master, crossing))
      return false;
    gap = crossing.normal * pair.normal > 0. ? crossing.gap : -crossing.gap;
    if (const double past = past_corners(x, slave, master, crossing.s, crossing.t); past > 0.)
      gap = std::max(gap, past);
    return true;
  }


  ContactPair
  EdgeSearch::make_pair(const ContactNodes::Field &x,
                        const unsigned int slave,
                        const unsigned int master,
                        const EdgeCrossing &crossing) const
  {
    const auto &a = slaves[slave], &b = masters[master];
    const double s = crossing.s, t = crossing.t;
    ContactPair pair;
    pair.interface = interface;
    pair.kind      = ContactPair::Kind::edges;
    pair.slave     = a.first;
    pair.slave_id  = a.ids[0];
    pair.others    = {{a.ids[1], b.ids[0], b.ids[1]}};
    pair.search    = interface;
    pair.row       = slave;
    pair.face      = master;
    pair.n_nodes   = 4;
    std::copy(a.nodes.begin(), a.nodes.end(), pair.nodes.begin());
    std::copy(b.nodes.begin(), b.nodes.end(), pair.nodes.begin() + 2);
    pair.weights   = {{1. - s, s, t - 1., -t}};
    pair.normal    = crossing.normal;
    pair.gap       = past_corners(x, a, b, s, t) > 0. ? std::max(0., crossing.gap) : crossing.gap;
    pair.size      = std::min(a.size, b.size);
    pair.stiffness = std::min(a.stiffness, b.stiffness);
    pair.place     = point_on(x, a, s);

    const auto offset   = pair.relative(x);
    const double couple = has_friction ? offset.norm() :
                                         (offset - (offset * pair.normal) * pair.normal).norm();
    if (couple > 1e-14 * pair.size)
      {
        // Each edge turns about its own middle: bodies that approach each other do not.
        const auto r_a = 0.5 * (x[a.nodes[1]] - x[a.nodes[0]]),
                   r_b = 0.5 * (x[b.nodes[1]] - x[b.nodes[0]]);
        set_lever({{-r_a, r_a, -r_b, r_b}}, 0, offset, pair);
      }
    return pair;
  }


  void
  EdgeSearch::find_pairs(const ContactNodes::Field &x,
                         const ContactNodes::Field &next,
                         const double reach,
                         const std::vector<ContactPair> &previous,
                         std::vector<ContactPair> &pairs)
  {
    const std::size_t first = pairs.size();
    for (const auto &[slave, master] : candidates)
      {
        EdgeCrossing crossing;
        if (!meet(x, next, slaves[slave], masters[master], reach, crossing))
          continue;
        const auto pair = make_pair(x, slave, master, crossing);
        // Edges that are past each other and were not a pair before are none: a corner stands on a
        // face, beside an edge that another edge of the corner crosses.
        const bool is_new = find_pair(previous, pair.key()) == previous.end();
        if (is_new && (pair.gap < -barely_inside * pair.size || crossing.sine < first_sine))
          continue;
        pairs.push_back(pair);
      }
    const std::size_t n_crossings = pairs.size();
    find_dips(x, reach, previous, pairs);
    if (pairs.size() > n_crossings)
      std::sort(pairs.begin() + first, pairs.end(), by_key);
  }
} // namespace akmon
