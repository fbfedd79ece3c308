#pragma once

#include <deal.II/base/tensor.h>

#include <array>
#include <vector>

namespace akmon
{
  /// Sharp convex corners and edges of a rigid shape, in its frame.
  struct SharpFeatures
  {
    struct Vertex
    {
      dealii::Tensor<1, 3> place;   ///< length
      dealii::Tensor<1, 3> outward; ///< unit vector between the normals of the faces
    };

    struct Edge
    {
      std::array<dealii::Tensor<1, 3>, 2> ends;    ///< length
      std::array<dealii::Tensor<1, 3>, 2> normals; ///< of the faces that meet there, outward
    };

    std::vector<Vertex> vertices;
    std::vector<Edge> edges;
  };
} // namespace akmon
