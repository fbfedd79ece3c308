#pragma once

#include <deal.II/base/tensor.h>

namespace akmon
{
  /// Coulomb's law (8)-(11) for one pair.
  struct Coulomb
  {
    double friction_coefficient = 0.; ///< mu_c

    struct Result
    {
      dealii::Tensor<1, 3> force; ///< tangential force on the slave
      bool sticks;
    };

    /**
     * t_tau = min(mu_c |t_n|, |stick|) stick/|stick|.
     * @param stick   tangential force that would keep the pair together; force
     * @param normal  |t_n|; force
     */
    Result
    tangential_force(const dealii::Tensor<1, 3> &stick, const double normal) const
    {
      const double limit = friction_coefficient * normal, size = stick.norm();
      if (size <= limit)
        return {stick, limit > 0.};
      return {stick * (limit / size), false};
    }
  };
} // namespace akmon
