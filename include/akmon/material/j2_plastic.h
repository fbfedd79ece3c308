#pragma once

#include <akmon/material/elasticity.h>
#include <akmon/simd.h>

#include <deal.II/base/parameter_handler.h>

#include <string>

namespace akmon
{
  /**
   * Von Mises plasticity with linear isotropic hardening,
   *
   *     F(sigma) = q - y <= 0,   q = sqrt(3/2) |dev sigma|,   y = sigma_y + h' eps_p.
   *
   * Internal variable: the equivalent plastic strain eps_p.
   */
  struct J2Plastic
  {
    static constexpr const char *name         = "j2";
    static constexpr unsigned int n_internals = 1;

    Elasticity elasticity;
    double yield_stress      = 0; ///< sigma_y, stress
    double hardening_modulus = 0; ///< h' = d sigma_y / d eps_p, stress

    static void
    declare(dealii::ParameterHandler &prm)
    {
      prm.declare_entry("Yield stress",
                        "0",
                        dealii::Patterns::Double(0.),
                        "Initial yield stress sigma_y (stress; law j2)");
      prm.declare_entry("Hardening modulus",
                        "0",
                        dealii::Patterns::Double(0.),
                        "Linear isotropic hardening h', the slope of yield stress over equivalent "
                        "plastic strain (stress; law j2)");
    }

    /// Throws InputError unless the yield stress is positive.
    void
    parse(dealii::ParameterHandler &prm, const std::string &section);

    /**
     * Radial return of the trial stress to the yield surface (25), closed form for linear
     * hardening:
     *
     *     d_eps = max(0, q - y) / (3 mu + h'),   dev sigma = (1 - 3 mu d_eps / q) dev sigma_trial.
     *
     * Updates @p stress and @p internals[0] = eps_p; returns the plastic work of the step per
     * current volume, with the yield stress at the middle of the step.
     */
    template <typename N>
    [[gnu::always_inline]] inline N
    return_to_yield_surface(Symmetric3<N> &stress, N *internals) const
    {
      // Guards the division where there is no stress at all; no physical equivalent stress is
      // smaller.
      constexpr double tiny = 1e-150;

      const Symmetric3<N> deviator = add_to_diagonal(stress, N(trace(stress) * (-1. / 3.)));
      const N q                    = square_root(1.5 * contract(deviator, deviator));
      const N y                    = yield_stress + hardening_modulus * internals[0];
      const N d_eps = maximum(q - y, N(0.)) * (1. / (3. * elasticity.mu + hardening_modulus));
      const N part  = 3. * elasticity.mu * d_eps / maximum(q, N(tiny));

      for (unsigned int i = 0; i < 6; ++i)
        stress[i] -= part * deviator[i];
      internals[0] += d_eps;
      return (y + 0.5 * hardening_modulus * d_eps) * d_eps;
    }
  };
} // namespace akmon
