#pragma once

#include <deal.II/base/tensor.h>

#include <algorithm>
#include <cmath>

namespace akmon
{
  /**
   * Contact forces are vectors t = (t_n, t_tau1, t_tau2) in the frame of their pair, so that a
   * normal force of zero is zero and not what rounding leaves of it. They lie in Coulomb's cone
   *
   *     t_n >= 0,   |t_tau| <= mu t_n .
   *
   * The face of the cone that a pair is held to while a Newton step is sought: where its force is
   * free to change.
   */
  struct CoulombFace
  {
    using Force = dealii::Tensor<1, 3>;

    enum class Tangential
    {
      none,   ///< no friction, or no normal force to allow any
      circle, ///< slip: t_tau = mu t_n d, and turning along the circle
      disc    ///< stick: all of the contact plane
    };

    bool normal           = false; ///< else t_n = 0
    Tangential tangential = Tangential::none;
    Force slip;            ///< unit vector d of the tangential force on the circle
    Force along;           ///< unit vector along the circle
    double curvature = 0.; ///< what turning adds to the Jacobian along the circle
    double mu        = 0.; ///< what the tangential force on the circle grows by with t_n

    static double
    tangential_size(const Force &t)
    {
      return std::sqrt(t[1] * t[1] + t[2] * t[2]);
    }

    /// The closest force with t_n >= 0 and |t_tau| <= radius.
    static Force
    project(const Force &t, const double radius)
    {
      const double size   = tangential_size(t);
      const double factor = size > radius ? radius / size : 1.;
      return Force({std::max(t[0], 0.), factor * t[1], factor * t[2]});
    }

    /**
     * The face that the predictor q = t - rho w tells, w the relative motion with the forces t: a
     * pair is closed if q_n > 0, and slips along d = q_tau/|q_tau| if |q_tau| >= r (Alart and
     * Curnier, Comput. Methods Appl. Mech. Eng. 92, 1991). Turning the force along the circle
     * turns it out of the way by (|q_tau| - r)/r, which is the curvature times rho.
     * @param r   the friction limit: mu q_n, or one that is given
     * @param mu  derivative of the limit with respect to the normal force
     */
    static CoulombFace
    predicted_by(const Force &q, const double r, const double mu, const double rho)
    {
      CoulombFace face;
      face.normal = q[0] > 0.;
      if (!(r > 0.))
        return face;
      const double size = tangential_size(q);
      face.tangential   = size < r ? Tangential::disc : Tangential::circle;
      if (face.tangential == Tangential::disc)
        return face;
      face.mu        = mu;
      face.slip      = Force({0., q[1] / size, q[2] / size});
      face.along     = Force({0., -q[2] / size, q[1] / size});
      face.curvature = (size - r) / (r * rho);
      return face;
    }

    /// A force taken to the face, with the friction limit r.
    Force
    settle(const Force &t, const double r) const
    {
      Force result = tangential == Tangential::disc ? t : r * slip;
      result[0]    = normal ? t[0] : 0.;
      return result;
    }

    /// The free components of a vector: those along the normal and along the circle, or all.
    Force
    restrict_to(const Force &v) const
    {
      Force result;
      if (tangential == Tangential::disc)
        result = v;
      else if (tangential == Tangential::circle)
        result = (along * v) * along;
      result[0] = normal ? v[0] : 0.;
      return result;
    }

    /// What a change p of the free components changes the force by.
    Force
    lift(const Force &p) const
    {
      return p + (p[0] * mu) * slip;
    }
  };


  /// Whether what is a good step or factor for one face is so for another.
  inline bool
  alike(const CoulombFace &a, const CoulombFace &b)
  {
    constexpr double turned = 0.9999, stiffened = 1.01, rougher = 0.03; // cosine; ratio; friction

    if (a.normal != b.normal || a.tangential != b.tangential)
      return false;
    if (a.tangential != CoulombFace::Tangential::circle)
      return true;
    const double ratio = (1. + a.curvature) / (1. + b.curvature);
    return a.along * b.along > turned && std::abs(a.mu - b.mu) < rougher && ratio < stiffened &&
           ratio > 1. / stiffened;
  }
} // namespace akmon
