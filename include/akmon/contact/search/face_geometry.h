#pragma once

#include <akmon/contact/search/projection.h>
#include <akmon/model/discretization.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
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


  /// Of a segment's area vector.
  inline dealii::Tensor<1, 3>
  unit_normal(const Segment &corners)
  {
    const auto area = area_vector(corners);
    return area / area.norm();
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
