#pragma once

#include <akmon/forces/cell_kernel.h>
#include <akmon/material/elasticity.h>
#include <akmon/model/body.h>

#include <cmath>

namespace akmon
{
  /**
   * Volume of a trilinear hexahedron and its exact gradient b_a = dV/dx_a = int grad N_a dV, the
   * mean B-matrix of the cell times its volume (Flanagan and Belytschko 1981): the derivative
   * of hexahedron_volume().
   */
  template <typename N>
  struct VolumeGradient
  {
    N b[8][3]; ///< length^2
    N volume;

    explicit VolumeGradient(const N (&x)[8][3])
    {
      N e[3][3], f[3][3]; // x_6, x_5, x_3 seen from x_0 and x_7 seen from x_1, x_2, x_4
      for (unsigned int c = 0; c < 3; ++c)
        for (unsigned int i = 0; i < 3; ++i)
          {
            e[i][c] = x[from_origin[i]][c] - x[0][c];
            f[i][c] = x[7][c] - x[to_opposite[i]][c];
          }
      // 12 V = [f0+e0, f1, e2] + [e0, f1+e1, f2] + [f0, e1, f2+e2], each term differentiated
      N by_e[3][3], by_f[3][3];
      for (unsigned int c = 0; c < 3; ++c)
        for (unsigned int i = 0; i < 3; ++i)
          by_e[i][c] = by_f[i][c] = N(0.);
      add_cross(f[1], e[2], by_e[0], by_f[0]);
      add_cross(f[2], e[0], by_e[1], by_f[1]);
      add_cross(f[0], e[1], by_e[2], by_f[2]);
      N sum[3][3];
      for (unsigned int c = 0; c < 3; ++c)
        for (unsigned int i = 0; i < 3; ++i)
          sum[i][c] = e[i][c] + f[i][c];
      add_cross(sum[1], f[2], by_e[0]);
      add_cross(e[1], sum[2], by_f[0]);
      add_cross(sum[2], f[0], by_e[1]);
      add_cross(e[2], sum[0], by_f[1]);
      add_cross(sum[0], f[1], by_e[2]);
      add_cross(e[0], sum[1], by_f[2]);

      volume = N(0.);
      for (unsigned int c = 0; c < 3; ++c)
        {
          b[0][c] = b[7][c] = N(0.);
          for (unsigned int i = 0; i < 3; ++i)
            {
              const N of_e = by_e[i][c] * (1. / 12.), of_f = by_f[i][c] * (1. / 12.);
              volume += (1. / 3.) * (e[i][c] * of_e + f[i][c] * of_f);
              b[from_origin[i]][c] = of_e;
              b[to_opposite[i]][c] = -of_f;
              b[0][c] -= of_e;
              b[7][c] += of_f;
            }
        }
    }

    /// sum_a b_a . b_a, length^4; 3/2 h^4 for a cube
    N
    square() const
    {
      N sum(0.);
      for (unsigned int v = 0; v < 8; ++v)
        sum += b[v][0] * b[v][0] + b[v][1] * b[v][1] + b[v][2] * b[v][2];
      return sum;
    }

  private:
    static constexpr unsigned int from_origin[3] = {6, 5, 3}, to_opposite[3] = {1, 2, 4};

    static void
    add_cross(const N (&a)[3], const N (&c)[3], N (&to)[3])
    {
      to[0] += a[1] * c[2] - a[2] * c[1];
      to[1] += a[2] * c[0] - a[0] * c[2];
      to[2] += a[0] * c[1] - a[1] * c[0];
    }

    static void
    add_cross(const N (&a)[3], const N (&c)[3], N (&to)[3], N (&and_to)[3])
    {
      N cross[3] = {N(0.), N(0.), N(0.)};
      add_cross(a, c, cross);
      for (unsigned int i = 0; i < 3; ++i)
        {
          to[i] += cross[i];
          and_to[i] += cross[i];
        }
    }
  };


  /// Nodal values against the four hourglass patterns eta zeta, xi zeta, xi eta, xi eta zeta:
  /// sums[pattern][component].
  template <typename N>
  void
  hourglass_sums(const N (&u)[8][3], N (&sums)[4][3])
  {
    for (unsigned int c = 0; c < 3; ++c)
      {
        N along[4], across[4]; // both ends of the four edges in direction xi
        for (unsigned int edge = 0; edge < 4; ++edge)
          {
            along[edge]  = u[2 * edge + 1][c] + u[2 * edge][c];
            across[edge] = u[2 * edge + 1][c] - u[2 * edge][c];
          }
        sums[0][c] = (along[0] - along[1]) - (along[2] - along[3]);
        sums[1][c] = (across[2] + across[3]) - (across[0] + across[1]);
        sums[2][c] = (across[1] - across[0]) + (across[3] - across[2]);
        sums[3][c] = (across[0] - across[1]) - (across[2] - across[3]);
      }
  }


