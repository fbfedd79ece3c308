#include <akmon/contact/bonds/bonds.h>
#include <akmon/contact/lever.h>
#include <akmon/rigid/rotation.h>

#include <algorithm>
#include <cmath>

// How the points of Bonds follow the surfaces: their normals, what they hold, and C.

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // Of the size of a point: what is no more is rounding.
    constexpr double least_offset = 1e-10;

    // Places of the slave's nodes from their centre, by entry of the row. The others' are zero.
    void
    find_arms(const std::vector<std::pair<unsigned int, double>> &row,
              const std::vector<Tensor<1, 3>> &positions,
              std::vector<Tensor<1, 3>> &arms)
    {
      Tensor<1, 3> centre;
      unsigned int n = 0;
      for (const auto &[node, weight] : row)
        if (weight > 0.)
          {
            centre += positions[node];
            ++n;
          }
      centre /= n;
      arms.assign(row.size(), Tensor<1, 3>());
      for (std::size_t k = 0; k < row.size(); ++k)
        if (row[k].second > 0.)
          arms[k] = positions[row[k].first] - centre;
    }
  } // namespace


  // How far the surfaces are apart in the mean over a point.
  Tensor<1, 3>
  Bonds::offset_at(const Point &point, const Values &positions) const
  {
    Tensor<1, 3> sum;
    for (const auto &[node, weight] : point.row)
      sum += weight * positions[node];
    return sum;
  }


  // C u. Of a levered point positions count as increments from x.
  Tensor<1, 3>
  Bonds::relative(const Point &point, const Values &u) const
  {
    Tensor<1, 3> sum = offset_at(point, u);
    if (point.arms.empty())
      return sum;
    Tensor<1, 3> turn;
    for (std::size_t k = 0; k < point.arms.size(); ++k)
      turn += cross_product_3d(point.arms[k], u[point.row[k].first]);
    return sum + point.lever * turn;
  }


  // From the master to the slave.
  void
  Bonds::update_normals(const Values &positions)
  {
    for (const unsigned int i : unbroken)
      {
        auto &point = points[i];
        Tensor<1, 3> outward;
        for (const auto &face : point.faces)
          outward += area_vector(
            {{positions[face[0]], positions[face[1]], positions[face[2]], positions[face[3]]}});
        point.normal = -outward / outward.norm();
      }
  }


  // What is held turns with the slave's surface. The mean rotation of an increment about the places
  // half way is Cayley's vector, of a rigid rotation exactly.
  void
  Bonds::turn_offsets(const Values &positions, const Values &increments)
  {
    Values half_way(nodes.size());
    for (unsigned int i = 0; i < nodes.size(); ++i)
      half_way[i] = positions[i] - 0.5 * increments[i];
    for (const unsigned int i : unbroken)
      {
        auto &point = points[i];
        if (point.offset.norm() <= least_offset * std::sqrt(point.area))
          continue;
        find_arms(point.row, half_way, point.arms);
        Tensor<1, 3> turn;
        for (std::size_t k = 0; k < point.arms.size(); ++k)
          turn += cross_product_3d(point.arms[k], increments[point.row[k].first]);
        point.offset = Orientation::cayley(inverse_inertia(make_array_view(point.arms)) * turn)
                         .matrix() *
                       point.offset;
      }
  }


  // Points that failed at the last level have moved apart since: they hold where they are now,
  // pressed ones along their normal where they were.
  void
  Bonds::follow_slip(const Values &positions)
  {
    for (const unsigned int i : unbroken)
      {
        auto &point = points[i];
        if (point.holds == Holds::all)
          continue;
        Tensor<1, 3> slip = offset_at(point, positions) - point.offset;
        if (point.holds == Holds::normal)
          slip -= (slip * point.normal) * point.normal;
        point.offset += slip;
        point.given = Tensor<1, 3>();
        point.holds = Holds::all;
      }
  }


  // Make C vanish for rigid motions where surfaces are apart: it depends on the positions then.
  void
  Bonds::set_levers(const Values &positions)
  {
    bool changed = false;
    for (const unsigned int i : unbroken)
      {
        auto &point       = points[i];
        const auto offset = offset_at(point, positions);
        changed           = changed || !point.arms.empty();
        point.arms.clear();
        if (offset.norm() <= least_offset * std::sqrt(point.area))
          continue;
        find_arms(point.row, positions, point.arms);
        point.lever = lever_of(offset, inverse_inertia(make_array_view(point.arms)));
        changed     = true;
      }
    if (changed)
      full.valid = reduced.valid = false;
  }
} // namespace akmon
