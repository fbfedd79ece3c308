#pragma once

#include <deal.II/base/tensor.h>

#include <cmath>

namespace akmon
{
  /// Coulomb's law (8)-(11) for one pair, with a coefficient that may decay from static to kinetic.
  struct Coulomb
  {
    double static_coefficient  = 0.; ///< mu_s (the paper's mu_c)
    double kinetic_coefficient = 0.; ///< mu_k
    double decay               = 0.; ///< d, time/length

    /// mu = mu_k + (mu_s - mu_k) exp(-d |v|), v the slip velocity.
    double
    coefficient(const double slip_speed) const
    {
      return kinetic_coefficient +
             (static_coefficient - kinetic_coefficient) * std::exp(-decay * slip_speed);
    }

    struct Result
    {
      dealii::Tensor<1, 3> force; ///< tangential force on the slave
      bool sticks;
    };

    /**
     * t_tau = min(mu |t_n|, |stick|) stick/|stick|.
     * @param stick  tangential force that would keep the pair together; force
     * @param limit  mu |t_n|; force
     */
    static Result
    tangential_force(const dealii::Tensor<1, 3> &stick, const double limit)
    {
      const double size = stick.norm();
      if (size <= limit)
        return {stick, limit > 0.};
      return {stick * (limit / size), false};
    }
  };
} // namespace akmon