  /// The transpose: add to nodal values each pattern times its force.
  template <typename N>
  void
  add_hourglass_patterns(const N (&forces)[4][3], N (&f)[8][3])
  {
    for (unsigned int c = 0; c < 3; ++c)
      for (unsigned int edge = 0; edge < 4; ++edge)
        {
          const bool eta = edge & 1, zeta = edge >> 1;
          const N along  = eta == zeta ? forces[0][c] : N(-forces[0][c]);
          const N linear = (zeta ? forces[1][c] : N(-forces[1][c])) +
                           (eta ? forces[2][c] : N(-forces[2][c]));
          const N across = eta == zeta ? N(linear + forces[3][c]) : N(linear - forces[3][c]);
          f[2 * edge][c] += along - across;
          f[2 * edge + 1][c] += along + across;
        }
  }


  /**
   * Hourglass control of Flanagan and Belytschko (1981) for the constants of one body and step.
   * With gamma_a = Gamma_a - sum_j (Gamma . x_j) b_ja/V, orthogonal to every uniform strain, and
   * g_i = gamma . dx_i the motion of the step in a pattern, the nodal forces f_ia = Q_i gamma_a
   * have per pattern and component
   *
   *     stiffness:  Q = beta (R Q_n + kappa (lambda + 2 mu) B g/(8 V)),     B = sum_a b_a . b_a
   *
   *     viscous:    Q = kappa rho c_d sqrt(2 B/3) g/(4 dt)
   *
   * R is the rotation of the step and beta the part of the trial stress deviator that the law's
   * return left. Springs that do not yield with the cell lock: the Taylor bar then ends as with
   * full integration. The viscous form is LS-DYNA's with coefficient kappa: Q h^2 rho c/4 for a
   * cube of edge h.
   */
  struct HourglassConstants
  {
    HourglassConstants(const HourglassControl control,
                       const double coefficient,
                       const Elasticity &elasticity,
                       const double density,
                       const double dt)
    {
      const double modulus = elasticity.lambda + 2. * elasticity.mu;
      if (control == HourglassControl::stiffness)
        stiffness = coefficient * modulus / 8.;
      else
        viscosity = coefficient * std::sqrt(density * modulus) / (4. * dt);
    }

    double stiffness = 0.; ///< stress
    double viscosity = 0.; ///< stress/length
  };


  /// Keeps the ratio of two stresses defined where there is none; no physical stress is smaller.
  inline constexpr double smallest_stress_squared = 1e-280;


