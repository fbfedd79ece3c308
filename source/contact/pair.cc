#include <akmon/contact/pair.h>

namespace akmon
{
  using namespace dealii;

  void
  set_lever(const std::array<Tensor<1, 3>, 4> &corners,
            const unsigned int first,
            const Tensor<1, 3> &offset,
            ContactPair &pair)
  {
    const auto centre = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
    SymmetricTensor<2, 3> inertia;
    for (unsigned int k = 0; k < 4; ++k)
      {
        const auto r         = corners[k] - centre;
        pair.arms[first + k] = r;
        const double r_r     = r * r;
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = i; j < 3; ++j)
            inertia[i][j] += (i == j ? r_r : 0.) - r[i] * r[j];
      }
    const Tensor<2, 3> inverse = invert(inertia);
    for (unsigned int j = 0; j < 3; ++j)
      {
        const auto column = cross_product_3d(offset,
                                             Tensor<1, 3>(
                                               {inverse[0][j], inverse[1][j], inverse[2][j]}));
        for (unsigned int i = 0; i < 3; ++i)
          pair.lever[i][j] = column[i];
      }
    pair.levered = true;
  }
} // namespace akmon
