#pragma once

#include <akmon/forces/cell_batches.h>
#include <akmon/forces/trilinear.h>
#include <akmon/material/arc_end.h>
#include <akmon/simd.h>

namespace akmon
{
  /// Sums over the cells of a rank of what one pass did, one entry per SIMD lane.
  struct CellPassSums
  {
    Lanes internal_work = Lanes(0.); ///< stress power of the step, energy
    Lanes plastic_work  = Lanes(0.); ///< its plastic part, energy
  };


  /// Nodal values of a batch, gathered lane by lane from an interleaved nodal vector.
  inline void
  gather(const double *vector, const CellBatches::NodeOffsets &nodes, Lanes (&values)[8][3])
  {
    alignas(lane_alignment) double buffer[8][3][n_lanes];
    for (unsigned int v = 0; v < 8; ++v)
      for (unsigned int lane = 0; lane < n_lanes; ++lane)
        {
          const double *const node = vector + nodes[v][lane];
          buffer[v][0][lane]       = node[0];
          buffer[v][1][lane]       = node[1];
          buffer[v][2][lane]       = node[2];
        }
    for (unsigned int v = 0; v < 8; ++v)
      for (unsigned int c = 0; c < 3; ++c)
        values[v][c] = Lanes::load_aligned(buffer[v][c]);
  }


  /// Subtract nodal values of a batch from an interleaved nodal vector, cell after cell: the sums
  /// at a node then always run in global cell order.
  inline void
  scatter_subtract(const Lanes (&values)[8][3],
                   const CellBatches::NodeOffsets &nodes,
                   const unsigned int n_used,
                   double *vector)
  {
    alignas(lane_alignment) double buffer[8][3][n_lanes];
    for (unsigned int v = 0; v < 8; ++v)
      for (unsigned int c = 0; c < 3; ++c)
        values[v][c].store_aligned(buffer[v][c]);
    for (unsigned int lane = 0; lane < n_used; ++lane)
      for (unsigned int v = 0; v < 8; ++v)
        {
          double *const node = vector + nodes[v][lane];
          node[0] -= buffer[v][0][lane];
          node[1] -= buffer[v][1][lane];
          node[2] -= buffer[v][2][lane];
        }
  }


  /**
   * Cube root of a ratio near one by Halley's iteration y <- y (y^3 + 2r)/(2 y^3 + r), which
   * triples the correct digits each time: exact to round-off for 1/4 < r < 4, far beyond what one
   * stable step does.
   */
  template <typename N>
  N
  cube_root_near_one(const N &r)
  {
    N y = 1. + (r - 1.) * (1. / 3.);
    for (unsigned int iteration = 0; iteration < 3; ++iteration)
      {
        const N cube = y * y * y;
        y            = y * (cube + 2. * r) / (2. * cube + r);
      }
    return y;
  }


  /**
   * Geometry of a batch of cells at the end of a step: gradients of the positions x_{n+1} and of
   * the increment dx_n on the reference cell, and volumes.
   */
  template <typename N>
  struct CellGeometry
  {
    TrilinearGradients<N> end;       ///< of x_{n+1}
    TrilinearGradients<N> increment; ///< of dx_n

    static constexpr unsigned int n_points = CellBatches::n_points;

    N volume_begin, volume_end; ///< of the cell in configurations n and n+1
    N smallest_jacobian;        ///< least det(d x_{n+1} / d xi) over the Gauss points

    CellGeometry(const N (&x)[8][3], const N (&dx)[8][3])
      : end(TrilinearGradients<N>::evaluate(x))
      , increment(TrilinearGradients<N>::evaluate(dx))
      , volume_begin(0.)
      , volume_end(0.)
    {
      for (unsigned int q = 0; q < n_points; ++q)
        {
          const Matrix3<N> J1 = end.at(q), J0 = begin_at(q);
          const N j1 = determinant(J1, cofactor(J1));
          volume_end += j1;
          volume_begin += determinant(J0, cofactor(J0));
          smallest_jacobian = q == 0 ? j1 : select(j1 < smallest_jacobian, j1, smallest_jacobian);
        }
    }

    /// d x_n / d xi at Gauss point q.
    Matrix3<N>
    begin_at(const unsigned int q) const
    {
      const Matrix3<N> J1 = end.at(q), dJ = increment.at(q);
      Matrix3<N> J0;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          J0(i, j) = J1(i, j) - dJ(i, j);
      return J0;
    }
  };


