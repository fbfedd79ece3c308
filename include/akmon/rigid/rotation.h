#pragma once

#include <deal.II/base/tensor.h>

#include <cmath>

namespace akmon
{
  /// [v x] of a vector: [v x] u = v x u.
  inline dealii::Tensor<2, 3>
  cross_matrix(const dealii::Tensor<1, 3> &v)
  {
    dealii::Tensor<2, 3> result;
    for (unsigned int d = 0; d < 3; ++d)
      {
        result[(d + 1) % 3][d] = v[(d + 2) % 3];
        result[d][(d + 1) % 3] = -v[(d + 2) % 3];
      }
    return result;
  }


  /// Calls visitor(number) for the components of a vector.
  template <typename Visitor>
  void
  visit_numbers(dealii::Tensor<1, 3> &v, const Visitor &visitor)
  {
    for (unsigned int d = 0; d < 3; ++d)
      visitor(v[d]);
  }


  /// A rotation as quaternion (w, v) of any length: it stays one however many steps are put
  /// together.
  class Orientation
  {
  public:
    /// No rotation.
    Orientation() = default;

    /// Cayley's rotation (1 - [t x]/2)^{-1} (1 + [t x]/2) of a vector t: about t by 2 atan(|t|/2).
    static Orientation
    cayley(const dealii::Tensor<1, 3> &t)
    {
      return Orientation(1., 0.5 * t);
    }

    /// Rotation about a vector by its length in radians.
    static Orientation
    about(const dealii::Tensor<1, 3> &t)
    {
      const double angle = t.norm();
      return angle > 0. ? Orientation(std::cos(0.5 * angle), std::sin(0.5 * angle) / angle * t) :
                          Orientation();
    }

    /// The shortest rotation that takes the z axis to a unit vector.
    static Orientation
    z_axis_to(const dealii::Tensor<1, 3> &n)
    {
      if (n[2] < -1. + 1e-14)
        return Orientation(0., dealii::Tensor<1, 3>({1., 0., 0.}));
      return Orientation(1. + n[2], dealii::Tensor<1, 3>({-n[1], n[0], 0.}));
    }

    /// First the other rotation, then this one.
    Orientation
    operator*(const Orientation &other) const
    {
      return Orientation(w * other.w - v * other.v,
                         w * other.v + other.w * v + cross_product_3d(v, other.v));
    }

    /// The rotation back.
    Orientation
    inverse() const
    {
      return Orientation(w, -v);
    }

    /// Cayley's vector of the rotation; infinite for half a turn.
    dealii::Tensor<1, 3>
    cayley_vector() const
    {
      return (2. / w) * v;
    }

    /// The axis of the rotation times its angle, at most pi; radians.
    dealii::Tensor<1, 3>
    rotation_vector() const
    {
      const double size = v.norm();
      if (size == 0.)
        return {};
      return (2. * std::atan2(size, std::abs(w)) / (w < 0. ? -size : size)) * v;
    }

    /// The rotation matrix.
    dealii::Tensor<2, 3>
    matrix() const
    {
      dealii::Tensor<2, 3> one;
      for (unsigned int d = 0; d < 3; ++d)
        one[d][d] = 1.;
      const auto V       = cross_matrix(v);
      const double scale = 2. / (w * w + v * v); // exact for turns by a quarter and a half
      return one + scale * (w * V + V * V);
    }

    /// Calls visitor(number) for all that makes the rotation.
    template <typename Visitor>
    void
    visit_state(const Visitor &visitor)
    {
      visitor(w);
      visit_numbers(v, visitor);
    }

  private:
    Orientation(const double w_, const dealii::Tensor<1, 3> &v_)
      : w(w_)
      , v(v_)
    {
      const double square = w * w + v * v;
      if (square < 4. && square > 0.25)
        return;
      w /= std::sqrt(square);
      v /= std::sqrt(square);
    }

    double w = 1.;
    dealii::Tensor<1, 3> v;
  };


  /// Where a rigid body is: x = place + rotation X.
  struct Pose
  {
    dealii::Tensor<1, 3> place; ///< of the body frame's origin; length
    Orientation orientation;

    template <typename Visitor>
    void
    visit_state(const Visitor &visitor)
    {
      visit_numbers(place, visitor);
      orientation.visit_state(visitor);
    }
  };
} // namespace akmon
