#include <akmon/rigid/rigid_shape.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace akmon
{
  using dealii::Tensor;

  namespace
  {
    Tensor<1, 3>
    unit(const unsigned int d, const double sign = 1.)
    {
      Tensor<1, 3> e;
      e[d] = sign;
      return e;
    }


    // A point in the half plane of the z axis and x: its distance from the axis, and the direction
    // that leads away from there.
    struct Meridian
    {
      double r;
      Tensor<1, 3> outward;

      explicit Meridian(const Tensor<1, 3> &x)
        : r(std::hypot(x[0], x[1]))
        , outward(r > 0. ? Tensor<1, 3>({x[0] / r, x[1] / r, 0.}) : unit(0))
      {
      }
    };


    // Distance and normal of an orthant-shaped corner {q <= 0} in n coordinates q, blown up by a
    // radius: the common part of boxes and cylinders.
    template <std::size_t n>
    SurfacePoint
    blown_up_corner(const std::array<double, n> &q,
                    const std::array<Tensor<1, 3>, n> &directions,
                    const double radius)
    {
      const auto largest = std::max_element(q.begin(), q.end()) - q.begin();
      double square      = 0.;
      for (const double component : q)
        square += component > 0. ? component * component : 0.;
      if (square == 0.)
        return {q[largest] - radius, directions[largest]};
      Tensor<1, 3> normal;
      const double size = std::sqrt(square);
      for (std::size_t i = 0; i < n; ++i)
        if (q[i] > 0.)
          normal += (q[i] / size) * directions[i];
      const bool on_edge = std::count_if(q.begin(), q.end(), [](const double component) {
                             return component > 0.;
                           }) > 1;
      return {size - radius, normal, on_edge};
    }


    // The planes of a corner seen from inside, each within reach, but for the one closest() has.
    void
    append_from_inside(const SurfacePoint &closest,
                       const double distance,
                       const Tensor<1, 3> &outward,
                       const double within,
                       std::vector<SurfacePoint> &parts)
    {
      if (distance <= within && closest.normal * outward < 1. - 1e-12)
        parts.push_back({distance, -outward});
    }
  } // namespace


  void
  RigidShape::nearby(const Tensor<1, 3> &x,
                     const double within,
                     std::vector<SurfacePoint> &parts) const
  {
    const SurfacePoint part = closest(x);
    if (part.distance <= within)
      parts.push_back(part);
  }


  void
  RigidShape::nearby_from_inside(const Tensor<1, 3> &x,
                                 const double within,
                                 std::vector<SurfacePoint> &parts) const
  {
    const SurfacePoint part = closest(x);
    if (-part.distance <= within)
      parts.push_back({-part.distance, -part.normal});
  }


  // d = z
  SurfacePoint
  PlaneShape::closest(const Tensor<1, 3> &x) const
  {
    return {x[2], unit(2)};
  }


  MassProperties
  PlaneShape::mass_properties(const double) const
  {
    return MassProperties::infinite();
  }


  BallShape::BallShape(const double radius)
    : R(radius)
  {
  }


  // d = |x| - R
  SurfacePoint
  BallShape::closest(const Tensor<1, 3> &x) const
  {
    const double r = x.norm();
    return {r - R, r > 0. ? x / r : unit(2), true};
  }


  // m = 4/3 pi R^3 rho, I = 2/5 m R^2
  MassProperties
  BallShape::mass_properties(const double density) const
  {
    MassProperties result;
    result.mass    = 4. / 3. * dealii::numbers::PI * R * R * R * density;
    result.inertia = 0.4 * result.mass * R * R * dealii::unit_symmetric_tensor<3>();
    return result;
  }


  RoundBarShape::RoundBarShape(const double radius, const double length, const double edge_radius)
    : R(radius)
    , half_length(0.5 * length)
    , edge(edge_radius)
  {
  }


  // The cylinder of radius R - r and length L - 2r, blown up by the edge radius r.
  SurfacePoint
  RoundBarShape::closest(const Tensor<1, 3> &x) const
  {
    const Meridian meridian(x);
    return blown_up_corner<2>({{meridian.r - (R - edge), std::abs(x[2]) - (half_length - edge)}},
                              {{meridian.outward, unit(2, x[2] < 0. ? -1. : 1.)}},
                              edge);
  }


  void
  RoundBarShape::nearby_from_inside(const Tensor<1, 3> &x,
                                    const double within,
                                    std::vector<SurfacePoint> &parts) const
  {
    RigidShape::nearby_from_inside(x, within, parts);
    const SurfacePoint nearest = closest(x);
    const Meridian meridian(x);
    append_from_inside(nearest, R - meridian.r, meridian.outward, within, parts);
    for (const double side : {-1., 1.})
      append_from_inside(nearest, half_length - side * x[2], unit(2, side), within, parts);
  }


  double
  RoundBarShape::radius() const
  {
    const double core = std::hypot(R - edge, half_length - edge);
    return core + edge;
  }


  BlockShape::BlockShape(const Tensor<1, 3> &size, const double edge_radius)
    : half(0.5 * size)
    , edge(edge_radius)
  {
  }


  // The box whose edges are shorter by 2r, blown up by the edge radius r.
  SurfacePoint
  BlockShape::closest(const Tensor<1, 3> &x) const
  {
    std::array<double, 3> q;
    std::array<Tensor<1, 3>, 3> directions;
    for (unsigned int d = 0; d < 3; ++d)
      {
        q[d]          = std::abs(x[d]) - (half[d] - edge);
        directions[d] = unit(d, x[d] < 0. ? -1. : 1.);
      }
    return blown_up_corner(q, directions, edge);
  }


  void
  BlockShape::nearby_from_inside(const Tensor<1, 3> &x,
                                 const double within,
                                 std::vector<SurfacePoint> &parts) const
  {
    RigidShape::nearby_from_inside(x, within, parts);
    const SurfacePoint nearest = closest(x);
    for (unsigned int d = 0; d < 3; ++d)
      for (const double side : {-1., 1.})
        append_from_inside(nearest, half[d] - side * x[d], unit(d, side), within, parts);
  }


  double
  BlockShape::radius() const
  {
    Tensor<1, 3> core = half;
    for (unsigned int d = 0; d < 3; ++d)
      core[d] -= edge;
    return core.norm() + edge;
  }


  TorusShape::TorusShape(const double ring_radius, const double tube_radius)
    : ring(ring_radius)
    , tube(tube_radius)
  {
  }


  // The circle of the ring's radius, blown up by the tube's.
  SurfacePoint
  TorusShape::closest(const Tensor<1, 3> &x) const
  {
    const Meridian meridian(x);
    const Tensor<1, 3> from_circle = (meridian.r - ring) * meridian.outward + x[2] * unit(2);
    const double r                 = from_circle.norm();
    return {r - tube, r > 0. ? from_circle / r : unit(2), true};
  }


  // m = 2 pi^2 A a^2 rho, I_zz = m (A^2 + 3/4 a^2), I_xx = m (A^2/2 + 5/8 a^2)
  MassProperties
  TorusShape::mass_properties(const double density) const
  {
    constexpr double pi = dealii::numbers::PI;
    MassProperties result;
    result.mass     = 2. * pi * pi * ring * tube * tube * density;
    const double A2 = ring * ring, a2 = tube * tube;
    result.inertia[2][2] = result.mass * (A2 + 0.75 * a2);
    result.inertia[0][0] = result.inertia[1][1] = result.mass * (0.5 * A2 + 0.625 * a2);
    return result;
  }


  HollowShape::HollowShape(std::shared_ptr<const RigidShape> shape)
    : shape(std::move(shape))
  {
  }


  SurfacePoint
  HollowShape::closest(const Tensor<1, 3> &x) const
  {
    const SurfacePoint of_shape = shape->closest(x);
    return {-of_shape.distance, -of_shape.normal};
  }


  void
  HollowShape::nearby(const Tensor<1, 3> &x,
                      const double within,
                      std::vector<SurfacePoint> &parts) const
  {
    shape->nearby_from_inside(x, within, parts);
  }


  void
  HollowShape::nearby_from_inside(const Tensor<1, 3> &x,
                                  const double within,
                                  std::vector<SurfacePoint> &parts) const
  {
    shape->nearby(x, within, parts);
  }


  MassProperties
  HollowShape::mass_properties(const double) const
  {
    return MassProperties::infinite();
  }
} // namespace akmon
