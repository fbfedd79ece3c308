#pragma once

#include <akmon/forces/cell_batches.h>
#include <akmon/forces/cell_kernel.h>
#include <akmon/material/elasticity.h>
#include <akmon/model/body.h>

namespace akmon
{
  /**
   * Largest eigenvalue omega^2 of the free cell, M^{-1} K u = omega^2 u with lumped nodal masses,
   * by a few steps of Lanczos' method. No assembled frequency exceeds the largest cell frequency.
   * One-point cells are taken for mean dilatation: the mean strain has no more energy than the
   * strain at every point, and an allowed hourglass coefficient gives the patterns less stiffness
   * than they have.
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
   * Factor by which omega of a cell may have grown in a step with the strain increment e = E_mid.
   * For a brick omega^2 goes with V/a^2, so that a stretch along the axes changes omega by max
   * (-e_i + e_j + e_k)/2 <= (sqrt 3/2)|e|.
   * @param strain_squared  largest e : e over the Gauss points
   */
  template <typename N>
  N
  frequency_growth(const N &strain_squared)
  {
    return 1. + 0.8660254037844386 * square_root(strain_squared);
  }
} // namespace akmon
