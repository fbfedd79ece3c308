#pragma once

#include <akmon/contact/search/edge_search.h>
#include <akmon/contact/search/face_geometry.h>

#include <array>
#include <cmath>

namespace akmon
{
  /// The point at a part of an edge; length.
  inline dealii::Tensor<1, 3>
  point_on(const ContactNodes::Field &x, const FeatureEdge &edge, const double part)
  {
    return (1. - part) * x[edge.nodes[0]] + part * x[edge.nodes[1]];
  }


  /// An edge's direction, counter-clockwise around its first face, and the normals of both.
  struct EdgeWedge
  {
    dealii::Tensor<1, 3> along;
    std::array<dealii::Tensor<1, 3>, 2> normals;

    EdgeWedge(const ContactNodes::Field &x, const FeatureEdge &edge)
    {
      const auto corner = [&](const unsigned int f, const unsigned int k) {
        return x[edge.corners[f][k % 4]];
      };
      const auto is_end = [&](const unsigned int k) {
        const unsigned int node = edge.corners[0][k % 4];
        return node == edge.nodes[0] || node == edge.nodes[1];
      };
      unsigned int k = 0; // the edge starts there in the first face
      while (!is_end(k) || !is_end(k + 1))
        ++k;
      along = corner(0, k + 1) - corner(0, k);
      along /= along.norm();
      for (unsigned int f = 0; f < edge.n_faces; ++f)
        {
          normals[f] = area_vector({{corner(f, 0), corner(f, 1), corner(f, 2), corner(f, 3)}});
          normals[f] /= normals[f].norm();
        }
      // Beyond a rim the surface turns as it did initially.
      if (edge.n_faces == 1)
        normals[1] = std::cos(edge.angle) * normals[0] +
                     std::sin(edge.angle) * cross_product_3d(along, normals[0]);
    }

    /// Whether a normal is one that the surface takes as it turns about the edge. One of a face
    /// that dips a little below the edge counts, too: whatever comes past the edge is in the body.
    bool
    takes(const dealii::Tensor<1, 3> &normal) const
    {
      constexpr double tilted = 0.17; // sine: a normal may be off the range of an edge's so far

      return normal * (normals[0] + normals[1]) > 0. &&
             cross_product_3d(normals[0], normal) * along >= -tilted &&
             cross_product_3d(normal, normals[1]) * along >= -tilted;
    }

    /// Whether a place beside the edge is in the body, behind both faces.
    bool
    contains(const dealii::Tensor<1, 3> &from_edge) const
    {
      return from_edge * normals[0] < 0. && from_edge * normals[1] < 0.;
    }

    /// Whether a place beside the edge is over one of its faces, no higher than a length.
    bool
    is_under(const dealii::Tensor<1, 3> &from_edge, const double height) const
    {
      const std::array<dealii::Tensor<1, 3>, 2> inward{
        {cross_product_3d(normals[0], along), cross_product_3d(along, normals[1])}};
      for (unsigned int f = 0; f < 2; ++f)
        if (from_edge * inward[f] > 0. && from_edge * normals[f] <= height)
          return true;
      return false;
    }
  };
} // namespace akmon