  /// Turn vectors by the rotation of the step, R = (I - W/2)^{-1} (I + W/2) with W = skew(L): exact
  /// for rigid rotations.
  template <typename N>
  void
  rotate_with_step(const Matrix3<N> &L, N (&vectors)[4][3])
  {
    const N h[3]   = {0.25 * (L(2, 1) - L(1, 2)),
                      0.25 * (L(0, 2) - L(2, 0)),
                      0.25 * (L(1, 0) - L(0, 1))}; // half of W's axis
    const N factor = 2. / (1. + h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
    for (auto &v : vectors)
      {
        const N t[3] = {h[1] * v[2] - h[2] * v[1],
                        h[2] * v[0] - h[0] * v[2],
                        h[0] * v[1] - h[1] * v[0]};
        v[0] += factor * (t[0] + (h[1] * t[2] - h[2] * t[1]));
        v[1] += factor * (t[1] + (h[2] * t[0] - h[0] * t[2]));
        v[2] += factor * (t[2] + (h[0] * t[1] - h[1] * t[0]));
      }
  }


  /**
   * The hourglass forces Q of a batch from n to n+1.
   * @param left    part of the trial stress deviator that the law's return left: springs yield as
   * the cell does
   * @param motion  g of the step [pattern][component]
   * @param Q       [pattern][component][lane] of this batch, memory; force
   * @param at_end  the new ones
   * @return        their work in the step, energy
   */
  template <typename N>
  [[gnu::always_inline]] inline N
  update_hourglass_forces(const HourglassConstants &constants,
                          const Matrix3<N> &L,
                          const N &left,
                          const N (&motion)[4][3],
                          const VolumeGradient<N> &end,
                          double *Q,
                          N (&at_end)[4][3])
  {
    const N square = end.square(), stiffness = constants.stiffness * (square / end.volume);
    const N viscosity = constants.viscosity * square_root(square * (2. / 3.));
    for (unsigned int a = 0; a < 4; ++a)
      for (unsigned int i = 0; i < 3; ++i)
        load(Q + (3 * a + i) * n_lanes_of<N>, at_end[a][i]);
    rotate_with_step(L, at_end);
    N work(0.);
    for (unsigned int a = 0; a < 4; ++a)
      for (unsigned int i = 0; i < 3; ++i)
        {
          const N viscous = viscosity * motion[a][i];
          const N after   = left * (at_end[a][i] + stiffness * motion[a][i]);
          work += (0.5 * (at_end[a][i] + after) + viscous) * motion[a][i];
          store(after, Q + (3 * a + i) * n_lanes_of<N>);
          at_end[a][i] = after + viscous;
        }
    return work;
  }


  /**
   * One step of a batch of one-point cells with hourglass control: the mean displacement gradient
   * on the mid configuration, L = (1/V_mid) sum_a dx_a (x) b_a(x_mid), one stress update with J =
   * V_{n+1}/V_n, and the nodal forces f_a = sigma b_a(x_{n+1}) + hourglass forces.
   *
   * @param x, dx      x_{n+1} and dx_n [node][component], length
   * @param owned      per lane, 1 where the cell counts in the sums
   * @param state      [component][lane] of this batch, from n to n+1
   * @param hourglass  Q [pattern][component][lane] of this batch, from n to n+1; force
   * @param force      internal forces of the cells' nodes
   */
  template <typename Law, typename N>
  CellStep<N>
  update_one_point_cell(const Law &law,
                        const HourglassConstants &constants,
                        const N (&x)[8][3],
                        const N (&dx)[8][3],
                        const N &owned,
                        double *state,
                        double *hourglass,
                        CellPassSums<N> &sums,
                        N (&force)[8][3])
  {
    N x_mid[8][3], x_begin[8][3];
    for (unsigned int v = 0; v < 8; ++v)
      for (unsigned int c = 0; c < 3; ++c)
        {
          x_mid[v][c]   = x[v][c] - 0.5 * dx[v][c];
          x_begin[v][c] = x[v][c] - dx[v][c];
        }
    const VolumeGradient<N> mid(x_mid), end(x);
    const N volume_begin = hexahedron_volume(x_begin), inverse_mid = 1. / mid.volume;
    Matrix3<N> L;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        {
          L(i, j) = N(0.);
          for (unsigned int v = 0; v < 8; ++v)
            L(i, j) += dx[v][i] * mid.b[v][j];
          L(i, j) *= inverse_mid;
        }

    Symmetric3<N> stress;
    for (unsigned int c = 0; c < 6; ++c)
      load(state + c * n_lanes_of<N>, stress[c]);
    N internals[Law::n_internals + 1]; // one more than used: no array has length zero
    for (unsigned int i = 0; i < Law::n_internals; ++i)
      load(state + (6 + i) * n_lanes_of<N>, internals[i]);
    const Symmetric3<N> strain = symmetric_part(L);
    const N work_before        = volume_begin * contract(stress, strain);
    const N plastic            = arc_end_update_from_mid(law,
                                              L,
                                              N(end.volume / volume_begin),
                                              stress,
                                              internals)
                        .plastic_work;
    for (unsigned int c = 0; c < 6; ++c)
      store(stress[c], state + c * n_lanes_of<N>);
    for (unsigned int i = 0; i < Law::n_internals; ++i)
      store(internals[i], state + (6 + i) * n_lanes_of<N>);
    sums.internal_work += owned * (0.5 * (work_before + end.volume * contract(stress, strain)));
    sums.plastic_work += owned * (end.volume * plastic);

    // With q = q_trial - 3 mu d_eps and the plastic work q d_eps the return leaves q/q_trial of the
    // deviator.
    const N q_squared = equivalent_stress_squared(stress);
    const N left      = (q_squared + smallest_stress_squared) /
                   (q_squared + 3. * law.elasticity.mu * plastic + smallest_stress_squared);

    // gamma . dx on the mid configuration, where L holds sum_a dx_a (x) b_a/V
    N motion[4][3], patterns[4][3], Q[4][3], motion_squared(0.);
    hourglass_sums(x_mid, patterns);
    hourglass_sums(dx, motion);
    for (unsigned int a = 0; a < 4; ++a)
      {
        const N at_mid[3] = {patterns[a][0], patterns[a][1], patterns[a][2]};
        for (unsigned int i = 0; i < 3; ++i)
          {
            patterns[a][i] += 0.5 * motion[a][i]; // now those of x_{n+1}
            motion[a][i] -= L(i, 0) * at_mid[0] + L(i, 1) * at_mid[1] + L(i, 2) * at_mid[2];
            motion_squared += motion[a][i] * motion[a][i];
          }
      }
    sums.hourglass_work += owned *
                           update_hourglass_forces(constants, L, left, motion, end, hourglass, Q);

    const N inverse_end = 1. / end.volume;
    Matrix3<N> weight; // sigma - sum Q (x) (Gamma . x)/V
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        weight(i, j) = stress[i == j ? i : i + j + 2] -
                       inverse_end * (Q[0][i] * patterns[0][j] + Q[1][i] * patterns[1][j] +
                                      Q[2][i] * patterns[2][j] + Q[3][i] * patterns[3][j]);
    for (unsigned int v = 0; v < 8; ++v)
      for (unsigned int i = 0; i < 3; ++i)
        force[v][i] = weight(i, 0) * end.b[v][0] + weight(i, 1) * end.b[v][1] +
                      weight(i, 2) * end.b[v][2];
    add_hourglass_patterns(Q, force);

    // In a pattern with amplitude g/8 the strain at the corners of a cube is g/(4 h), 1/h^2 = (2/3)
    // B/V^2.
    const N strain_squared = contract(strain, strain) + (1. / 24.) * motion_squared * end.square() *
                                                          (inverse_end * inverse_end);
    return {strain_squared, end.volume};
  }
} // namespace akmon
