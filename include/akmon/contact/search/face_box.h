#pragma once

#include <akmon/simd.h>

#include <array>
#include <cmath>

namespace akmon
{
  /**
   * A box around a segment, along its edges and its normal.
   * @tparam N  double, or Lanes: of several segments side by side
   */
  template <typename N>
  struct FaceBox
  {
    using Vector = std::array<N, 3>;

    Vector middle;                 ///< mean of the corners; length
    N area;                        ///< of the area vector; length^2
    std::array<Vector, 3> edges;   ///< unit vectors, the last is the segment's normal
    std::array<N, 3> half_lengths; ///< of the edges, around the middle; length

    FaceBox() = default;

    explicit FaceBox(const std::array<Vector, 4> &corners);

    /// The boxes in the first lanes, one by one.
    void
    split(const unsigned int n, FaceBox<double> *boxes) const;

    /// How far the box ends before a point in one of its directions.
    N
    beyond(const Vector &from_middle, const unsigned int d) const
    {
      const N length = magnitude(dot(edges[d], from_middle)) - half_lengths[d];
      return 0.5 * (length + magnitude(length)); // no less than zero, without a branch
    }

    /// No point of the segment is closer to a point.
    N
    bound_of_distance(const Vector &point) const
    {
      return square_root(bound_of_square(point));
    }

    /// The same squared.
    N
    bound_of_square(const Vector &point) const
    {
      const Vector from_middle = difference(point, middle);
      const Vector outside{
        {beyond(from_middle, 0), beyond(from_middle, 1), beyond(from_middle, 2)}};
      return dot(outside, outside);
    }

    static N
    magnitude(const N &a)
    {
      using std::abs;
      return abs(a);
    }

    static N
    dot(const Vector &a, const Vector &b)
    {
      return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }

    static Vector
    difference(const Vector &a, const Vector &b)
    {
      return {{a[0] - b[0], a[1] - b[1], a[2] - b[2]}};
    }

    static Vector
    cross(const Vector &a, const Vector &b)
    {
      return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
    }

    static Vector
    product(const N &factor, const Vector &a)
    {
      return {{factor * a[0], factor * a[1], factor * a[2]}};
    }
  };


  template <typename N>
  void
  FaceBox<N>::split(const unsigned int n, FaceBox<double> *const boxes) const
  {
    alignas(lane_alignment) double values[n_lanes];
    const auto copy = [&](const N &number, const auto &place) {
      store(number, values);
      for (unsigned int lane = 0; lane < n; ++lane)
        place(boxes[lane]) = values[lane];
    };
    copy(area, [](FaceBox<double> &box) -> double & { return box.area; });
    for (unsigned int d = 0; d < 3; ++d)
      {
        copy(middle[d], [d](FaceBox<double> &box) -> double & { return box.middle[d]; });
        copy(half_lengths[d],
             [d](FaceBox<double> &box) -> double & { return box.half_lengths[d]; });
        for (unsigned int i = 0; i < 3; ++i)
          copy(edges[d][i], [d, i](FaceBox<double> &box) -> double & { return box.edges[d][i]; });
      }
  }


  // The segment is in the convex hull of its corners, and that in the box.
  template <typename N>
  FaceBox<N>::FaceBox(const std::array<Vector, 4> &corners)
  {
    constexpr double for_rounding = 1e-3;

    const auto &[a, b, c, d] = corners;
    const Vector diagonal = difference(c, a), other_diagonal = difference(d, b);
    for (unsigned int i = 0; i < 3; ++i)
      middle[i] = 0.25 * (a[i] + b[i] + c[i] + d[i]);
    const Vector normal = product(0.5, cross(diagonal, other_diagonal));
    area                = square_root(dot(normal, normal));
    edges[2]            = product(1. / area, normal);
    // Along the first edge and the opposite one: (b - a) + (c - d).
    Vector along  = difference(diagonal, other_diagonal);
    along         = difference(along, product(dot(along, edges[2]), edges[2]));
    edges[0]      = product(1. / square_root(dot(along, along)), along);
    edges[1]      = cross(edges[2], edges[0]);
    N half_length = 0.;
    for (unsigned int i = 0; i < 3; ++i)
      {
        half_lengths[i] = 0.;
        for (const Vector &corner : corners)
          half_lengths[i] = maximum(half_lengths[i],
                                    magnitude(dot(edges[i], difference(corner, middle))));
        half_length = maximum(half_length, half_lengths[i]);
      }
    for (N &length : half_lengths)
      length = length + for_rounding * half_length;
  }
} // namespace akmon
