#pragma once

#include <akmon/forces/cell_kernel.h>
#include <akmon/material/elasticity.h>
#include <akmon/model/body.h>

namespace akmon
{
  /**
   * The stiffness K of a cell for linear elasticity on its present configuration, with the
   * integration of the time loop: what internal_force() changes by for an elastic increment u
   * without stress. One-point cells are taken for mean dilatation, which has no less stiffness.
   *
   * With B = cof(J)/sqrt(det J) at the points, grad u_ref the gradient on the reference cell and
   * s = sym(grad u_ref B^T), which is the strain times sqrt(det J),
   *
   *     K u = sum_q (C : s) B dN/d xi.
   */
  template <typename N>
  class ElasticCell
  {
  public:
    /// @param positions  gradients of the node positions on the reference cell
    ElasticCell(const TrilinearGradients<N> &positions,
                const Elasticity &elasticity,
                const CellIntegration integration)
      : elasticity(elasticity)
      , mean_dilatation(integration != CellIntegration::full)
      , inverse_volume(0.)
    {
      for (unsigned int q = 0; q < n_points; ++q)
        {
          const Matrix3<N> J = positions.at(q);
          B[q]               = cofactor(J);
          const N j          = determinant(J, B[q]);
          // One-point cells may be folded at a point: as stiff as if they were not.
          root[q]         = square_root(maximum(maximum(j, N(-j)), N(smallest)));
          const N inverse = 1. / root[q];
          for (unsigned int i = 0; i < 3; ++i)
            for (unsigned int k = 0; k < 3; ++k)
              B[q](i, k) *= inverse;
          inverse_volume += j;
        }
      inverse_volume = 1. / inverse_volume;
    }

    /// f = K u; [node][component], length, force.
    void
    apply(const N (&u)[8][3], N (&f)[8][3]) const
    {
      const auto gradients = TrilinearGradients<N>::evaluate(u);
      Symmetric3<N> strain[n_points];
      N dilatation(0.);
#pragma GCC unroll 8
      for (unsigned int q = 0; q < n_points; ++q)
        {
          strain[q] = symmetric_part(times_transpose(gradients.at(q), B[q]));
          dilatation += root[q] * trace(strain[q]);
        }
      TrilinearGradients<N> weights;
      weights.clear();
      const N mean = dilatation * inverse_volume;
#pragma GCC unroll 8
      for (unsigned int q = 0; q < n_points; ++q)
        {
          if (mean_dilatation)
            strain[q] = add_to_diagonal(strain[q],
                                        N((mean * root[q] - trace(strain[q])) * (1. / 3.)));
          weights.add(q, elasticity.stress(strain[q]) * B[q]);
        }
      // With the mean dilatation in the strain, the pressure part 3 K mean I is constant over the
      // cell and its weights integrate to the mean divergence: no further averaging is needed.
      weights.integrate(f);
    }

  private:
    static constexpr unsigned int n_points = CellBatches::n_gauss_points;
    static constexpr double smallest       = 1e-300; ///< keeps quotients defined; volume

    static Matrix3<N>
    times_transpose(const Matrix3<N> &a, const Matrix3<N> &b)
    {
      Matrix3<N> result;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          result(i, j) = a(i, 0) * b(j, 0) + a(i, 1) * b(j, 1) + a(i, 2) * b(j, 2);
      return result;
    }

    const Elasticity elasticity;
    const bool mean_dilatation;
    Matrix3<N> B[n_points];
    N root[n_points]; ///< sqrt(det J)
    N inverse_volume; ///< 1/sum_q det J
  };
} // namespace akmon
