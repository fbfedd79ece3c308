#pragma once

#include <akmon/forces/cell_kernel.h>
#include <akmon/material/elasticity.h>
#include <akmon/model/body.h>

namespace akmon
{
  /**
   * f = K u of a cell for linear elasticity on its present configuration, with the integration of
   * the time loop: what internal_force() changes by for an elastic increment u without stress.
   * One-point cells are taken for mean dilatation, which has no less stiffness.
   *
   * @param positions  gradients of the node positions on the reference cell
   * @param u, f       [node][component]; length, force
   */
  template <typename N>
  void
  apply_elastic_stiffness(const TrilinearGradients<N> &positions,
                          const Elasticity &elasticity,
                          const CellIntegration integration,
                          const N (&u)[8][3],
                          N (&f)[8][3])
  {
    constexpr unsigned int n_points = CellBatches::n_gauss_points;

    const auto gradients = TrilinearGradients<N>::evaluate(u);
    Symmetric3<N> strain[n_points];
    N volume(0.), dilatation(0.);
#pragma GCC unroll 8
    for (unsigned int q = 0; q < n_points; ++q)
      {
        const Matrix3<N> J         = positions.at(q);
        const Matrix3<N> cofactors = cofactor(J);
        const N j                  = determinant(J, cofactors);
        strain[q] = symmetric_part(times_inverse(gradients.at(q), cofactors, N(1. / j)));
        volume += j;
        dilatation += j * trace(strain[q]);
      }
    TrilinearGradients<N> weights;
    weights.clear();
    const N mean = dilatation / volume;
#pragma GCC unroll 8
    for (unsigned int q = 0; q < n_points; ++q)
      {
        if (integration != CellIntegration::full)
          strain[q] = add_to_diagonal(strain[q], N((mean - trace(strain[q])) * (1. / 3.)));
        weights.add(q, elasticity.stress(strain[q]) * cofactor(positions.at(q)));
      }
    // With the mean dilatation in the strain, the pressure part 3 K mean I is constant over the
    // cell and its weights integrate to the mean divergence: no further averaging is needed.
    weights.integrate(f);
  }
} // namespace akmon
