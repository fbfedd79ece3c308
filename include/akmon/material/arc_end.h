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
   * configuration n to n+1 with the mid configuration x_mid = (x_n + x_{n+1})/2. All of it follows
   * from the displacement gradient of the step on the mid configuration,
   *
   *     L     = d(x_{n+1} - x_n)/d x_mid
   *     F_m   = d x_mid/d x_n     = A^{-1},   A = I - L/2      J_m  = det F_m = 1/det A
   *     F_me  = d x_{n+1}/d x_mid = I + L/2                    J_me = det F_me = J/J_m
   *     E_mid = F_m^{-T} (F^T F - I)/2 F_m^{-1} = sym(L),      F = F_me F_m
   *
   *     sigma_trial = J^{-1} F sigma_n F^T + J_me^{-1} F_me (C : E_mid) F_me^T
   *                 = J_me^{-1} F_me (J_m^{-1} F_m sigma_n F_m^T + C : E_mid) F_me^T
   *
   * where J_m^{-1} F_m sigma_n F_m^T = cof(A)^T sigma_n cof(A) / det A needs no inverse. The law's
   * return to its yield surface follows. Second order in the step. Pure rotations and changes of
   * frame are exact to round-off; a step that stretches and turns at once is objective to second
   * order in the turn. The inverse mid map printed in the paper makes both first order only; see
   * doc/theory.md.
   *
   * @param law        constants with `elasticity` and `return_to_yield_surface(stress, internals)`
   * @param L          displacement gradient of the step on the mid configuration, dimensionless
   * @param J          det F of the step
   * @param stress     Cauchy stress at n on entry, at n+1 on return
   * @param internals  the law's internal variables, same convention
   */
  template <typename Law, typename N>
  [[gnu::always_inline]] inline StressIncrement<N>
  arc_end_update_from_mid(const Law &law,
                          const Matrix3<N> &L,
                          const N &J,
                          Symmetric3<N> &stress,
                          N *internals)
  {
    const Matrix3<N> A         = identity_plus(-0.5, L);
    const Matrix3<N> cofactors = cofactor(A);
    const N det_A              = determinant(A, cofactors);
    const N inverse_J_me       = 1. / (J * det_A);
    const N J_m                = J * inverse_J_me;
    const Symmetric3<N> E_mid  = symmetric_part(L);
    const Symmetric3<N> at_mid = push_forward(transpose(cofactors), stress, J_m) +
                                 law.elasticity.stress(E_mid);

    stress               = push_forward(identity_plus(0.5, L), at_mid, inverse_J_me);
    const N plastic_work = law.return_to_yield_surface(stress, internals);
    return {E_mid, plastic_work};
  }


  /**
   * The same from the displacement gradient H = F - I on configuration n: L = H (I + H/2)^{-1}.
   * @param H  displacement gradient of the step on configuration n, dimensionless
   * @param J  det(I + H)
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
    const Matrix3<N> L         = times_inverse(H, cofactors, N(1. / determinant(F_m, cofactors)));
    return arc_end_update_from_mid(law, L, J, stress, internals);
  }
} // namespace akmon
