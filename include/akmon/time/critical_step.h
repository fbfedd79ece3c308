#pragma once

#include <akmon/forces/cell_batches.h>
#include <akmon/forces/cell_kernel.h>
#include <akmon/material/elasticity.h>
#include <akmon/model/body.h>

namespace akmon
{
  /**
   * Largest eigenvalue omega^2 of the free cell, M^{-1} K u = omega^2 u with lumped nodal masses,
   * by power iteration; the residual of the last iterate is added, so the answer lies above the
   * eigenvalue that was found. No assembled frequency exceeds the largest cell frequency.
   *
   * @param x        node positions [node][component], length
   * @param mass     the cell's share of the nodal masses [node]
   * @return         omega^2, 1/time^2
   */
  template <typename N>
  N
  largest_eigenvalue(const N (&x)[8][3],
                     const N (&mass)[8],
                     const Elasticity &elasticity,
                     const CellIntegration integration);

  /**
   * A scalar that follows omega^2 of a cell while it deforms, up to a factor that changes slowly:
   * for a brick with edges a_i it is V sum_i 4/a_i^2, built from the Jacobian matrix at the cell's
   * centre.
   */
  template <typename N>
  N
  frequency_tracker(const CellGeometry<N> &cell)
  {
    const Matrix3<N> J         = cell.end.at_centre();
    const Matrix3<N> cofactors = cofactor(J);
    const N j                  = determinant(J, cofactors);
    N sum(0.);
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int k = 0; k < 3; ++k)
        sum += cofactors(i, k) * cofactors(i, k);
    return cell.volume_end * sum / (j * j);
  }
} // namespace akmon
