#include <akmon/contact/search/face_geometry.h>
#include <akmon/contact/search/surface_search.h>

#include <algorithm>
#include <limits>

// Slaves that a step leads into a body although they had no partner on it, or have left theirs:
// corners that come over a rim from beside. Once the gaps of a step have settled they get pairs
// with the faces they come through (the exchange method of semi-infinite programming, Hettich and
// Kortanek, SIAM Review 35, 1993).

namespace akmon
{
  using namespace dealii;

  namespace
  {
    constexpr double least_depth = 1e-7; // of the cell size: no deeper needs a pair
  }                                      // namespace


  // The closest face that a slave is inside of where a step leads. Of several that which it was in
  // front of before: there it has come through.
  bool
  SurfaceSearch::entered_face(const ContactNodes::Field &reached,
                              const unsigned int slave,
                              Partner &partner) const
  {
    const auto point = reached[slaves[slave].number];
    double closest   = std::numeric_limits<double>::max();
    for (unsigned int i = slaves[slave].first_candidate; i < slaves[slave + 1].first_candidate; ++i)
      {
        const unsigned int f = candidates[i].face;
        const auto corners   = segment(reached, masters[f]);
        if (!may_be_within(std::min(closest, search_radius), point, corners))
          continue;
        const Partner candidate = {f, project(point, corners), {}, 0.};
        const auto &projection  = candidate.projection;
        if (projection.offset.norm() < closest && faces_slave(reached, slave, corners, candidate) &&
            lies_on(reached, slave, corners, projection) &&
            !is_through_body(slave, f, corners, projection))
          {
            closest = projection.offset.norm();
            partner = candidate;
          }
      }
    return closest < std::numeric_limits<double>::max() && complete(reached, slave, partner) &&
           partner.gap < -least_depth * slaves[slave].size;
  }


  // Where there is a face that the slave was in front of and is behind now, at most as deep as it
  // has moved, that is where it has come through.
  void
  SurfaceSearch::trace_back(const ContactNodes::Field &x,
                            const ContactNodes::Field &reached,
                            const unsigned int slave,
                            Partner &partner) const
  {
    const auto after = reached[slaves[slave].number];
    double least     = std::numeric_limits<double>::max();
    for (unsigned int i = slaves[slave].first_candidate; i < slaves[slave + 1].first_candidate; ++i)
      {
        const unsigned int f = candidates[i].face;
        const auto corners   = segment(reached, masters[f]);
        if (!may_be_within(search_radius, after, corners) ||
            (fetched[f].body == discretization.body_of_node[slaves[slave].node] &&
             !opposes(reached, f, slave)))
          continue;
        Partner other;
        other.face         = f;
        other.projection   = project(after, corners);
        other.normal       = face_normal(reached, other);
        other.gap          = other.normal * other.projection.offset;
        const double aside = (other.projection.offset - other.gap * other.normal).norm();
        Partner was        = other;
        was.normal         = face_normal(x, other);
        take_back(x, slave, was);
        if (other.gap < 0. && -other.gap < std::min(least, deepest_inside(slave, f)) &&
            aside <= contact.rim_tolerance * slaves[slave].size &&
            was.gap >= -barely_inside * slaves[slave].size &&
            !is_through_body(slave, f, corners, other.projection))
          {
            least   = -other.gap;
            partner = other;
          }
      }
  }


  void
  SurfaceSearch::join_entering(const ContactNodes::Field &x,
                               const ContactNodes::Field &reached,
                               const ContactNodes::Field &increments,
                               const std::vector<ContactPair> &pairs,
                               std::vector<ContactPair> &joining) const
  {
    const auto join = [&](const unsigned int slave) {
      Partner partner;
      if (!entered_face(reached, slave, partner))
        return;
      trace_back(x, reached, slave, partner);
      const double gap = partner.gap;
      take_back(x, slave, partner);
      add_pair(x, slave, partner, joining);
      ContactPair &pair  = joining.back();
      pair.entered       = true;
      pair.shares_corner = partner.projection.feature == Projection::Feature::face;
      pair.curvature     = gap - pair.gap - pair.normal * pair.relative(increments);
      for (auto same = find_pair(pairs, pair.key()); same != pairs.end();
           same      = find_pair(pairs, pair.key()))
        {
               if (same->face == pair.face && same->shares_corner == pair.shares_corner)
            {
                   joining.pop_back();
                   return;
            }
          ++pair.slot;
        }
    };
    std::vector<unsigned int> entering = watched;
    for (const auto &pair : pairs)
      if (pair.may_enter() && pair.search == number)
        entering.push_back(pair.row);
    std::sort(entering.begin(), entering.end());
    entering.erase(std::unique(entering.begin(), entering.end()), entering.end());
    std::for_each(entering.begin(), entering.end(), join);
  }
} // namespace akmon
