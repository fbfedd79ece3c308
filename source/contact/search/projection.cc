#include <akmon/contact/search/projection.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace akmon
{
  using dealii::Tensor;

  namespace
  {
    constexpr std::array<std::array<double, 2>, 4> corners = {
      {{{-1., -1.}}, {{1., -1.}}, {{1., 1.}}, {{-1., 1.}}}};


    // Newton on |slave - x(xi, eta)|^2 from a start, Gauss-Newton where that is not convex; true if
    // it ends inside the segment.
    bool
    project_to_interior(const Tensor<1, 3> &slave, const Segment &segment, double &xi, double &eta)
    {
      constexpr unsigned int max_iterations = 20, enough_to_tell = 4;
      constexpr double reach = 3.; // further out the closest point is on the border
      constexpr double far   = 2.; // from where iterations do not come back

      const Bilinear x(segment);
      for (unsigned int iteration = 0; iteration < max_iterations; ++iteration)
        {
          const auto along_xi = x.along_xi(eta), along_eta = x.along_eta(xi);
          const auto r   = slave - x.c - xi * along_xi - eta * x.c_eta;
          const double a = along_xi * along_xi, along_both = along_xi * along_eta,
                       c = along_eta * along_eta, p = along_xi * r, q = along_eta * r;
          double b           = along_both - r * x.c_xi_eta;
          double determinant = a * c - b * b;
          const bool convex  = determinant > 0.1 * a * c;
          if (!convex)
            {
              b           = along_both;
              determinant = a * c - b * b;
            }
          if (!(determinant > 0.))
            return false;
          const double old_xi = xi, old_eta = eta;
          xi  = std::clamp(xi + (c * p - b * q) / determinant, -reach, reach);
          eta = std::clamp(eta + (a * q - b * p) / determinant, -reach, reach);
          // Newton's next change would be of the order of the square of this one.
          if (std::abs(xi - old_xi) + std::abs(eta - old_eta) < (convex ? 1e-8 : 1e-14))
            break;
          if (iteration >= enough_to_tell && std::max(std::abs(xi), std::abs(eta)) > far)
            return false;
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
  project(const Tensor<1, 3> &slave,
          const Segment &segment,
          const double edge_tolerance,
          const std::array<double, 2> &start)
  {
    Projection projection;
    projection.xi  = start[0];
    projection.eta = start[1];
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


  double
  distance_to_border(const Tensor<1, 3> &point, const Segment &segment)
  {
    double least = std::numeric_limits<double>::max();
    for (unsigned int e = 0; e < 4; ++e)
      {
        const auto direction = segment[(e + 1) % 4] - segment[e];
        const auto offset    = point - segment[e];
        const double length  = direction.norm_square();
        const double along   = length > 0. ? (offset * direction) / length : 0.;
        least                = std::min(least, (offset - along * direction).norm_square());
      }
    return std::sqrt(least);
  }
} // namespace akmon
