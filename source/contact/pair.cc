#include <akmon/contact/lever.h>
#include <akmon/contact/pair.h>
#include <akmon/contact/search/face_geometry.h>

namespace akmon
{
  using namespace dealii;

  void
  set_lever(const std::array<Tensor<1, 3>, 4> &corners,
            const unsigned int first,
            const Tensor<1, 3> &offset,
            ContactPair &pair)
  {
    const auto centre = middle_of(corners);
    for (unsigned int k = 0; k < 4; ++k)
      pair.arms[first + k] = corners[k] - centre;
    pair.lever   = lever_of(offset,
                          inverse_inertia(
                            ArrayView<const Tensor<1, 3>>(pair.arms.data() + first, 4)));
    pair.levered = true;
  }
} // namespace akmon
