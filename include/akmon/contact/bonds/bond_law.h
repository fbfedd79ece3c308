#pragma once

#include <deal.II/base/tensor.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace akmon
{
  /**
   * Strength of a bond, with the quadratic interaction
   *
   *     phi^2 = (<t_n>/N)^2 + (t_s/S)^2 <= r^2 ,      <t_n> = max(0, t_n) ,
   *
   * and linear softening: a failing bond holds r = sqrt(1 - w/G) of its strength when it has taken
   * the energy w per area, which for tension or shear alone is a traction that falls linearly with
   * the opening, to nothing at 2 G/N or 2 G/S, in any mode after the energy G exactly.
   */
  struct BondLaw
  {
    double normal_strength = std::numeric_limits<double>::infinity(); ///< N; stress
    double shear_strength  = std::numeric_limits<double>::infinity(); ///< S; stress
    double fracture_energy = 0.;                                      ///< G; energy/area

    bool
    breaks() const
    {
      return std::isfinite(normal_strength) || std::isfinite(shear_strength);
    }

    /// phi of a traction that @p normal points along in tension.
    double
    utilization(const dealii::Tensor<1, 3> &traction, const dealii::Tensor<1, 3> &normal) const
    {
      const double t_n = traction * normal;
      return std::hypot(std::max(0., t_n) / normal_strength,
                        (traction - t_n * normal).norm() / shear_strength);
    }

    /// r after the energy w per area has been taken.
    double
    remaining(const double w) const
    {
      return fracture_energy > 0. ? std::sqrt(std::max(0., 1. - w / fracture_energy)) : 0.;
    }

    /// The traction that a bond with r left offers against one that is too much for it: in the same
    /// direction, of a pressed bond its shear only.
    dealii::Tensor<1, 3>
    limit(const dealii::Tensor<1, 3> &traction,
          const dealii::Tensor<1, 3> &normal,
          const double r) const
    {
      const double factor = std::min(1., r / utilization(traction, normal));
      const double t_n    = traction * normal;
      return t_n > 0. ? factor * traction : t_n * normal + factor * (traction - t_n * normal);
    }
  };
} // namespace akmon
