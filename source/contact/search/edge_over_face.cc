#include <akmon/contact/search/edge_over_face.h>
#include <akmon/contact/search/face_geometry.h>

#include <algorithm>
#include <cmath>

namespace akmon
{
  using namespace dealii;

  bool
  stretch_over(const StraightEdge &edge, const Segment &corners, std::array<double, 2> &s)
  {
    constexpr double least = 1e-6; // of the edge

    const auto normal = unit_normal(corners);
    s                 = {{0., 1.}};
    for (unsigned int k = 0; k < 4; ++k)
      {
        const auto inward  = cross_product_3d(normal, corners[(k + 1) % 4] - corners[k]);
        const double begin = (edge.a - corners[k]) * inward, slope = edge.u * inward;
        if (slope > 0.)
          s[0] = std::max(s[0], -begin / slope);
        else if (slope < 0.)
          s[1] = std::min(s[1], -begin / slope);
        else if (begin < 0.)
          return false;
      }
    return s[1] - s[0] > least;
  }


  double
  gap_over(const Tensor<1, 3> &p, const Segment &corners)
  {
    const auto projection = project(p, corners);
    return segment_normal(corners, projection.xi, projection.eta) * projection.offset;
  }


  double
  closest_between(const StraightEdge &edge, const Segment &corners, double low, double high)
  {
    const auto slope = [&](const double s) {
      const auto foot = project(edge.at(s), corners);
      return edge.u * segment_normal(corners, foot.xi, foot.eta);
    };
    double f_low = slope(low), f_high = slope(high);
    if (f_low >= 0.)
      return low;
    if (f_high <= 0.)
      return high;
    // The slope is nearly linear: false position, and halves where that is slow.
    double s = low;
    for (unsigned int i = 0; i < 60 && high - low > 1e-12; ++i)
      {
        s = i % 3 == 2 ? 0.5 * (low + high) : (low * f_high - high * f_low) / (f_high - f_low);
        const double f = slope(s);
        if (std::abs(f) <= 1e-15 * edge.u.norm())
          break;
        (f < 0. ? low : high)     = s;
        (f < 0. ? f_low : f_high) = f;
      }
    return s;
  }
} // namespace akmon
