#pragma once

#include <akmon/contact/search/projection.h>

#include <deal.II/base/tensor.h>

#include <array>

namespace akmon
{
  /// A straight edge x(s) = a + s u, s from 0 to 1; length.
  struct StraightEdge
  {
    dealii::Tensor<1, 3> a, u;

    dealii::Tensor<1, 3>
    at(const double s) const
    {
      return a + s * u;
    }
  };


  /// The part of an edge, from s[0] to s[1], that is above a face; false if there is none.
  bool
  stretch_over(const StraightEdge &edge, const Segment &corners, std::array<double, 2> &s);

  /// Of a point from its closest one of a face, along the face's normal there; length.
  double
  gap_over(const dealii::Tensor<1, 3> &p, const Segment &corners);

  /// Where an edge over a face that bulges is closest to it: at one of the ends of a part of it, or
  /// where it is parallel to the face. Right if there is one such place at most.
  double
  closest_between(const StraightEdge &edge,
                  const Segment &corners,
                  const double low,
                  const double high);

  /// Length of the vector by which a bilinear face is not a parallelogram: it bulges by a quarter
  /// of this at most.
  inline double
  twist_of(const Segment &corners)
  {
    return (corners[0] - corners[1] + corners[2] - corners[3]).norm();
  }
} // namespace akmon
