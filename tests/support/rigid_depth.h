#pragma once

#include <akmon/case.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "support/run_case.h"

// How deep rigid bodies are in each other in the poses that a history reports: sampled densely, by
// the signed distances of the shapes alone.

namespace akmon::test
{
  using Vector = dealii::Tensor<1, 3>;

  /// A curve of a shape, s from 0 to 1, in its frame; the surface is it blown up by a radius.
  struct Curve
  {
    std::function<Vector(double)> at;
    double radius;
    bool is_axis = false; ///< blown up it reaches beyond the ends of the shape
  };


  inline Curve
  circle(const double z, const double r, const double tube)
  {
    return {[=](const double s) {
              const double angle = 2. * dealii::numbers::PI * s;
              return Vector({r * std::cos(angle), r * std::sin(angle), z});
            },
            tube};
  }


  inline Curve
  line(const Vector &a, const Vector &b, const bool is_axis = false)
  {
    return {[=](const double s) { return a + s * (b - a); }, 0., is_axis};
  }


  /// All rims, edges, rings and axes of a shape by its name and dimensions: cylinder (radius,
  /// length), torus (radius, tube radius), box (sizes), plane (none).
  inline std::vector<Curve>
  curves_of(const std::string &name, const std::vector<double> &a)
  {
    std::vector<Curve> curves;
    if (name == "cylinder")
      curves = {circle(-0.5 * a[1], a[0], 0.),
                circle(0.5 * a[1], a[0], 0.),
                line(Vector({0., 0., -0.5 * a[1]}), Vector({0., 0., 0.5 * a[1]}), true)};
    if (name == "torus")
      curves = {circle(0., a[0], a[1])};
    if (name == "box")
      for (unsigned int d = 0; d < 3; ++d)
        for (const double side : {-0.5, 0.5})
          for (const double other_side : {-0.5, 0.5})
            {
              Vector from, to;
              from[d]           = -0.5 * a[d];
              to[d]             = 0.5 * a[d];
              from[(d + 1) % 3] = to[(d + 1) % 3] = side * a[(d + 1) % 3];
              from[(d + 2) % 3] = to[(d + 2) % 3] = other_side * a[(d + 2) % 3];
              curves.push_back(line(from, to));
            }
    return curves;
  }


  /// A rigid body of a case, for looking at it from outside.
  struct RigidSample
  {
    const Obstacle &obstacle;
    std::vector<Curve> curves;

    Pose
    pose(const Table &history, const std::size_t row) const
    {
      if (obstacle.motion == Obstacle::Motion::fixed)
        return obstacle.start;
      const auto read = [&](const std::string &quantity) {
        const std::string name = obstacle.name + "." + quantity + "_";
        return Vector(
          {history[name + "x"][row], history[name + "y"][row], history[name + "z"][row]});
      };
      return {obstacle.start.place + read("displacement"),
              Orientation::about(read("rotation")) * obstacle.start.orientation};
    }
  };


  /// Depth of the deepest point of a curve in another shape: n samples, and a golden section around
  /// the deepest.
  inline double
  depth_of_curve(const Curve &curve,
                 const RigidShape &own,
                 const RigidShape &other,
                 const std::function<Vector(Vector)> &to_other,
                 const std::function<Vector(Vector)> &to_own)
  {
    constexpr unsigned int n = 360;
    const auto depth         = [&](const double s) {
      const Vector x   = to_other(curve.at(s));
      const auto point = other.closest(x);
      if (!curve.is_axis)
        return curve.radius - point.distance;
      return -own.closest(to_own(x - point.distance * point.normal)).distance;
    };
    double best = 0., deepest = depth(0.);
    for (unsigned int i = 1; i <= n; ++i)
      if (const double there = depth(double(i) / n); there > deepest)
        {
          deepest = there;
          best    = double(i) / n;
        }
    constexpr double golden = 0.6180339887498949;
    double low = best - 1. / n, high = best + 1. / n;
    if (curve.is_axis || curve.radius == 0.)
      {
        low  = std::max(low, 0.);
        high = std::min(high, 1.);
      }
    for (unsigned int i = 0; i < 40; ++i)
      {
        const double a = high - golden * (high - low), b = low + golden * (high - low);
        const double at_a = depth(a), at_b = depth(b);
        deepest                    = std::max({deepest, at_a, at_b});
        (at_a > at_b ? high : low) = at_a > at_b ? b : a;
      }
    return deepest;
  }


  /// The deepest that the first body's curves are in the second one; length, negative: apart.
  inline double
  depth_in(const RigidSample &first,
           const RigidSample &second,
           const Pose &of_first,
           const Pose &of_second)
  {
    const auto &own = *first.obstacle.shape, &other = *second.obstacle.shape;
    const auto R = of_first.orientation.matrix(), S = of_second.orientation.matrix();
    const auto to_other = [&](const Vector &X) {
      return Vector(transpose(S) * (of_first.place + R * X - of_second.place));
    };
    const auto to_own = [&](const Vector &Y) {
      return Vector(transpose(R) * (of_second.place + S * Y - of_first.place));
    };
    double deepest = -other.closest(to_other(Vector())).distance + own.radius(); // at most
    if (deepest < 0.)
      return deepest;
    deepest = -1.;
    for (const auto &curve : first.curves)
      deepest = std::max(deepest, depth_of_curve(curve, own, other, to_other, to_own));
    return deepest;
  }


  /// The deepest penetration of a history in any row, over the size of the smaller body, between
  /// all bodies with curves and between them and the others.
  inline double
  deepest_penetration(const Table &history, const std::vector<RigidSample> &bodies)
  {
    double deepest = 0.;
    for (std::size_t row = 0; row < history.n_rows(); ++row)
      {
        std::vector<Pose> poses;
        for (const auto &body : bodies)
          poses.push_back(body.pose(history, row));
        for (std::size_t i = 0; i < bodies.size(); ++i)
          for (std::size_t j = 0; j < bodies.size(); ++j)
            if (i != j && !bodies[i].curves.empty())
              {
                const double size = std::min(bodies[i].obstacle.shape->radius(),
                                             bodies[j].obstacle.shape->radius());
                deepest           = std::max(deepest,
                                   depth_in(bodies[i], bodies[j], poses[i], poses[j]) / size);
              }
      }
    return deepest;
  }
} // namespace akmon::test
