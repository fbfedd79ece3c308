#pragma once

#include <akmon/contact/search/face_geometry.h>
#include <akmon/simulation.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

// How deep deformable bodies are in each other where a simulation stands: from the cells alone,
// without regard to what contact has found.

namespace akmon::test
{
  /// The cells, boundary faces and edges of a body as they are now.
  class SolidBody
  {
  public:
    using Vector = dealii::Tensor<1, 3>;

    SolidBody(const Simulation &simulation, const unsigned int body)
    {
      const auto &model = simulation.model();
      const auto &x     = simulation.current_state().x;
      for (const auto &cell : model.cells)
        if (cell.body == body)
          {
            cells.emplace_back();
            for (unsigned int v = 0; v < 8; ++v)
              cells.back()[v] = at_node(x, cell.nodes[v]);
          }
      std::set<std::pair<unsigned int, unsigned int>> known;
      for (const auto &face : model.boundary_faces())
        if (face.body == body)
          {
            faces.push_back(segment_of(face, x));
            for (unsigned int k = 0; k < 4; ++k)
              if (known.insert(std::minmax(face.nodes[k], face.nodes[(k + 1) % 4])).second)
                edges.push_back({{faces.back()[k], faces.back()[(k + 1) % 4]}});
          }
    }

    bool
    contains(const Vector &p) const
    {
      return std::any_of(cells.begin(), cells.end(), [&](const auto &cell) {
        return is_in(p, cell);
      });
    }

    /// Distance of a point from the boundary if it is inside, else zero; length.
    double
    depth_of(const Vector &p) const
    {
      if (!contains(p))
        return 0.;
      double least = std::numeric_limits<double>::max();
      for (const auto &face : faces)
        least = std::min(least, project(p, face, 0.).offset.norm());
      return least;
    }

    std::vector<std::array<Vector, 8>> cells; ///< deal.II's order of corners
    std::vector<Segment> faces;
    std::vector<std::array<Vector, 2>> edges; ///< of the boundary faces

  private:
    // Newton for the place in the unit cell.
    static bool
    is_in(const Vector &p, const std::array<Vector, 8> &cell)
    {
      for (unsigned int d = 0; d < 3; ++d)
        {
          double low = cell[0][d], high = cell[0][d];
          for (const auto &corner : cell)
            {
              low  = std::min(low, corner[d]);
              high = std::max(high, corner[d]);
            }
          if (p[d] < low || p[d] > high)
            return false;
        }
      std::array<double, 3> xi{{0.5, 0.5, 0.5}};
      for (unsigned int iteration = 0; iteration < 20; ++iteration)
        {
          Vector r = p;
          dealii::Tensor<2, 3> J;
          for (unsigned int v = 0; v < 8; ++v)
            {
              std::array<double, 3> N, dN;
              for (unsigned int d = 0; d < 3; ++d)
                {
                  const bool upper = (v >> d) & 1;
                  N[d]             = upper ? xi[d] : 1. - xi[d];
                  dN[d]            = upper ? 1. : -1.;
                }
              r -= N[0] * N[1] * N[2] * cell[v];
              for (unsigned int i = 0; i < 3; ++i)
                {
                  J[i][0] += dN[0] * N[1] * N[2] * cell[v][i];
                  J[i][1] += N[0] * dN[1] * N[2] * cell[v][i];
                  J[i][2] += N[0] * N[1] * dN[2] * cell[v][i];
                }
            }
          const Vector change = invert(J) * r;
          for (unsigned int d = 0; d < 3; ++d)
            xi[d] += change[d];
          if (change.norm() < 1e-15)
            break;
        }
      return std::all_of(xi.begin(), xi.end(), [](const double c) { return c >= 0. && c <= 1.; });
    }
  };


  /// Depth of many points of a body's boundary in another one; length.
  inline double
  depth_of_faces(const SolidBody &body, const SolidBody &other, const unsigned int n)
  {
    double deepest = 0.;
    for (const auto &face : body.faces)
      for (unsigned int i = 0; i <= n; ++i)
        for (unsigned int j = 0; j <= n; ++j)
          {
            const double s = double(i) / n, t = double(j) / n;
            deepest = std::max(deepest,
                               other.depth_of((1. - t) * ((1. - s) * face[0] + s * face[1]) +
                                              t * ((1. - s) * face[3] + s * face[2])));
          }
    return deepest;
  }


  /// The same of edges in edges, where they are closest: half way between is inside both bodies.
  inline double
  depth_of_edges(const SolidBody &body, const SolidBody &other)
  {
    double deepest = 0.;
    for (const auto &a : body.edges)
      for (const auto &b : other.edges)
        {
          const auto u = a[1] - a[0], v = b[1] - b[0], w = b[0] - a[0];
          const auto both   = cross_product_3d(u, v);
          const double size = both.norm_square();
          if (!(size > 1e-12 * u.norm_square() * v.norm_square()))
            continue;
          const double s = cross_product_3d(w, v) * both / size,
                       t = cross_product_3d(w, u) * both / size;
          if (s < 0. || s > 1. || t < 0. || t > 1.)
            continue;
          const auto middle    = 0.5 * (a[0] + s * u + b[0] + t * v);
          const double in_body = body.depth_of(middle), in_other = other.depth_of(middle);
          if (in_body > 0. && in_other > 0.)
            deepest = std::max(deepest, in_body + in_other);
        }
    return deepest;
  }


  /// The largest depth of two bodies in each other; length.
  inline double
  depth_of_overlap(const Simulation &simulation, const unsigned int n = 12)
  {
    const SolidBody first(simulation, 0), second(simulation, 1);
    return std::max({depth_of_faces(first, second, n),
                     depth_of_faces(second, first, n),
                     depth_of_edges(first, second)});
  }
} // namespace akmon::test
