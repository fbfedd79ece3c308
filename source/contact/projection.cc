#include <akmon/contact/projection.h>

#include <algorithm>
#include <cmath>

namespace akmon
{
  using dealii::Tensor;

  namespace
  {
    constexpr std::array<std::array<double, 2>, 4> corners = {
      {{{-1., -1.}}, {{1., -1.}}, {{1., 1.}}, {{-1., 1.}}}};


    struct Tangents
    {
      Tensor<1, 3> point, along_xi, along_eta;
    };


    Tangents
    evaluate(const Segment &segment, const double xi, const double eta)
    {
      Tangents t;
      for (unsigned int k = 0; k < 4; ++k)
        {
          const double a = 1. + corners[k][0] * xi, b = 1. + corners[k][1] * eta;
          t.point += 0.25 * a * b * segment[k];
          t.along_xi += 0.25 * corners[k][0] * b * segment[k];
          t.along_eta += 0.25 * corners[k][1] * a * segment[k];
        }
      return t;
    }


    // Gauss-Newton on |slave - x(xi, eta)|^2; true if it ends inside the segment.
    bool
    project_to_interior(const Tensor<1, 3> &slave, const Segment &segment, double &xi, double &eta)
    {
      constexpr unsigned int max_iterations = 20;
      constexpr double reach                = 3.; // further out the closest point is on the border

      xi = eta = 0.;
      for (unsigned int iteration = 0; iteration < max_iterations; ++iteration)
        {
          const Tangents t = evaluate(segment, xi, eta);
          const auto r     = slave - t.point;
          const double a = t.along_xi * t.along_xi, b = t.along_xi * t.along_eta,
                       c = t.along_eta * t.along_eta, p = t.along_xi * r, q = t.along_eta * r;
          const double determinant = a * c - b * b;
          if (!(determinant > 0.))
            return false;
          const double d_xi = (c * p - b * q) / determinant, d_eta = (a * q - b * p) / determinant;
          xi  = std::clamp(xi + d_xi, -reach, reach);
          eta = std::clamp(eta + d_eta, -reach, reach);
          if (std::abs(d_xi) + std::abs(d_eta) < 1e-14)
            break;
        }
      return std::abs(xi) <= 1. && std::abs(eta) <= 1.;
    }


    // Closest point of the four straight edges.
    void
    project_to_border(const Tensor<1, 3> &slave, const Segment &segment, double &xi, double &eta)
    {
      double best = -1.;
      for (unsigned int e = 0; e < 4; ++e)
        {
          const unsigned int e1 = (e + 1) % 4;
          const auto direction  = segment[e1] - segment[e];
          const double length   = direction * direction;
          const double s        = length > 0. ?
                                    std::clamp((slave - segment[e]) * direction / length, 0., 1.) :
                                    0.;
          const double distance = (slave - segment[e] - s * direction).norm_square();
          if (best < 0. || distance < best)
            {
              best = distance;
              xi   = (1. - s) * corners[e][0] + s * corners[e1][0];
              eta  = (1. - s) * corners[e][1] + s * corners[e1][1];
            }
        }
    }


    // Name the feature that a point of the segment belongs to.
    void
    classify(Projection &projection, const double tolerance)
    {
      const bool at_xi  = std::abs(projection.xi) >= 1. - tolerance;
      const bool at_eta = std::abs(projection.eta) >= 1. - tolerance;
      if (at_xi && at_eta)
        {
          projection.feature = Projection::Feature::vertex;
          for (unsigned int k = 0; k < 4; ++k)
            if (corners[k][0] * projection.xi > 0. && corners[k][1] * projection.eta > 0.)
              projection.where = k;
        }
      else if (at_xi || at_eta)
        {
          projection.feature = Projection::Feature::edge;
          projection.where = at_eta ? (projection.eta < 0. ? 0 : 2) : (projection.xi > 0. ? 1 : 3);
        }
    }
  } // namespace


  Projection
  project(const Tensor<1, 3> &slave, const Segment &segment, const double edge_tolerance)
  {
    Projection projection;
    if (!project_to_interior(slave, segment, projection.xi, projection.eta))
      project_to_border(slave, segment, projection.xi, projection.eta);

    projection.offset = slave;
    for (unsigned int k = 0; k < 4; ++k)
      {
        projection.N[k] = 0.25 * (1. + corners[k][0] * projection.xi) *
                          (1. + corners[k][1] * projection.eta);
        projection.offset -= projection.N[k] * segment[k];
      }
    classify(projection, edge_tolerance);
    return projection;
  }


  Tensor<1, 3>
  segment_normal(const Segment &segment, const double xi, const double eta)
  {
    const Tangents t  = evaluate(segment, xi, eta);
    const auto normal = cross_product_3d(t.along_xi, t.along_eta);
    return normal / normal.norm();
  }


  Tensor<1, 3>
  area_vector(const Segment &segment)
  {
    return 0.5 * cross_product_3d(segment[2] - segment[0], segment[3] - segment[1]);
  }
} // namespace akmon
