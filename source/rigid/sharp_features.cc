#include <akmon/rigid/rigid_shape.h>
#include <akmon/rigid/triangle_shape.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

// The sharp corners and edges of shapes.

namespace akmon
{
  using dealii::Tensor;

  SharpFeatures
  RigidShape::sharp_features(const double) const
  {
    return {};
  }


  SharpFeatures
  BlockShape::sharp_features(const double least_angle) const
  {
    SharpFeatures features;
    if (edge > 0. || least_angle > 0.5 * dealii::numbers::PI)
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


  // Corners are the ends of sharp edges, and tips where many edges meet that are less sharp: there
  // the normals of the triangles are far from their mean. That is weighted by the angles of the
  // triangles, so that it does not matter how faces are cut into triangles.
  SharpFeatures
  TriangleShape::sharp_features(const double least_angle) const
  {
    struct Corner
    {
      Tensor<1, 3> sum;
      std::vector<Tensor<1, 3>> normals;
      bool ends_edge = false;
    };
    SharpFeatures features;
    std::map<unsigned int, Corner> corners;
    for (const auto &line : sharp_edges)
      {
        const bool is_sharp = line.normals[0] * line.normals[1] < std::cos(least_angle);
        if (is_sharp)
          features.edges.push_back(
            {{{mesh.vertices[line.ends[0]], mesh.vertices[line.ends[1]]}}, line.normals});
        for (const unsigned int end : line.ends)
          corners[end].ends_edge = corners[end].ends_edge || is_sharp;
      }
    for (const auto &t : mesh.triangles)
      {
        const auto n = mesh.normal(t);
        for (unsigned int k = 0; k < 3 && has_direction(n); ++k)
          {
            const auto known = corners.find(t[k]);
            if (known == corners.end())
              continue;
            const auto a = mesh.vertices[t[(k + 1) % 3]] - mesh.vertices[t[k]],
                       b = mesh.vertices[t[(k + 2) % 3]] - mesh.vertices[t[k]];
            known->second.sum += std::atan2(n.norm(), a * b) / n.norm() * n;
            known->second.normals.push_back(n / n.norm());
          }
      }
    for (const auto &[vertex, corner] : corners)
      {
        const auto outward = corner.sum / corner.sum.norm();
        if (corner.ends_edge ||
            std::any_of(corner.normals.begin(), corner.normals.end(), [&](const auto &n) {
              return n * outward < std::cos(0.5 * least_angle);
            }))
          features.vertices.push_back({mesh.vertices[vertex], outward});
      }
    return features;
  }
} // namespace akmon
