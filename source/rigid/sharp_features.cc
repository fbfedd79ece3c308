#include <akmon/rigid/rigid_shape.h>
#include <akmon/rigid/triangle_shape.h>

#include <cmath>
#include <map>

// The sharp corners and edges of shapes.

namespace akmon
{
  using dealii::Tensor;

  SharpFeatures
  RigidShape::sharp_features() const
  {
    return {};
  }


  SharpFeatures
  BlockShape::sharp_features() const
  {
    SharpFeatures features;
    if (edge > 0.)
      return features;
    const auto side = [](const unsigned int corner, const unsigned int d) {
      return (corner >> d) & 1 ? 1. : -1.;
    };
    const auto place = [&](const unsigned int corner) {
      return Tensor<1, 3>(
        {side(corner, 0) * half[0], side(corner, 1) * half[1], side(corner, 2) * half[2]});
    };
    for (unsigned int i = 0; i < 8; ++i)
      features.vertices.push_back(
        {place(i), Tensor<1, 3>({side(i, 0), side(i, 1), side(i, 2)}) / std::sqrt(3.)});
    for (unsigned int d = 0; d < 3; ++d)
      for (unsigned int i = 0; i < 8; ++i)
        if (((i >> d) & 1) == 0)
          {
            SharpFeatures::Edge line{{{place(i), place(i | (1u << d))}}, {}};
            line.normals[0][(d + 1) % 3] = side(i, (d + 1) % 3);
            line.normals[1][(d + 2) % 3] = side(i, (d + 2) % 3);
            features.edges.push_back(line);
          }
    return features;
  }


  // Corners are the ends of sharp edges. Their normals are weighted by the angles of the triangles,
  // so that it does not matter how faces are cut into triangles.
  SharpFeatures
  TriangleShape::sharp_features() const
  {
    SharpFeatures features;
    std::map<unsigned int, Tensor<1, 3>> outward;
    for (const auto &line : sharp_edges)
      {
        features.edges.push_back(
          {{{mesh.vertices[line.ends[0]], mesh.vertices[line.ends[1]]}}, line.normals});
        for (const unsigned int end : line.ends)
          outward[end] = Tensor<1, 3>();
      }
    for (const auto &t : mesh.triangles)
      {
        const auto n = mesh.normal(t);
        for (unsigned int k = 0; k < 3 && has_direction(n); ++k)
          {
            const auto known = outward.find(t[k]);
            if (known == outward.end())
              continue;
            const auto a = mesh.vertices[t[(k + 1) % 3]] - mesh.vertices[t[k]],
                       b = mesh.vertices[t[(k + 2) % 3]] - mesh.vertices[t[k]];
            known->second += std::atan2(n.norm(), a * b) / n.norm() * n;
          }
      }
    for (const auto &[vertex, sum] : outward)
      features.vertices.push_back({mesh.vertices[vertex], sum / sum.norm()});
    return features;
  }
} // namespace akmon