  /**
   * One step of a batch: stress update at every Gauss point, then nodal forces
   *
   *     f_a = int_{Omega_{n+1}} sigma_{n+1} grad N_a dOmega .
   *
   * With mean dilatation the increment is F_bar = (J_mean / J)^{1/3} F, J_mean = V_{n+1}/V_n, and
   * the pressure works on the cell's mean volume change: f_a = sum_q w (dev sigma + p_mean I) cof(d
   * x/d xi) dN_a/d xi, p_mean V = sum_q w det(d x/d xi) p_q (Nagtegaal, Parks and Rice 1974; Hughes
   * 1980).
   *
   * @param state  [q][component][lane] of this batch, from n to n+1
   * @param owned  per lane, 1 where the cell counts in the sums
   * @return       largest E_mid : E_mid over the Gauss points
   */
  template <bool mean_dilatation, typename Law>
  Lanes
  update_stress_and_force(const Law &law,
                          const CellGeometry<Lanes> &cell,
                          const Lanes &owned,
                          double *state,
                          CellPassSums &sums,
                          Lanes (&force)[8][3])
  {
    constexpr unsigned int n_components = Symmetric3<Lanes>::n_components + Law::n_internals;
    constexpr unsigned int n_points     = CellBatches::n_points;

    const Lanes mean_J = cell.volume_end / cell.volume_begin;
    Lanes pressure_volume(0.), internal_work(0.), plastic_work(0.), strain_squared(0.);
    for (unsigned int q = 0; q < n_points; ++q)
      {
        double *const point = state + q * n_components * n_lanes;

        const Matrix3<Lanes> J0 = cell.begin_at(q), J1 = cell.end.at(q);
        const Matrix3<Lanes> cofactors_J0 = cofactor(J0);
        const Lanes j0                    = determinant(J0, cofactors_J0);
        const Lanes j1                    = determinant(J1, cofactor(J1));

        Matrix3<Lanes> H = times_inverse(cell.increment.at(q), cofactors_J0, Lanes(1. / j0));
        Lanes J          = j1 / j0;
        if constexpr (mean_dilatation)
          {
            const Lanes scale = cube_root_near_one(Lanes(mean_J / J));
            for (unsigned int i = 0; i < 3; ++i)
              for (unsigned int j = 0; j < 3; ++j)
                H(i, j) = i == j ? scale * H(i, j) + (scale - 1.) : scale * H(i, j);
            J = mean_J;
          }

        Symmetric3<Lanes> stress, stress_before;
        for (unsigned int c = 0; c < 6; ++c)
          stress_before[c] = stress[c] = Lanes::load_aligned(point + c * n_lanes);
        Lanes internals[Law::n_internals + 1]; // one more than used: no array has length zero
        for (unsigned int i = 0; i < Law::n_internals; ++i)
          internals[i] = Lanes::load_aligned(point + (6 + i) * n_lanes);

        const auto increment = arc_end_update(law, H, J, stress, internals);

        for (unsigned int c = 0; c < 6; ++c)
          stress[c].store_aligned(point + c * n_lanes);
        for (unsigned int i = 0; i < Law::n_internals; ++i)
          internals[i].store_aligned(point + (6 + i) * n_lanes);

        pressure_volume += j1 * trace(stress) * (1. / 3.);
        internal_work += 0.5 * (j0 * contract(stress_before, increment.strain) +
                                j1 * contract(stress, increment.strain));
        plastic_work += j1 * increment.plastic_work;
        strain_squared = maximum(strain_squared, contract(increment.strain, increment.strain));
      }
    sums.internal_work += owned * internal_work;
    sums.plastic_work += owned * plastic_work;

    const Lanes mean_pressure = pressure_volume / cell.volume_end;
    TrilinearGradients<Lanes> weights;
    weights.clear();
    for (unsigned int q = 0; q < n_points; ++q)
      {
        const double *const point = state + q * n_components * n_lanes;
        Symmetric3<Lanes> stress;
        for (unsigned int c = 0; c < 6; ++c)
          stress[c] = Lanes::load_aligned(point + c * n_lanes);
        if constexpr (mean_dilatation)
          stress = add_to_diagonal(stress, Lanes(mean_pressure - trace(stress) * (1. / 3.)));
        weights.add(q, stress * cofactor(cell.end.at(q)));
      }
    weights.integrate(force);
    return strain_squared;
  }
} // namespace akmon
