#include <akmon/rigid/rigid_shape.h>
#include <akmon/rigid/triangle_shape.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

// Where the features of a shape come closest to another one.

namespace akmon
{
  using dealii::Tensor;

  namespace
  {
    // Of a shape's radius: how far inside its sharp edges and corners look from. What is curved
    // there is missed by the square of it, and directions are known to rounding over it.
    constexpr double inset = 1e-6;


    // What a curve sees at its parameter s: the distance, and how it changes along the curve.
    struct Sample
    {
      double s, distance, slope;
    };


    // A part of a curve on which the distance falls and rises, or is the same in between.
    struct Valley
    {
      double low, high; // parameters
      bool is_flat;
    };


    // Where the slope changes its sign. By bisection, as distances have kinks.
    template <typename Look>
    double
    root(const Look &look, const Valley &valley)
    {
      double low = valley.low, high = valley.high;
      for (unsigned int i = 0; i < 60 && high - low > 1e-16 * std::abs(high); ++i)
        {
          const double middle                    = 0.5 * (low + high);
          (look(middle).slope < 0. ? low : high) = middle;
        }
      return 0.5 * (low + high);
    }


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
      add(const unsigned int feature,
          const unsigned int number,
          const Tensor<1, 3> &x,
          const Tensor<1, 3> &from = {},
          const bool least         = true)
      {
        TouchPoint point{feature, number, least, x, from, radius, {}};
        point.look(other);
        if (point.other.distance <= within)
          points.push_back(point);
      }

      // The points between the ends where the distance is least.
      void
      add_line(const unsigned int feature,
               const Tensor<1, 3> &a,
               const Tensor<1, 3> &b,
               const Tensor<1, 3> &from = {})
      {
        const auto along    = b - a;
        const double length = along.norm();
        const auto look     = [&](const double s) {
          const auto there = other(a + s * along + from);
          return Sample{s, there.distance, there.normal * along};
        };
        if (look(0.5).distance - radius > within + 0.5 * length)
          return;
        unsigned int number = 0;
        for (const auto &valley : valleys(look, 8, false, 1., length, 1e-10 * length))
          if (!valley.is_flat) // the ends of that part tell it, or what it crosses there
            add(feature, number++, a + root(look, valley) * along, from);
      }

      // The points of a circle around z: the closest ones and, for what stands on the rim, those a
      // quarter and half a turn from the first of them.
      // @param depth  how far inside the circle, in the radius and along z, it looks from; length
      void
      add_circle(const unsigned int feature,
                 const double z,
                 const double r,
                 const std::array<double, 2> &depth = {{0., 0.}})
      {
        constexpr unsigned int n_feet = 4;
        const Circle circle{z, r, depth};
        if (r == 0.)
          {
            add(feature, 0, circle.at(0.));
            return;
          }
        if (other(Tensor<1, 3>({0., 0., z})).distance - radius > within + r)
          return;
        const auto angles  = closest_angles(circle);
        const auto is_free = [&](const double angle) {
          return std::none_of(angles.begin(), angles.end(), [&](const double other_angle) {
            return std::cos(angle - other_angle) > std::cos(0.25 * dealii::numbers::PI);
          });
        };
        for (unsigned int k = 0; k < n_feet; ++k)
          {
            const double angle = angles[0] + 0.5 * k * dealii::numbers::PI;
            if (k == 0 || is_free(angle))
              add(feature, k, circle.at(angle), circle.inward(angle), k == 0);
          }
        for (std::size_t i = 1; i < angles.size(); ++i)
          add(feature, n_feet + i, circle.at(angles[i]), circle.inward(angles[i]));
      }

    private:
      struct Circle
      {
        double z, r;
        std::array<double, 2> depth;

        Tensor<1, 3>
        at(const double angle) const
        {
          return Tensor<1, 3>({r * std::cos(angle), r * std::sin(angle), z});
        }

        Tensor<1, 3>
        inward(const double angle) const
        {
          return Tensor<1, 3>(
            {-depth[0] * std::cos(angle), -depth[0] * std::sin(angle), -depth[1]});
        }

        Tensor<1, 3>
        seen_from(const double angle) const
        {
          return at(angle) + inward(angle);
        }
      };

