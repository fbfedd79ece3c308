#pragma once

#include <deal.II/base/array_view.h>
#include <deal.II/base/tensor.h>

namespace akmon
{
  /**
   * I^{-1} of I = sum_k (r_k.r_k 1 - r_k r_k): points that move by u_k turn in the mean by
   * theta = I^{-1} sum_k r_k x u_k.
   * @param arms  r_k, places of the points from their centre; length
   */
  dealii::Tensor<2, 3>
  inverse_inertia(const dealii::ArrayView<const dealii::Tensor<1, 3>> &arms);

  /// [o x] I^{-1}, which takes sum_k r_k x u_k to -theta x o (see ContactPair).
  /// @param offset  o; length
  dealii::Tensor<2, 3>
  lever_of(const dealii::Tensor<1, 3> &offset, const dealii::Tensor<2, 3> &inverse);
} // namespace akmon
