#pragma once

#include <akmon/forces/cell_batches.h>
#include <akmon/forces/trilinear.h>
#include <akmon/material/arc_end.h>
#include <akmon/simd.h>

#include <cstdint>
#include <utility>

namespace akmon
{
  /// Sums over the cells of a rank of what one pass did, one entry per SIMD lane.
  template <typename N>
  struct CellPassSums
  {
    N internal_work  = N(0.); ///< stress power of the step, energy
    N plastic_work   = N(0.); ///< its plastic part, energy
    N hourglass_work = N(0.); ///< of the hourglass control of one-point cells, energy
  };


  /// One entry of a nodal vector per lane. From memory right into the lanes: a detour by a buffer
  /// would wait, as vectors cannot be loaded from scalars just stored.
  template <std::size_t... lanes>
  [[gnu::always_inline]] inline Lanes
  gather(const double *vector,
         const std::uint32_t (&offsets)[n_lanes],
         const std::index_sequence<lanes...> &)
  {
    return Lanes{vector[offsets[lanes]]...};
  }


  /// Nodal values of a batch, gathered lane by lane from an interleaved nodal vector. Nothing is
  /// fetched ahead: cells follow a space-filling curve, so most nodes were used just before.
  [[gnu::always_inline]] inline void
  gather(const double *vector, const CellBatches::NodeOffsets &nodes, Lanes (&values)[8][3])
  {
    for (unsigned int v = 0; v < 8; ++v)
      for (unsigned int c = 0; c < 3; ++c)
        values[v][c] = gather(vector + c, nodes[v], std::make_index_sequence<n_lanes>());
  }


