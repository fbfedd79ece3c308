#pragma once

#include <deal.II/base/tensor.h>

#include <array>

namespace akmon
{
  /// A bilinear master segment: its corners counter-clockwise seen from outside; length.
  using Segment = std::array<dealii::Tensor<1, 3>, 4>;


  /// Closest point of a segment to a slave node.
  struct Projection
  {
    enum class Feature
    {
      face,
      edge,  ///< number `where`: from corner `where` to corner (where+1) % 4
      vertex ///< corner number `where`
    };

    double xi = 0., eta = 0.;    ///< in [-1,1]^2
    std::array<double, 4> N;     ///< shape values of the corners
    dealii::Tensor<1, 3> offset; ///< slave minus closest point; length
    Feature feature    = Feature::face;
    unsigned int where = 0;
  };


  constexpr double near_border = 1e-3; ///< in xi, eta


  /**
   * Project a point to the closest point of a segment: face, edge or vertex (4).
   * @param edge_tolerance  a closest point so near to the border (in xi, eta) counts as on an edge
   *   or vertex
   * @param start           (xi, eta) to begin with
   */
  Projection
  project(const dealii::Tensor<1, 3> &slave,
          const Segment &segment,
          const double edge_tolerance        = near_border,
          const std::array<double, 2> &start = {{0., 0.}});

  /// A segment as x(xi, eta) = c + c_xi xi + c_eta eta + c_xi_eta xi eta; length.
  struct Bilinear
  {
    dealii::Tensor<1, 3> c, c_xi, c_eta, c_xi_eta;

    explicit Bilinear(const Segment &x)
      : c(0.25 * ((x[0] + x[2]) + (x[1] + x[3])))
      , c_xi(0.25 * ((x[2] - x[0]) + (x[1] - x[3])))
      , c_eta(0.25 * ((x[2] - x[0]) - (x[1] - x[3])))
      , c_xi_eta(0.25 * ((x[0] + x[2]) - (x[1] + x[3])))
    {
    }

    dealii::Tensor<1, 3>
    along_xi(const double eta) const
    {
      return c_xi + eta * c_xi_eta;
    }

    dealii::Tensor<1, 3>
    along_eta(const double xi) const
    {
      return c_eta + xi * c_xi_eta;
    }
  };

  /// Outward unit normal of a segment at (xi, eta).
  inline dealii::Tensor<1, 3>
  segment_normal(const Segment &segment, const double xi, const double eta)
  {
    const Bilinear x(segment);
    const auto normal = cross_product_3d(x.along_xi(eta), x.along_eta(xi));
    return normal / normal.norm();
  }

  /// Outward normal of a segment, as long as its area (exact for plane segments).
  inline dealii::Tensor<1, 3>
  area_vector(const Segment &segment)
  {
    return 0.5 * cross_product_3d(segment[2] - segment[0], segment[3] - segment[1]);
  }

  /// Least distance of a point of a segment to the lines through its edges.
  double
  distance_to_border(const dealii::Tensor<1, 3> &point, const Segment &segment);
} // namespace akmon