      // The parts of a curve that have a least distance within reach, by samples: n of them, and
      // more where the curve may be so close.
      // @param end, length  of the curve, which begins at 0: its parameter, and its length
      // @param flat  slopes that are none
      template <typename Look>
      std::vector<Valley>
      valleys(const Look &look,
              const unsigned int n,
              const bool closed,
              const double end,
              const double length,
              const double flat) const
      {
        constexpr unsigned int n_finer = 4;
        std::vector<Valley> result;
        double falls        = -1.; // where it did last, unless it has risen since
        unsigned int n_flat = 0;   // samples since then
        const auto visit    = [&](const Sample &sample) {
          if (sample.slope < -flat)
            falls = sample.s;
          else if (sample.slope > flat)
            {
              if (falls >= 0. && falls < end &&
                  sample.distance - radius <= within + (sample.s - falls) / end * length)
                result.push_back({falls, sample.s, n_flat > 1});
              falls = -1.;
            }
          n_flat = std::abs(sample.slope) <= flat ? n_flat + 1 : 0;
        };
        Sample last = look(0.);
        visit(last);
        // A valley of a closed curve may lie across its begin.
        for (unsigned int i = 1; i <= (closed ? 2 * n : n) && (i <= n || falls >= 0.); ++i)
          {
            const Sample next = look(i * end / n);
            if (std::min(last.distance, next.distance) - radius <= within + 0.5 * length / n)
              for (unsigned int k = 1; k < n_finer; ++k)
                visit(look((i - 1. + k / double(n_finer)) * end / n));
            visit(next);
            last = next;
          }
        return result;
      }

      // Where the distance is least, the least one first; any angle if it is the same everywhere.
      std::vector<double>
      closest_angles(const Circle &circle) const
      {
        constexpr double flat = 1e-12, turn = 2. * dealii::numbers::PI;
        const auto look = [&](const double angle) {
          const auto there   = other(circle.seen_from(angle));
          const auto tangent = Tensor<1, 3>({-std::sin(angle), std::cos(angle), 0.});
          return Sample{angle, there.distance, there.normal * tangent};
        };
        std::vector<std::pair<double, double>> found;
        for (const auto &valley : valleys(look, 16, true, turn, turn * circle.r, flat))
          {
            // Against a plane the slope is a sine, whose root is known without searching.
            const auto n_there = other(circle.seen_from(valley.low)).normal;
            double angle       = std::atan2(-n_there[1], -n_there[0]);
            if (angle < valley.low)
              angle += turn;
            if (angle > valley.high || std::abs(look(angle).slope) > 1e-15)
              angle = root(look, valley);
            found.emplace_back(look(angle).distance, angle);
          }
        if (found.empty())
          found.emplace_back(0., 0.);
        std::sort(found.begin(), found.end());
        std::vector<double> angles;
        angles.reserve(found.size());
        for (const auto &[distance, angle] : found)
          angles.push_back(angle);
        return angles;
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
    Collector(other, within, R, points).add(0, 0, Tensor<1, 3>());
  }


  // The rims, and the side as the axis blown up by the radius: between the ends the other shape's
  // normal at the closest point is across the axis. What has a feature there tells it itself.
  void
  RoundBarShape::touch_points(const DistanceField &other,
                              const double within,
                              std::vector<TouchPoint> &points) const
  {
    const double core = R - edge;
    double h          = half_length - edge;
    if (std::isinf(h))
      h = 1e3 * R;
    else
      for (const double side : {-1., 1.})
        {
          const double depth = edge > 0. ? 0. : inset * std::min(R, half_length);
          Collector(other, within, edge, points)
            .add_circle(side < 0. ? 0 : 1, side * h, core, {{depth, side * depth}});
        }
    const std::size_t n_points = points.size();
    Collector(other, within, R, points)
      .add_line(2, Tensor<1, 3>({0., 0., -h}), Tensor<1, 3>({0., 0., h}));
    points.erase(std::remove_if(points.begin() + n_points,
                                points.end(),
                                [](const TouchPoint &point) { return point.other.on_feature; }),
                 points.end());
  }


  void
  BlockShape::touch_points(const DistanceField &other,
                           const double within,
                           std::vector<TouchPoint> &points) const
  {
    Collector collector(other, within, edge, points);
    const double depth = edge > 0. ? 0. : inset * std::min({half[0], half[1], half[2]});
    Tensor<1, 3> core  = half;
    for (unsigned int d = 0; d < 3; ++d)
      core[d] -= edge;
    // Signs of the coordinates of a corner times lengths; without those along one edge.
    const auto outward =
      [](const unsigned int corner, const Tensor<1, 3> &lengths, const unsigned int along = 3) {
        Tensor<1, 3> x;
        for (unsigned int d = 0; d < 3; ++d)
          x[d] = d == along ? 0. : ((corner >> d) & 1 ? 1. : -1.) * lengths[d];
        return x;
      };
    const Tensor<1, 3> depths({depth, depth, depth});
    for (unsigned int i = 0; i < 8; ++i)
      collector.add(i, 0, outward(i, core), -outward(i, depths));
    unsigned int feature = 8;
    for (unsigned int d = 0; d < 3; ++d)
      for (unsigned int i = 0; i < 8; ++i)
        if (((i >> d) & 1) == 0)
          collector.add_line(feature++,
                             outward(i, core),
                             outward(i | (1u << d), core),
                             -outward(i, depths, d));
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
      collector.add(v, 0, mesh.vertices[v]);
    for (unsigned int i = 0; i < sharp_edges.size(); ++i)
      collector.add_line(mesh.vertices.size() + i,
                         mesh.vertices[sharp_edges[i].ends[0]],
                         mesh.vertices[sharp_edges[i].ends[1]]);
  }
} // namespace akmon
