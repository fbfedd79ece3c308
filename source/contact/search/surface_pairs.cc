#include <akmon/contact/search/face_geometry.h>
#include <akmon/contact/search/surface_search.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace akmon
{
  using namespace dealii;

  // The distance of the partner of the last search, which becomes the partner; the largest number
  // there is where it cannot be one any more.
  double
  SurfaceSearch::distance_of_last(const ContactNodes::Field &x,
                                  const unsigned int slave,
                                  Partner &partner) const
  {
    const Memory &memory = memories[slave];
    if (memory.face == numbers::invalid_unsigned_int)
      return std::numeric_limits<double>::max();
    // Its foot was in the step before or does not count: ranks may forget older ones.
    const bool is_fresh = memory.search + 1 == n_searches;
    const auto corners  = segment(x, masters[memory.face]);
    partner.face        = memory.face;
    partner.projection  = project(x[slaves[slave].number],
                                 corners,
                                 near_border,
                                 is_fresh ? memory.foot : std::array<double, 2>());
    return faces_slave(x, slave, corners, partner) ? partner.projection.offset.norm() :
                                                     std::numeric_limits<double>::max();
  }


  // The closest candidate face that faces the slave's surface and is not part of it. The
  // partner of the last search tells how close it is at least, and often that no other face can
  // count; which of equally close faces is taken does not depend on it.
  bool
  SurfaceSearch::closest_face(const ContactNodes::Field &x,
                              const unsigned int slave,
                              const double reach,
                              Partner &partner)
  {
    constexpr double largest = std::numeric_limits<double>::max();

    Memory &memory     = memories[slave];
    memory.refused     = largest;
    const auto point   = x[slaves[slave].number];
    const double bound = distance_of_last(x, slave, partner);
    double best        = largest;
    if (bound < largest && memory.others_clear_of > std::max(bound, reach))
      return true;
    const Projection of_last = partner.projection;
    std::array<double, 2> least_bounds{{largest, largest}}; // of all faces
    unsigned int with_least = numbers::invalid_unsigned_int;
    for (unsigned int i = slaves[slave].first_candidate; i < slaves[slave + 1].first_candidate; ++i)
      {
        const unsigned int f  = candidates[i].face;
        const double at_least = bound_of_distance(i);
        least_bounds[1]       = std::min(least_bounds[1], std::max(at_least, least_bounds[0]));
        if (at_least < least_bounds[0])
          {
            least_bounds[0] = at_least;
            with_least      = f;
          }
        if (f != memory.face && at_least > std::min(bound, best))
          continue;
        const auto corners = segment(x, masters[f]);
        const bool is_own  = fetched[f].body == discretization.body_of_node[slaves[slave].node];
        if (is_own && !looks_at(slave, area_vector(corners)))
          continue;
        const Partner candidate = {f, f == memory.face ? of_last : project(point, corners), {}, 0.};
        const auto &projection  = candidate.projection;
        const double distance   = projection.offset.norm();
        if (distance >= best)
          continue;
        if (!faces_slave(x, slave, corners, candidate) || !lies_on(x, slave, corners, projection) ||
            is_through_body(slave, f, corners, projection))
          {
            if (!is_own)
              memory.refused = std::min(memory.refused, distance);
          }
        else
          {
            best    = distance;
            partner = candidate;
          }
      }
    const bool found       = best < largest;
    memory.others_clear_of = least_bounds[found && partner.face == with_least ? 1 : 0];
    return found;
  }


  bool
  SurfaceSearch::partner_at(const ContactNodes::Field &x,
                            const ContactPair &pair,
                            Partner &partner) const
  {
    const unsigned int slave = pair.row;
    partner.face             = pair.face;
    partner.projection       = project(x[slaves[slave].number],
                                 segment(x, masters[pair.face]),
                                 near_border,
                                 pair.foot);
    if (partner.projection.feature != Projection::Feature::face)
      slide_to_neighbour(x, slave, pair.shares_corner, partner);
    if (!pair.shares_corner)
      return complete(x, slave, partner);
    partner.normal = face_normal(x, partner);
    partner.gap    = partner.normal * partner.projection.offset;
    return true;
  }


  bool
  SurfaceSearch::gap_at(const ContactNodes::Field &x, ContactPair &pair, double &gap) const
  {
    Partner partner;
    const bool found = partner_at(x, pair, partner);
    pair.wanders     = partner.projection.feature != Projection::Feature::face ||
                   partner.face != pair.face;
    gap = partner.gap;
    return found;
  }


  bool
  SurfaceSearch::refit(const ContactNodes::Field &x,
                       const ContactNodes::Field &reached,
                       const ContactNodes::Field &increments,
                       ContactPair &pair) const
  {
    constexpr double smooth = 0.9; // cosine: across a ridge it would be another constraint

    Partner partner;
    if (!partner_at(reached, pair, partner) || partner.normal * pair.normal < smooth)
      return false;
    const double gap = partner.gap;
    take_back(x, pair.row, partner);
    std::vector<ContactPair> fresh;
    add_pair(x, pair.row, partner, fresh);
    ContactPair &next     = fresh.front();
    next.slot             = pair.slot;
    next.shares_corner    = pair.shares_corner;
    next.depth            = pair.depth;
    next.entered          = pair.entered;
    next.wanders          = pair.wanders;
    next.normal_force     = pair.normal_force;
    next.tangential_force = next.tangential_part(pair.tangential_force);
    next.sticks           = pair.sticks;
    next.curvature        = gap - next.gap - next.normal * next.relative(increments);
    pair                  = next;
    return true;
  }


  // The gap before a step along the normal to the place where it leads.
  void
  SurfaceSearch::take_back(const ContactNodes::Field &x,
                           const unsigned int slave,
                           Partner &partner) const
  {
    const auto corners = segment(x, masters[partner.face]);
    auto &projection   = partner.projection;
    projection.offset  = x[slaves[slave].number];
    for (unsigned int k = 0; k < 4; ++k)
      projection.offset -= projection.N[k] * corners[k];
    partner.gap = partner.normal * projection.offset;
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
      if (f == partner.face || !may_be_within(best, point, corners) || !opposes(x, f, slave) ||
          (across_ridges_only && rises_from(corners, foot, normal)))
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


  void
  SurfaceSearch::add_pair(const ContactNodes::Field &x,
                          const unsigned int slave,
                          const Partner &partner,
                          std::vector<ContactPair> &pairs) const
  {
    ContactPair &pair = pairs.emplace_back();
    pair.interface    = interface;
    pair.reversed     = reversed;
    pair.slave        = slaves[slave].node;
    pair.slave_id     = slaves[slave].id;
    pair.search       = number;
    pair.row          = slave;
    pair.face         = partner.face;
    pair.foot         = {{partner.projection.xi, partner.projection.eta}};
    pair.normal       = partner.normal;
    pair.gap          = partner.gap;
    pair.size         = slaves[slave].size;
    pair.stiffness    = std::min(slaves[slave].stiffness, masters[partner.face].stiffness);
    pair.nodes[0]     = slaves[slave].number;
    pair.place        = x[slaves[slave].number];
    pair.weights[0]   = 1.;

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
    for (auto around = pairs_around.begin(); around != pairs_around.end();)
      {
        const unsigned int slave = around->slave;
        double increment = 0., approach = 0.; // the largest of its pairs of bodies
        for (; around != pairs_around.end() && around->slave == slave; ++around)
          {
            const BodyPair &pair = body_pairs[around->pair];
            increment            = std::max(increment, pair.increment);
            approach             = std::max(approach, pair.approach);
          }
        Memory &memory = memories[slave];
        memory.clear_of -= approach;
        memory.others_clear_of -= approach;
        const double reach = std::max(least_reach, steps * increment);
        if (memory.clear_of <= reach)
          looks.push_back({slave, reach});
      }
  }


  void
  SurfaceSearch::find_pairs(const ContactNodes::Field &x,
                            const BodyMotions &motions,
                            const double steps,
                            const double least_reach,
                            std::vector<ContactPair> &pairs)
  {
    ++n_configurations;
    ++n_searches;
    watched.clear();
    advance(motions);
    choose_looks(steps, least_reach);
    choose_near_candidates();
    bound_distances(x);
    looks.erase(std::remove_if(looks.begin(),
                               looks.end(),
                               [&](const Look &look) { return is_still_outside(look); }),
                looks.end());
    for (std::size_t i = 0; i < looks.size(); ++i)
      {
        if (i + prefetched < looks.size())
          __builtin_prefetch(&nodes_of_slave_faces[slaves[looks[i + prefetched].slave].first_face]);
        outwards[looks[i].slave] = slave_normal(x, looks[i].slave);
      }
    for (std::size_t i = 0; i < looks.size(); ++i)
      {
        if (i + prefetched < looks.size())
          prefetch_face(memories[looks[i + prefetched].slave].face);
        if (i + prefetched / 2 < looks.size()) // once the face is there
          prefetch_corners(x, memories[looks[i + prefetched / 2].slave].face);
        find_pairs_of(x, looks[i].slave, looks[i].reach, pairs);
      }
  }


  // Whether a slave that was further outside than the step may lead is so again, by the boxes
  // around the faces alone: no face can have passed it since.
  bool
  SurfaceSearch::is_still_outside(const Look &look)
  {
    const auto &[slave, reach] = look;
    Memory &memory             = memories[slave];
    if (!memory.was_outside || memory.clear_of <= 0.)
      return false;
    double least = std::numeric_limits<double>::max();
    for (unsigned int i = slaves[slave].first_candidate; i < slaves[slave + 1].first_candidate; ++i)
      least = std::min(least, bound_of_distance(i));
    if (least <= reach)
      return false;
    memory.clear_of = memory.others_clear_of = least;
    return true;
  }


  void
  SurfaceSearch::find_pairs_of(const ContactNodes::Field &x,
                               const unsigned int slave,
                               const double reach,
                               std::vector<ContactPair> &pairs)
  {
    Memory &memory     = memories[slave];
    memory.was_outside = false;
    Partner partner;
    if (!closest_face(x, slave, furthest * reach, partner))
      {
        // Faces around a fold may turn towards the slave.
        memory.face     = numbers::invalid_unsigned_int;
        memory.clear_of = std::min(reach + 0.1 * search_radius, memory.refused);
        if (memory.refused <= reach)
          watched.push_back(slave);
        return;
      }
    memory.face           = partner.face;
    memory.search         = n_searches;
    memory.foot           = {{partner.projection.xi, partner.projection.eta}};
    const double distance = partner.projection.offset.norm();
    // Whatever is inside stays under watch.
    const bool outside = partner.projection.offset *
                           area_vector(segment(x, masters[partner.face])) >
                         0.;
    memory.clear_of    = outside ? std::min(distance, memory.refused) : 0.;
    memory.was_outside = outside && memory.clear_of > reach;
    if (memory.was_outside)
      return;
    if ((outside && distance > reach) || !complete(x, slave, partner))
      {
        watched.push_back(slave);
        return;
      }
    const std::size_t first = pairs.size();
    add_pair(x, slave, partner, pairs);
    if (coupled && distance <= reach && memory.others_clear_of <= furthest * reach)
      {
        add_valley_pairs(x, reach, partner, first, pairs);
        add_corner_pairs(x, reach, first, pairs);
        if (is_near_others(slave, reach, partner.face))
          watched.push_back(slave);
      }
  }


  // Whether a slave with a partner may be within reach of a third body.
  bool
  SurfaceSearch::is_near_others(const unsigned int slave,
                                const double reach,
                                const unsigned int partner) const
  {
    const unsigned int own = discretization.body_of_node[slaves[slave].node];
    for (unsigned int i = slaves[slave].first_candidate; i < slaves[slave + 1].first_candidate; ++i)
      if (const unsigned int body = fetched[candidates[i].face].body;
          body != own && body != fetched[partner].body && bound_of_distance(i) <= reach)
        return true;
    return false;
  }
} // namespace akmon
