#pragma once

#include <deal.II/base/tensor.h>

#include <algorithm>
#include <limits>

namespace akmon
{
  /// A box along the axes; empty until something is included in it.
  struct Box
  {
    dealii::Tensor<1, 3> lower{{most, most, most}}, upper{{-most, -most, -most}}; ///< length

    void
    include(const dealii::Tensor<1, 3> &point)
    {
      for (unsigned int d = 0; d < 3; ++d)
        {
          lower[d] = std::min(lower[d], point[d]);
          upper[d] = std::max(upper[d], point[d]);
        }
    }

    void
    include(const Box &other)
    {
      for (unsigned int d = 0; d < 3; ++d)
        {
          lower[d] = std::min(lower[d], other.lower[d]);
          upper[d] = std::max(upper[d], other.upper[d]);
        }
    }

    /// By a margin on all sides; length
    void
    widen(const double margin)
    {
      for (unsigned int d = 0; d < 3; ++d)
        {
          lower[d] -= margin;
          upper[d] += margin;
        }
    }

    bool
    meets(const Box &other) const
    {
      for (unsigned int d = 0; d < 3; ++d)
        if (lower[d] > other.upper[d] || upper[d] < other.lower[d])
          return false;
      return true;
    }

    bool
    holds(const dealii::Tensor<1, 3> &point) const
    {
      return meets({point, point});
    }

    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int)
    {
      archive &lower &upper;
    }

    static constexpr double most = std::numeric_limits<double>::max();
  };
} // namespace akmon
