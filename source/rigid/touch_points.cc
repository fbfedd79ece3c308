#include <akmon/rigid/rigid_shape.h>
#include <akmon/rigid/triangle_shape.h>

#include <algorithm>
#include <cmath>
#include <limits>

// Where the features of a shape come closest to another one.

namespace akmon
{
  using dealii::Tensor;

  namespace
  {
    // Appends skeleton points that are close enough.
    class Collector
    {
    public:
      Collector(const DistanceField &other,
                const double within,
                const double radius,
                std::vector<TouchPoint> &points)
        : other(other)
        , within(within)
        , radius(radius)
        , points(points)
      {
      }

      void
      add(const unsigned int feature, const Tensor<1, 3> &x)
      {
        SurfacePoint there = other(x);
        there.distance -= radius;
        if (there.distance <= within)
          points.push_back({feature, x, radius, there});
      }

      // The point between the ends where the distance is least, unless that is at an end.
      void
      add_line(const unsigned int feature, const Tensor<1, 3> &a, const Tensor<1, 3> &b)
      {
        const auto along = b - a;
        if (other(0.5 * (a + b)).distance - radius > within + 0.5 * along.norm())
          return;
        const auto slope = [&](const double s) { return other(a + s * along).normal * along; };
        const double s   = root(slope, 0., 1., 1e-10 * along.norm());
        if (s > 0. && s < 1.)
          add(feature, a + s * along);
      }

      // The points of a circle around z: the closest one and, for what stands on the rim, those a
      // quarter and half a turn from it.
      void
      add_circle(const unsigned int feature, const double z, const double r)
      {
        const auto at = [&](const double angle) {
          return Tensor<1, 3>({r * std::cos(angle), r * std::sin(angle), z});
        };
        if (r == 0.)
          {
            add(feature, at(0.));
            return;
          }
        const Tensor<1, 3> middle({0., 0., z});
        if (other(middle).distance - radius > within + r)
          return;
        const double closest = closest_angle(at);
        for (unsigned int k = 0; k < 4; ++k)
          add(feature + k, at(closest + 0.5 * k * dealii::numbers::PI));
      }

    private:
      // A root of an increasing function, or the end it would lie beyond; the lower end if it is
      // flat. By bisection, as distances have kinks.
      template <typename Function>
      static double
      root(const Function &f, double low, double high, const double flat)
      {
        const double f_low = f(low), f_high = f(high);
        if (f_low >= -flat)
          return low;
        if (f_high <= flat)
          return high;
        for (unsigned int i = 0; i < 60 && high - low > 1e-16 * std::abs(high); ++i)
          {
            const double middle           = 0.5 * (low + high);
            (f(middle) < 0. ? low : high) = middle;
          }
        return 0.5 * (low + high);
      }

      template <typename Circle>
      double
      closest_angle(const Circle &at) const
      {
        constexpr unsigned int n = 16;
        constexpr double step    = 2. * dealii::numbers::PI / n;
        unsigned int best        = 0;
        double least             = std::numeric_limits<double>::max();
        for (unsigned int i = 0; i < n; ++i)
          {
            const double distance = other(at(i * step)).distance;
            if (distance < least * (1. - 1e-12) - 1e-300)
              {
                least = distance;
                best  = i;
              }
          }
        const auto slope = [&](const double angle) {
          const auto tangent = Tensor<1, 3>({-std::sin(angle), std::cos(angle), 0.});
          return other(at(angle)).normal * tangent;
        };
        // Against a plane the slope is a sine, whose root is known without searching.
        const auto n_there = other(at(best * step)).normal;
        if (std::hypot(n_there[0], n_there[1]) > 1e-10)
          {
            const double angle = std::atan2(-n_there[1], -n_there[0]);
            if (std::abs(slope(angle)) < 1e-15)
              return angle;
          }
        return root(slope, (best - 1.) * step, (best + 1.) * step, 1e-12);
      }

      const DistanceField &other;
      const double within, radius;
      std::vector<TouchPoint> &points;
    };
  } // namespace


  void
  RigidShape::touch_points(const DistanceField &, const double, std::vector<TouchPoint> &) const
  {
  }


  void
  BallShape::touch_points(const DistanceField &other,
                          const double within,
                          std::vector<TouchPoint> &points) const
  {
    Collector(other, within, R, points).add(0, Tensor<1, 3>());
  }


  // The rims, and the line of the side that looks at the other shape.
  void
  RoundBarShape::touch_points(const DistanceField &other,
                              const double within,
                              std::vector<TouchPoint> &points) const
  {
    Collector collector(other, within, edge, points);
    const double core = R - edge;
    double h          = half_length - edge;
    if (std::isinf(h))
      h = 1e3 * R;
    else
      {
        collector.add_circle(0, -h, core);
        collector.add_circle(4, h, core);
      }
    const auto n       = other(Tensor<1, 3>()).normal;
    const double aside = std::hypot(n[0], n[1]);
    if (aside > 1e-12 && core > 0.)
      {
        const Tensor<1, 3> side({-core * n[0] / aside, -core * n[1] / aside, 0.});
        const Tensor<1, 3> axis({0., 0., h});
        collector.add_line(8, side - axis, side + axis);
      }
    else if (core == 0.)
      collector.add_line(8, Tensor<1, 3>({0., 0., -h}), Tensor<1, 3>({0., 0., h}));
  }


  void
  BlockShape::touch_points(const DistanceField &other,
                           const double within,
                           std::vector<TouchPoint> &points) const
  {
    Collector collector(other, within, edge, points);
    const auto corner = [&](const unsigned int i) {
      Tensor<1, 3> x;
      for (unsigned int d = 0; d < 3; ++d)
        x[d] = ((i >> d) & 1 ? 1. : -1.) * (half[d] - edge);
      return x;
    };
    for (unsigned int i = 0; i < 8; ++i)
      collector.add(i, corner(i));
    unsigned int feature = 8;
    for (unsigned int d = 0; d < 3; ++d)
      for (unsigned int i = 0; i < 8; ++i)
        if (((i >> d) & 1) == 0)
          collector.add_line(feature++, corner(i), corner(i | (1u << d)));
  }


  void
  TorusShape::touch_points(const DistanceField &other,
                           const double within,
                           std::vector<TouchPoint> &points) const
  {
    Collector(other, within, tube, points).add_circle(0, 0., ring);
  }


  void
  TriangleShape::touch_points(const DistanceField &other,
                              const double within,
                              std::vector<TouchPoint> &points) const
  {
    Collector collector(other, within, 0., points);
    for (unsigned int v = 0; v < mesh.vertices.size(); ++v)
      collector.add(v, mesh.vertices[v]);
    for (unsigned int i = 0; i < sharp_edges.size(); ++i)
      collector.add_line(mesh.vertices.size() + i,
                         mesh.vertices[sharp_edges[i].ends[0]],
                         mesh.vertices[sharp_edges[i].ends[1]]);
  }
} // namespace akmon
