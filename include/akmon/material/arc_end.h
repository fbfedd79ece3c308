#pragma once

#include <akmon/material/tensors.h>

namespace akmon
{
  /// What one stress update tells the energy balance.
  template <typename N>
  struct StressIncrement
  {
    Symmetric3<N> strain; ///< E_mid, the strain increment on the mid configuration
    N plastic_work;       ///< of the step, per volume of configuration n+1
  };


  /**
   * ARC-end stress update of hypoelasto-plasticity with the Truesdell rate, (13)-(25), from
   * configuration n to n+1 with the mid configuration x_mid = (x_n + x_{n+1})/2:
   *
   *     F    = d x_{n+1}/d x_n = I + H            J    = det F
   *     F_m  = d x_mid/d x_n   = I + H/2          J_m  = det F_m
   *     F_me = d x_{n+1}/d x_mid = F F_m^{-1}     J_me = det F_me = J/J_m
   *     E_mid = F_m^{-T} (F^T F - I)/2 F_m^{-1} = sym(L),   L = H F_m^{-1},   F_me = I + L/2
   *
   *     sigma_trial = J^{-1} F sigma_n F^T + J_me^{-1} F_me (C : E_mid) F_me^T
   *                 = J_me^{-1} F_me (J_m^{-1} F_m sigma_n F_m^T + C : E_mid) F_me^T
   *
   * followed by the law's return to its yield surface. Second order in the step. Pure rotations and
   * changes of frame are exact to round-off; a step that stretches and turns at once is objective
   * to second order in the turn. The inverse mid map printed in the paper makes both first order
   * only; see doc/theory.md.
   *
   * @param law        constants with `elasticity` and `return_to_yield_surface(stress, internals)`
   * @param H          displacement gradient of the step on configuration n, dimensionless
   * @param J          det(I + H)
   * @param stress     Cauchy stress at n on entry, at n+1 on return
   * @param internals  the law's internal variables, same convention
   */
  template <typename Law, typename N>
  StressIncrement<N>
  arc_end_update(const Law &law,
                 const Matrix3<N> &H,
                 const N &J,
                 Symmetric3<N> &stress,
                 N *internals)
  {
    const Matrix3<N> F_m       = identity_plus(0.5, H);
    const Matrix3<N> cofactors = cofactor(F_m);
    const N inverse_J_m        = 1. / determinant(F_m, cofactors);
    const Matrix3<N> L         = times_inverse(H, cofactors, inverse_J_m);
    const Matrix3<N> F_me      = identity_plus(0.5, L);
    const N inverse_J_me       = 1. / (J * inverse_J_m);
    const Symmetric3<N> E_mid  = symmetric_part(L);
    const Symmetric3<N> at_mid = push_forward(F_m, stress, inverse_J_m) +
                                 law.elasticity.stress(E_mid);

    stress               = push_forward(F_me, at_mid, inverse_J_me);
    const N plastic_work = law.return_to_yield_surface(stress, internals);
    return {E_mid, plastic_work};
  }
} // namespace akmon