  /// Ask for what the next batch reads and writes, so many doubles.
  inline void
  prefetch(const double *from, const std::size_t n)
  {
    for (std::size_t i = 0; i < n; i += n_lanes)
      __builtin_prefetch(from + i, 1);
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
   * Cube root of a ratio near one, by the iteration z <- z (1 + h/3 + 2 h^2/9), h = 1 - r z^3, for
   * the inverse cube root, which triples the correct digits each time and needs no division. Exact
   * to round-off for 1/2 < r < 2, to seven digits for 1/5 < r < 5; one stable step changes the
   * ratio by a few hundredths.
   */
  template <typename N>
  [[gnu::always_inline]] inline N
  cube_root_near_one(const N &r)
  {
    N z = (2. + r) / (1. + 2. * r);
    for (unsigned int iteration = 0; iteration < 2; ++iteration)
      {
        const N h = 1. - r * (z * z * z);
        z += z * h * (1. / 3. + h * (2. / 9.));
      }
    return r * (z * z);
  }


  /**
   * Geometry of a batch of cells at the end of a step: gradients of the positions x_{n+1} and of
   * the increment dx_n on the reference cell, and volumes.
   */
  template <typename N>
  struct CellGeometry
  {
    static constexpr unsigned int n_points = CellBatches::n_gauss_points;

    TrilinearGradients<N> end;       ///< of x_{n+1}
    TrilinearGradients<N> increment; ///< of dx_n

    N volume_begin, volume_end; ///< of the cell in configurations n and n+1

    CellGeometry(const N (&x)[8][3], const N (&dx)[8][3])
      : end(TrilinearGradients<N>::evaluate(x))
      , increment(TrilinearGradients<N>::evaluate(dx))
      , volume_end(hexahedron_volume(x))
    {
      N x_begin[8][3];
      for (unsigned int v = 0; v < 8; ++v)
        for (unsigned int c = 0; c < 3; ++c)
          x_begin[v][c] = x[v][c] - dx[v][c];
      volume_begin = hexahedron_volume(x_begin);
    }
  };


  /**
   * What the step does to the material at the Gauss points: L = d(dx)/d x_mid and the volume ratio,
   * with x_mid the mean of both configurations. With J_0, J_1 = d x/d xi of configurations n and
   * n+1,
   *
   *     L = (J_1 - J_0) ((J_1 + J_0)/2)^{-1}.
   *
   * With mean dilatation the increment is F_bar = s F, s = (J_mean/J)^{1/3}, J_mean = V_{n+1}/V_n
   * (Nagtegaal, Parks and Rice 1974; Hughes 1980): the same with s J_1 for J_1.
   */
  template <typename N>
  struct PointKinematics
  {
    static constexpr unsigned int n_points = CellBatches::n_gauss_points;

    N jacobian_begin[n_points]; ///< det J_0
    N jacobian_end[n_points];   ///< det J_1
    N J[n_points];              ///< volume ratio of the increment
    Matrix3<N> L[n_points];
    N smallest_jacobian; ///< least det J_1, or the cell's volume if that is less

    // The first loop is short and unrolled, so that the long chains of operations of different
    // points overlap. All loops over the points unrolled fill the cache of instructions.
    template <bool mean_dilatation>
    [[gnu::always_inline]] inline void
    compute(const CellGeometry<N> &cell)
    {
      const N mean_J    = cell.volume_end / cell.volume_begin;
      smallest_jacobian = cell.volume_end;
      N stretch[n_points]; // s - 1
#pragma GCC unroll 8
      for (unsigned int q = 0; q < n_points; ++q)
        {
          const Matrix3<N> J_1 = cell.end.at(q);
          jacobian_end[q]      = determinant(J_1);
          jacobian_begin[q]    = determinant(add(J_1, -1., cell.increment.at(q)));
          smallest_jacobian    = select(jacobian_end[q] < smallest_jacobian,
                                     jacobian_end[q],
                                     smallest_jacobian);
          if constexpr (mean_dilatation)
            stretch[q] = cube_root_near_one(N(mean_J * jacobian_begin[q] / jacobian_end[q])) - 1.;
          J[q] = mean_dilatation ? mean_J : N(jacobian_end[q] / jacobian_begin[q]);
        }
#pragma GCC unroll 1
      for (unsigned int q = 0; q < n_points; ++q)
        {
          const Matrix3<N> J_1 = cell.end.at(q), dJ = cell.increment.at(q);
          Matrix3<N> difference = dJ, middle = add(J_1, -0.5, dJ);
          if constexpr (mean_dilatation)
            {
              difference = add(difference, stretch[q], J_1);
              middle     = add(middle, N(0.5 * stretch[q]), J_1);
            }
          const Matrix3<N> cofactors = cofactor(middle);
          L[q] = times_inverse(difference, cofactors, N(1. / determinant(middle, cofactors)));
        }
    }
  };


  /**
   * Stress update at every Gauss point.
   * @param state  [q][component][lane] of this batch, from n to n+1
   * @param ahead  state of the next batch, fetched meanwhile
   * @param owned  per lane, 1 where the cell counts in the sums
   * @param mean_pressure  sum_q w det(J_1) p_q / V of the new stresses
   * @return       largest E_mid : E_mid over the Gauss points
   */
  template <typename Law, typename N>
  [[gnu::always_inline]] inline N
  update_stresses(const Law &law,
                  const CellGeometry<N> &cell,
                  const PointKinematics<N> &points,
                  const N &owned,
                  double *state,
                  const double *ahead,
                  CellPassSums<N> &sums,
                  N &mean_pressure)
  {
    constexpr unsigned int n_components = Symmetric3<N>::n_components + Law::n_internals;

    N pressure_volume(0.), internal_work(0.), plastic_work(0.), strain_squared(0.);
#pragma GCC unroll 1
    for (unsigned int q = 0; q < CellBatches::n_gauss_points; ++q)
      {
        double *const point = state + q * n_components * n_lanes_of<N>;
        for (unsigned int c = 0; c < n_components; ++c)
          __builtin_prefetch(ahead + (q * n_components + c) * n_lanes_of<N>, 1);

        Symmetric3<N> stress;
        for (unsigned int c = 0; c < 6; ++c)
          load(point + c * n_lanes_of<N>, stress[c]);
        N internals[Law::n_internals + 1]; // one more than used: no array has length zero
        for (unsigned int i = 0; i < Law::n_internals; ++i)
          load(point + (6 + i) * n_lanes_of<N>, internals[i]);

        const Symmetric3<N> strain = symmetric_part(points.L[q]);
        internal_work += points.jacobian_begin[q] * contract(stress, strain);
        const N plastic = arc_end_update_from_mid(law, points.L[q], points.J[q], stress, internals)
                            .plastic_work;
        internal_work += points.jacobian_end[q] * contract(stress, strain);
        plastic_work += points.jacobian_end[q] * plastic;
        pressure_volume += points.jacobian_end[q] * trace(stress);
        strain_squared = maximum(strain_squared, contract(strain, strain));

        for (unsigned int c = 0; c < 6; ++c)
          store(stress[c], point + c * n_lanes_of<N>);
        for (unsigned int i = 0; i < Law::n_internals; ++i)
          store(internals[i], point + (6 + i) * n_lanes_of<N>);
      }
    sums.internal_work += owned * (0.5 * internal_work);
    sums.plastic_work += owned * plastic_work;
    mean_pressure = pressure_volume / (3. * cell.volume_end);
    return strain_squared;
  }


  /**
   * Nodal forces f_a = int_{Omega_{n+1}} sigma_{n+1} grad N_a dOmega. With mean dilatation the
   * pressure works on the cell's mean volume change: f_a = sum_q w (dev sigma + p_mean I) cof(d x/d
   * xi) dN_a/d xi.
   */
  template <bool mean_dilatation, unsigned int n_components, typename N>
  [[gnu::always_inline]] inline void
  internal_force(const CellGeometry<N> &cell,
                 const double *state,
                 const N &mean_pressure,
                 N (&force)[8][3])
  {
    TrilinearGradients<N> weights;
    weights.clear();
#pragma GCC unroll 1
    for (unsigned int q = 0; q < CellBatches::n_gauss_points; ++q)
      {
        const double *const point = state + q * n_components * n_lanes_of<N>;
        Symmetric3<N> stress;
        for (unsigned int c = 0; c < 6; ++c)
          load(point + c * n_lanes_of<N>, stress[c]);
        if constexpr (mean_dilatation)
          stress = add_to_diagonal(stress, N(mean_pressure - trace(stress) * (1. / 3.)));
        weights.add(q, stress * cofactor(cell.end.at(q)));
      }
    weights.integrate(force);
  }


  /// What a step found out about the cells of a batch.
  template <typename N>
  struct CellStep
  {
    N strain_squared;    ///< largest E_mid : E_mid over the Gauss points
    N smallest_jacobian; ///< not positive, or not a number, where the cell cannot be computed

    /**
     * Per lane, whether the cell has come through the step: not inside out, and no number lost (a
     * comparison with NaN is false). A cell that has turned inside out along two axes at once has
     * positive Jacobians again; but no stretch of an axis, however large, reaches
     * E_mid = 2 (U - 1)/(U + 1) = 2, and only what passes through itself is beyond.
     */
    auto
    is_valid() const
    {
      return smallest_jacobian > N(0.) && strain_squared < N(4.);
    }
  };


  /**
   * One step of a batch of fully integrated cells: stress update at every Gauss point, then nodal
   * forces.
   *
   * @param x, dx  x_{n+1} and dx_n [node][component], length
   * @param owned  per lane, 1 where the cell counts in the sums
   * @param state  [q][component][lane] of this batch, from n to n+1
   * @param ahead  state of the next batch, fetched meanwhile; any batch's
   * @param force  internal forces of the cells' nodes
   */
  template <bool mean_dilatation, typename Law, typename N>
  CellStep<N>
  update_stress_and_force(const Law &law,
                          const N (&x)[8][3],
                          const N (&dx)[8][3],
                          const N &owned,
                          double *state,
                          const double *ahead,
                          CellPassSums<N> &sums,
                          N (&force)[8][3])
  {
    const CellGeometry<N> cell(x, dx);
    PointKinematics<N> points;
    points.template compute<mean_dilatation>(cell);
    N mean_pressure;
    const N
      strain_squared = update_stresses(law, cell, points, owned, state, ahead, sums, mean_pressure);
    internal_force<mean_dilatation, Symmetric3<N>::n_components + Law::n_internals>(cell,
                                                                                    state,
                                                                                    mean_pressure,
                                                                                    force);
    return {strain_squared, points.smallest_jacobian};
  }
} // namespace akmon
