#pragma once

#include <akmon/contact/search/projection.h>
#include <akmon/model/discretization.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <vector>

namespace akmon
{
  /// What is further inside belongs to another side of the body: a part of the cell behind.
  inline constexpr double deepest_part = 0.5;

  /// As deep new pairs may overlap by rounding: a part of the cell size.
  inline constexpr double barely_inside = 1e-6;


  /// A boundary face as a segment, its nodes where @p x has them.
  inline Segment
  segment_of(const BoundaryFace &face, const NodalVector &x)
  {
    return {{at_node(x, face.nodes[0]),
             at_node(x, face.nodes[1]),
             at_node(x, face.nodes[2]),
             at_node(x, face.nodes[3])}};
  }


  inline std::array<double, 3>
  components(const dealii::Tensor<1, 3> &vector)
  {
    return {{vector[0], vector[1], vector[2]}};
  }


  /// Of a segment's area vector.
  inline dealii::Tensor<1, 3>
  unit_normal(const Segment &corners)
  {
    const auto area = area_vector(corners);
    return area / area.norm();
  }


  /// Mean of a segment's corners.
  inline dealii::Tensor<1, 3>
  middle_of(const Segment &corners)
  {
    return 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
  }


  /// Distance of the furthest corner of a segment from its middle.
  inline double
  half_width(const Segment &corners)
  {
    const auto middle = middle_of(corners);
    double furthest   = 0.;
    for (const auto &corner : corners)
      furthest = std::max(furthest, (corner - middle).norm());
    return furthest;
  }


  /// How far a part of an edge is beyond its ends, which are 0 and 1.
  inline double
  past_end(const double part)
  {
    return std::max({0., -part, part - 1.});
  }


  /// Length of the shortest edge of a segment.
  inline double
  least_edge(const Segment &corners)
  {
    double least = (corners[0] - corners[3]).norm();
    for (unsigned int k = 0; k < 3; ++k)
      least = std::min(least, (corners[k + 1] - corners[k]).norm());
    return least;
  }


  /// False only if a segment is further from a point than a distance, by the box around it along
  /// the axes.
  inline bool
  may_be_within(const double distance, const dealii::Tensor<1, 3> &point, const Segment &corners)
  {
    constexpr double for_rounding = 1e-3;

    for (unsigned int d = 0; d < 3; ++d)
      {
        const auto [lower, upper] = std::minmax(
          {corners[0][d], corners[1][d], corners[2][d], corners[3][d]});
        const double outside = std::max(lower - point[d], point[d] - upper);
        if (outside > (1. + for_rounding) * distance + for_rounding * (upper - lower))
          return false;
      }
    return true;
  }


  /// Length of the longest diagonal of faces of all ranks (collective); zero if there are none.
  inline double
  largest_diagonal(const std::vector<BoundaryFace> &faces,
                   const NodalVector &x,
                   const MPI_Comm communicator)
  {
    double largest = 0.;
    for (const auto &face : faces)
      {
        const Segment corners = segment_of(face, x);
        for (unsigned int k = 0; k < 2; ++k)
          largest = std::max(largest, (corners[k] - corners[k + 2]).norm());
      }
    return dealii::Utilities::MPI::max(largest, communicator);
  }
} // namespace akmon
