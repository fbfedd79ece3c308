#pragma once

#include <deal.II/base/tensor.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace akmon
{
  /// The face of a pair's set of admissible forces that the force is kept on: where it is free.
  struct FreeDirections
  {
    enum class Tangential
    {
      none,   ///< no friction, or no normal force to allow any
      circle, ///< on the friction circle: along it only (slip)
      disc    ///< all of the contact plane (stick)
    };

    bool normal           = false; ///< else t_n = 0
    Tangential tangential = Tangential::none;
    dealii::Tensor<1, 3> along; ///< unit vector along the circle
    double curvature = 0.;      ///< |g_tau|/r: what the circle adds to the Hessian along it
  };


  /**
   * The sets of admissible contact forces of pairs for given friction limits,
   *
   *     t_n >= 0,   |t_tau| <= r ,
   *
   * half-infinite cylinders. Forces are vectors (t_n, t_tau1, t_tau2) in the frames of the pairs,
   * so that a normal force of zero is zero and not what rounding leaves of it.
   */
  struct FrictionCylinders
  {
    using Unknown    = dealii::Tensor<1, 3>;
    using Tangential = FreeDirections::Tangential;

    std::vector<double> radius;

    static Unknown
    tangential(const Unknown &t)
    {
      return Unknown({0., t[1], t[2]});
    }

    static double
    tangential_size(const Unknown &t)
    {
      return std::hypot(t[1], t[2]);
    }

    /// The closest admissible force.
    Unknown
    project(const std::size_t i, const Unknown &t) const
    {
      const double size   = tangential_size(t);
      const double factor = size > radius[i] ? radius[i] / size : 1.;
      return Unknown({std::max(t[0], 0.), factor * t[1], factor * t[2]});
    }

    /// What lies on the circle up to rounding belongs to it.
    bool
    is_inside_circle(const std::size_t i, const Unknown &t) const
    {
      return tangential_size(t) < (1. - 1e-12) * radius[i];
    }

    /// The smallest face that an admissible force lies on.
    FreeDirections
    face_at(const std::size_t i, const Unknown &t) const
    {
      FreeDirections free;
      free.normal = t[0] > 0.;
      if (radius[i] > 0.)
        free.tangential = is_inside_circle(i, t) ? Tangential::disc : Tangential::circle;
      return free;
    }

    /// How much a force on the circle wants to leave it, for the gradient g: inwards if negative.
    static double
    pressing(const Unknown &t, const Unknown &g)
    {
      return -(tangential(t) * g) / tangential_size(t);
    }

    /// Direction and curvature of the circle at t, for a force that is kept on it.
    void
    update_circle(const std::size_t i,
                  const Unknown &t,
                  const Unknown &g,
                  FreeDirections &free) const
    {
      free.curvature = 0.;
      if (free.tangential != Tangential::circle)
        return;
      free.along     = Unknown({0., -t[2], t[1]}) / tangential_size(t);
      free.curvature = std::max(0., pressing(t, g)) / radius[i];
    }

    /// The face without the bounds that the negative gradient leads away from.
    static FreeDirections
    released(const Unknown &t, const Unknown &g, FreeDirections free)
    {
      free.normal = free.normal || g[0] < 0.;
      if (free.tangential == Tangential::circle && pressing(t, g) < 0.)
        free.tangential = Tangential::disc;
      return free;
    }

    /// The part of a vector in the free directions.
    static Unknown
    restrict_to(const FreeDirections &free, const Unknown &v)
    {
      Unknown result;
      if (free.tangential == Tangential::disc)
        result = v;
      else if (free.tangential == Tangential::circle)
        result = (free.along * v) * free.along;
      result[0] = free.normal ? v[0] : 0.;
      return result;
    }

    /// Largest alpha with t - alpha p admissible, for an admissible t, and with a turn along the
    /// circle that its curvature describes.
    double
    longest_step(const std::size_t i,
                 const FreeDirections &free,
                 const Unknown &t,
                 const Unknown &p) const
    {
      double alpha = p[0] > 0. ? t[0] / p[0] : std::numeric_limits<double>::max();
      if (free.tangential == Tangential::disc)
        {
          const double a = p[1] * p[1] + p[2] * p[2], b = t[1] * p[1] + t[2] * p[2],
                       c = std::min(0., t[1] * t[1] + t[2] * t[2] - radius[i] * radius[i]);
          if (a > 0.)
            alpha = std::min(alpha, (b + std::sqrt(b * b - a * c)) / a);
        }
      else if (free.tangential == Tangential::circle && free.along * p != 0.)
        alpha = std::min(alpha, largest_turn * radius[i] / std::abs(free.along * p));
      return alpha;
    }

    static constexpr double largest_turn = 0.5; ///< on the circle in one step; radian
  };
} // namespace akmon
