#include <akmon/contact/search/face_geometry.h>
#include <akmon/contact/search/surface_search.h>

#include <algorithm>
#include <tuple>

// Further partners of a slave: where the master surface is concave one face is not enough.

namespace akmon
{
  using namespace dealii;

  namespace
  {
    constexpr double in_front = -1e-6; // of the cell size, for rounding: else there is no corner


    // The last pair is of the same slave as the first one: such pairs stand together.
    void
    share_corner(const std::size_t first, std::vector<ContactPair> &pairs)
    {
      pairs.back().slot          = pairs.size() - 1 - first;
      pairs.back().shares_corner = true;
      pairs[first].shares_corner = true;
    }
  } // namespace


  // The faces beside a slave's partner, with the normal at its foot, that rise from it and are
  // within reach: candidates all. In the order of the first nodes they share, for the order of the
  // pairs.
  void
  SurfaceSearch::find_valley(const ContactNodes::Field &x,
                             const unsigned int slave,
                             const double reach,
                             const Partner &partner,
                             const Tensor<1, 3> &normal)
  {
    valley.clear();
    const auto &nodes = masters[partner.face].nodes;
    const auto foot   = x[slaves[slave].number] - partner.projection.offset;
    for (unsigned int i = slaves[slave].first_candidate; i < slaves[slave + 1].first_candidate; ++i)
      {
        const unsigned int f = candidates[i].face;
        if (f == partner.face || bound_of_distance(i) > furthest * reach)
          continue;
        const auto &others = masters[f].nodes;
        const auto shared  = std::find_first_of(nodes.begin(),
                                               nodes.end(),
                                               others.begin(),
                                               others.end());
        if (shared != nodes.end() && rises_from(segment(x, others), foot, normal) &&
            opposes(x, f, slave))
          valley.push_back({static_cast<unsigned int>(shared - nodes.begin()), f});
      }
    std::sort(valley.begin(), valley.end(), [](const auto &a, const auto &b) {
      return std::tie(a.shared, a.number) < std::tie(b.shared, b.number);
    });
    // What rises from the face at 30 degrees is half as far as the edge.
    if (!valley.empty() && distance_to_border(foot, segment(x, nodes)) > 2.1 * reach)
      valley.clear();
  }


  // The neighbours across the edges of a valley that the slave may cross in the step: it must stay
  // before both faces, whose normals differ. The gap to the closest point alone, along the normal
  // of the face it leaves, would be found wrong by the solution only, and friction drags the slave
  // further the more that normal pushes it. @param first  number of the slave's first pair
  void
  SurfaceSearch::add_valley_pairs(const ContactNodes::Field &x,
                                  const double reach,
                                  Partner partner,
                                  const std::size_t first,
                                  std::vector<ContactPair> &pairs)
  {
    constexpr double part = 0.25; // of the reach: what slaves slide in a step at most

    if (contact.gap_model != SurfaceContact::GapModel::point_to_segment)
      return;
    const unsigned int slave = pairs[first].row;
    const auto normal        = face_normal(x, partner);
    find_valley(x, slave, reach, partner, normal);
    for (const ValleyFace &face : valley)
      {
        Partner neighbour;
        neighbour.face       = face.number;
        neighbour.projection = project(x[slaves[slave].number], segment(x, masters[face.number]));
        neighbour.normal     = face_normal(x, neighbour);
        neighbour.gap        = neighbour.normal * neighbour.projection.offset;
        const auto beside    = neighbour.projection.offset - neighbour.gap * neighbour.normal;
        if (neighbour.gap <= reach && neighbour.gap >= in_front * slaves[slave].size &&
            beside.norm() <= part * reach)
          {
            add_pair(x, slave, neighbour, pairs);
            share_corner(first, pairs);
          }
      }
    // The mean normal of an edge is none of its faces'. Behind one of these, but in front of the
    // edge, the slave is beside a ridge.
    if (pairs[first].shares_corner && partner.projection.feature != Projection::Feature::face)
      {
        const double gap = normal * partner.projection.offset;
        if (gap < in_front * slaves[slave].size && pairs[first].gap >= 0.)
          {
            pairs[first].shares_corner = false;
            return;
          }
        partner.normal = normal;
        partner.gap    = gap;
        add_pair(x, slave, partner, pairs);
        pairs[first] = pairs.back();
        pairs.pop_back();
        pairs[first].shares_corner = true;
      }
  }


  // Further faces of a corner that the slave may run into: turned against its last partner so far,
  // with the slave in front of them. Behind the face on the other side of a ridge it is outside.
  void
  SurfaceSearch::add_corner_pairs(const ContactNodes::Field &x,
                                  const double reach,
                                  const std::size_t first,
                                  std::vector<ContactPair> &pairs)
  {
    constexpr double turned = 0.5; // cosine

    const std::size_t last   = pairs.size() - 1;
    const unsigned int slave = pairs[first].row;
    const auto point         = x[slaves[slave].number];
    for (unsigned int i = slaves[slave].first_candidate; i < slaves[slave + 1].first_candidate; ++i)
      {
        if (bound_of_distance(i) > reach || !opposes(x, candidates[i].face, slave))
          continue;
        Partner partner;
        partner.face         = candidates[i].face;
        partner.normal       = unit_normal(segment(x, masters[partner.face]));
        const auto is_turned = [&](const ContactPair &other) {
          return partner.normal * other.normal < turned;
        };
        if (!std::all_of(pairs.begin() + last, pairs.end(), is_turned))
          continue;
        const auto corners = segment(x, masters[partner.face]);
        partner.projection = project(point, corners);
        if (partner.projection.offset.norm() <= reach &&
            lies_on(x, slave, corners, partner.projection) && complete(x, slave, partner) &&
            std::all_of(pairs.begin() + last, pairs.end(), is_turned) &&
            partner.gap >= in_front * slaves[slave].size)
          {
            add_pair(x, slave, partner, pairs);
            share_corner(first, pairs);
          }
      }
  }
} // namespace akmon
