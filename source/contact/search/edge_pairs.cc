#include <akmon/contact/search/edge_search.h>
#include <akmon/contact/search/face_geometry.h>

#include <algorithm>
#include <cmath>

// Pairs of edges that cross.

namespace akmon
{
  using namespace dealii;

  namespace
  {
    constexpr double corner       = 0.1;  // of an edge: so close to a corner nodes meet faces
    constexpr double least_sine   = 0.26; // between edges, 15 degrees: below, nodes and edges meet
    constexpr double first_sine   = 0.34; // the same of new pairs, 20 degrees
    constexpr double first_inside = 0.02; // sine: how far new pairs' normals are off those of faces


    // Whether a part of an edge is on it. A corner that stands on an edge, or slides over it, is a
    // node's pair.
    bool
    is_on(const FeatureEdge &edge, const double part)
    {
      return part >= (edge.end[0] ? corner : 0.) && 1. - part >= (edge.end[1] ? corner : 0.);
    }


    Tensor<1, 3>
    point_on(const ContactNodes::Field &x, const FeatureEdge &edge, const double part)
    {
      return (1. - part) * x[edge.nodes[0]] + part * x[edge.nodes[1]];
    }


    // Whether a normal of an edge is one that the surface takes as it turns about it, and how far
    // off those of the faces on its two sides: sine of the angle. The normal of a face belongs to
    // the nodes on it.
    bool
    in_range(const ContactNodes::Field &x,
             const FeatureEdge &edge,
             const Tensor<1, 3> &normal,
             const double inside = 0.)
    {
      const auto corner = [&](const unsigned int f, const unsigned int k) {
        return x[edge.corners[f][k % 4]];
      };
      unsigned int k = 0; // the edge starts there in the first face
      while (edge.corners[0][k] != edge.nodes[0] && edge.corners[0][k] != edge.nodes[1])
        ++k;
      if (edge.corners[0][(k + 1) % 4] != edge.nodes[0] &&
          edge.corners[0][(k + 1) % 4] != edge.nodes[1])
        k = 3;
      auto along = corner(0, k + 1) - corner(0, k);
      along /= along.norm();
      const auto face_normal = [&](const unsigned int f) {
        const auto area = area_vector({{corner(f, 0), corner(f, 1), corner(f, 2), corner(f, 3)}});
        return area / area.norm();
      };
      const auto first = face_normal(0);
      // Beyond a rim the surface turns as it did initially.
      const auto second = edge.n_faces == 2 ?
                            face_normal(1) :
                            std::cos(edge.angle) * first +
                              std::sin(edge.angle) * cross_product_3d(along, first);
      return normal * (first + second) > 0. && cross_product_3d(first, normal) * along >= inside &&
             cross_product_3d(normal, second) * along >= inside;
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
                          EdgeCrossing &crossing)
  {
    if (std::abs(crossing.gap) >
        std::max(reach, deepest_part * std::min(slave.depth, master.depth)))
      return false;
    if (!in_range(x, master, crossing.normal))
      {
        crossing.normal *= -1.;
        crossing.gap *= -1.;
        if (!in_range(x, master, crossing.normal))
          return false;
      }
    return crossing.gap <= reach && in_range(x, slave, -crossing.normal);
  }


  // Edges meet if their closest points are on both of them; or close beyond a node where the edge
  // goes on, which may be before both parts of a dent; or if the last increment, repeated, leads
  // them there, past each other: then they are where they would come through.
  bool
  EdgeSearch::meet(const ContactNodes::Field &x,
                   const ContactNodes::Field &next,
                   const FeatureEdge &slave,
                   const FeatureEdge &master,
                   const double reach,
                   EdgeCrossing &crossing) const
  {
    if (cross(x, slave, master, crossing))
      {
        const double further = reach / crossing.sine;
        const bool on        = is_on(slave, crossing.s) && is_on(master, crossing.t);
        bool before          = true;
        for (const auto &[edge, part] :
             {std::make_pair(&slave, crossing.s), std::make_pair(&master, crossing.t)})
          {
            const double length = (x[edge->nodes[1]] - x[edge->nodes[0]]).norm();
            for (unsigned int end = 0; end < 2; ++end)
              before = before && (end == 0 ? part : 1. - part) * length >=
                                   (edge->end[end] ? corner * length : -further);
          }
        if (before && are_opposed(x, slave, master, reach, crossing) &&
            (on || crossing.gap >= -barely_inside * std::min(slave.size, master.size)))
          return true;
      }
    if (!cross(next, slave, master, crossing) || !is_on(slave, crossing.s) ||
        !is_on(master, crossing.t) || !are_opposed(next, slave, master, reach, crossing) ||
        crossing.gap > 0.)
      return false;
    const auto offset = point_on(x, slave, crossing.s) - point_on(x, master, crossing.t);
    crossing.gap      = crossing.normal * offset;
    return crossing.gap >= -barely_inside * std::min(slave.size, master.size) &&
           crossing.gap <= reach;
  }


  bool
  EdgeSearch::gap_at(const ContactNodes::Field &x, const ContactPair &pair, double &gap) const
  {
    EdgeCrossing crossing;
    if (!cross(x, slaves[pair.row], masters[pair.face], crossing))
      return false;
    gap = crossing.normal * pair.normal > 0. ? crossing.gap : -crossing.gap;
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
    pair.of_edges  = true;
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
    pair.gap       = crossing.gap;
    pair.size      = std::min(a.size, b.size);
    pair.stiffness = std::min(a.stiffness, b.stiffness);
    pair.place     = point_on(x, a, s);

    const auto offset   = pair.relative(x);
    const double couple = has_friction ? offset.norm() :
                                         (offset - (offset * pair.normal) * pair.normal).norm();
    if (couple > 1e-14 * pair.size)
      set_lever({{x[a.nodes[0]], x[a.nodes[1]], x[b.nodes[0]], x[b.nodes[1]]}}, 0, offset, pair);
    return pair;
  }


  void
  EdgeSearch::find_pairs(const ContactNodes::Field &x,
                         const ContactNodes::Field &next,
                         const double reach,
                         const std::vector<ContactPair> &previous,
                         std::vector<ContactPair> &pairs) const
  {
    for (const auto &[slave, master] : candidates)
      {
        EdgeCrossing crossing;
        if (!meet(x, next, slaves[slave], masters[master], reach, crossing))
          continue;
        const auto pair  = make_pair(x, slave, master, crossing);
        const auto known = std::lower_bound(previous.begin(),
                                            previous.end(),
                                            pair,
                                            [](const ContactPair &a, const ContactPair &b) {
                                              return a.key() < b.key();
                                            });
        // Edges that are past each other and were not a pair before are none: a corner stands on a
        // face, beside an edge that another edge of the corner crosses.
        const bool is_new = known == previous.end() || known->key() != pair.key();
        if (is_new && (pair.gap < -barely_inside * pair.size || crossing.sine < first_sine ||
                       !in_range(x, masters[master], crossing.normal, first_inside) ||
                       !in_range(x, slaves[slave], -crossing.normal, first_inside)))
          continue;
        pairs.push_back(pair);
      }
  }
} // namespace akmon
