#include <akmon/contact/search/surface_search.h>

#include <algorithm>

// Further partners of a slave: where the master surface is concave one face is not enough.

namespace akmon
{
  using namespace dealii;

  namespace
  {
    constexpr double in_front = -1e-6; // of the cell size, for rounding: else there is no corner


    // Pairs of one slave stand together, from the first one on.
    void
    add_to_corner(const std::size_t first, ContactPair pair, std::vector<ContactPair> &pairs)
    {
      pair.slot          = pairs.size() - first;
      pair.shares_corner = true;
      pairs.push_back(pair);
      pairs[first].shares_corner = true;
    }
  } // namespace


  // The neighbours across the edges of a valley that the slave may cross in the step: it must stay
  // before both faces, whose normals differ. The gap to the closest point alone, along the normal
  // of the face it leaves, would be found wrong by the solution only, and friction drags the slave
  // further the more that normal pushes it.
  void
  SurfaceSearch::add_valley_pairs(const ContactNodes::Field &x,
                                  const double reach,
                                  Partner partner,
                                  std::vector<ContactPair> &pairs)
  {
    constexpr double part = 0.25; // of the reach: what slaves slide in a step at most

    if (contact.gap_model != SurfaceContact::GapModel::point_to_segment)
      return;
    const std::size_t first  = pairs.size() - 1;
    const unsigned int slave = pairs[first].row, first_face = partner.face;
    const auto point  = x[slaves[slave].number];
    const auto foot   = point - partner.projection.offset;
    const auto normal = face_normal(x, partner);
    // What rises from the face at 30 degrees is half as far as the edge.
    if (distance_to_border(foot, segment(x, masters[first_face])) > 2.1 * reach)
      return;
    visit_neighbours(first_face, [&](const unsigned int f) {
      const MasterFace &master = masters[f];
      const FaceShape &shape   = shape_of(x, f);
      if (!shape.rises_from(foot, normal) || shape.bound_of_distance(point) > furthest * reach ||
          !opposes(master, shape, slave))
        return;
      Partner neighbour;
      neighbour.face       = f;
      neighbour.projection = project(point, segment(x, master));
      neighbour.normal     = face_normal(x, neighbour);
      neighbour.gap        = neighbour.normal * neighbour.projection.offset;
      const auto beside    = neighbour.projection.offset - neighbour.gap * neighbour.normal;
      if (neighbour.gap <= reach && neighbour.gap >= in_front * slaves[slave].size &&
          beside.norm() <= part * reach)
        add_to_corner(first, make_pair(x, slave, neighbour), pairs);
    });
    // The mean normal of an edge is none of its faces'.
    if (pairs[first].shares_corner && partner.projection.feature != Projection::Feature::face)
      {
        partner.normal             = normal;
        partner.gap                = normal * partner.projection.offset;
        pairs[first]               = make_pair(x, slave, partner);
        pairs[first].shares_corner = true;
      }
  }


  // Further faces of a corner that the slave may run into: turned against the first partner, with
  // the slave in front of them. Behind the face on the other side of a ridge it is outside.
  void
  SurfaceSearch::add_corner_pairs(const ContactNodes::Field &x,
                                  const double reach,
                                  std::vector<ContactPair> &pairs)
  {
    constexpr double turned = 0.5; // cosine

    const std::size_t first  = pairs.size() - 1;
    const unsigned int slave = pairs[first].row;
    const auto point         = x[slaves[slave].number];
    for (unsigned int i = slaves[slave].first_candidate; i < slaves[slave + 1].first_candidate; ++i)
      {
        Partner partner;
        partner.face         = candidates[i];
        const auto &shape    = shape_of(x, partner.face);
        const auto is_turned = [&](const ContactPair &other) {
          return shape.normal * other.normal < turned * shape.area;
        };
        if (shape.bound_of_distance(point) > reach ||
            !opposes(masters[partner.face], shape, slave) ||
            !std::all_of(pairs.begin() + first, pairs.end(), is_turned))
          continue;
        partner.projection = project(point, segment(x, masters[partner.face]));
        if (partner.projection.feature == Projection::Feature::face &&
            partner.projection.offset.norm() <= reach && complete(x, slave, partner) &&
            partner.gap >= in_front * slaves[slave].size)
          add_to_corner(first, make_pair(x, slave, partner), pairs);
      }
  }
} // namespace akmon
