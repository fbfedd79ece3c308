#include <akmon/contact/lever.h>

#include <deal.II/base/symmetric_tensor.h>

namespace akmon
{
  using namespace dealii;

  Tensor<2, 3>
  inverse_inertia(const ArrayView<const Tensor<1, 3>> &arms)
  {
    SymmetricTensor<2, 3> inertia;
    for (const auto &r : arms)
      {
        const double r_r = r * r;
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = i; j < 3; ++j)
            inertia[i][j] += (i == j ? r_r : 0.) - r[i] * r[j];
      }
    return invert(inertia);
  }


  Tensor<2, 3>
  lever_of(const Tensor<1, 3> &offset, const Tensor<2, 3> &inverse)
  {
    Tensor<2, 3> lever;
    for (unsigned int j = 0; j < 3; ++j)
      {
        const auto column = cross_product_3d(offset,
                                             Tensor<1, 3>(
                                               {inverse[0][j], inverse[1][j], inverse[2][j]}));
        for (unsigned int i = 0; i < 3; ++i)
          lever[i][j] = column[i];
      }
    return lever;
  }
} // namespace akmon
