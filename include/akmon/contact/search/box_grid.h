#pragma once

#include <akmon/contact/search/box.h>
#include <akmon/simd.h>

#include <deal.II/base/tensor.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace akmon
{
  /**
   * Boxes in space by the cells of a regular grid that they overlap, to ask which of them hold a
   * point. Cells are as large as the mean box, and hashed: where there are no boxes they take no
   * memory. Its storage is reused.
   */
  class BoxGrid
  {
  public:
    /// Take up boxes instead of those there are.
    void
    reinit(std::vector<Box> new_boxes)
    {
      boxes = std::move(new_boxes);
      limits.clear();
      for (const Box &box : boxes)
        limits.emplace_back(box.lower, -box.upper);
      choose_cell_size();
      std::size_t n_buckets = 1;
      while (n_buckets < 2 * boxes.size())
        n_buckets *= 2;
      mask = n_buckets - 1;
      begins.assign(n_buckets + 1, 0);
      visit_entries([&](const std::size_t bucket, const unsigned int) { ++begins[bucket + 1]; });
      for (std::size_t i = 1; i <= n_buckets; ++i)
        begins[i] += begins[i - 1];
      entries.resize(begins.back());
      std::vector<unsigned int> next(begins.begin(), begins.end() - 1);
      visit_entries(
        [&](const std::size_t bucket, const unsigned int box) { entries[next[bucket]++] = box; });
    }

    /// visit(number) for the boxes that hold a point, in ascending order.
    template <typename Visit>
    void
    visit_holding(const dealii::Tensor<1, 3> &x, const Visit &visit) const
    {
      constexpr unsigned int n_together = 32;

      const std::size_t bucket = bucket_of(cell_of(x));
      const Limits of_x(x, -x);
      std::array<unsigned int, n_together> found;
      unsigned int last = -1;
      for (unsigned int begin = begins[bucket]; begin < begins[bucket + 1]; begin += n_together)
        {
          const unsigned int end = std::min(begin + n_together, begins[bucket + 1]);
          unsigned int n_found   = 0;
          for (unsigned int i = begin; i < end; ++i) // without a branch
            {
              // Several cells of a box may fall into the same bucket, where they stand together.
              const unsigned int box = entries[i];
              found[n_found]         = box;
              n_found += (box != last) & limits[box].allow(of_x);
              last = box;
            }
          for (unsigned int i = 0; i < n_found; ++i)
            visit(found[i]);
        }
    }

    /// Append the numbers of the boxes that hold a point to a list, in ascending order.
    void
    collect(const dealii::Tensor<1, 3> &x, std::vector<unsigned int> &numbers) const
    {
      visit_holding(x, [&](const unsigned int box) { numbers.push_back(box); });
    }

  private:
    using Cell = std::array<std::int64_t, 3>;

    // What the six numbers (x, -x) of a point must not be below, side by side in SIMD lanes.
    struct alignas(64) Limits
    {
      Limits(const dealii::Tensor<1, 3> &lower, const dealii::Tensor<1, 3> &minus_upper)
      {
        for (unsigned int d = 0; d < 3; ++d)
          {
            values[d]     = lower[d];
            values[3 + d] = minus_upper[d];
          }
      }

      bool
      allow(const Limits &of_point) const
      {
        bool all = true;
        for (unsigned int i = 0; i < 8; i += n_lanes)
          all = all & xsimd::all(Lanes::load_aligned(values + i) <=
                                 Lanes::load_aligned(of_point.values + i));
        return all;
      }

      double values[8] = {};
    };

    // Large boxes among small ones would overlap many cells.
    void
    choose_cell_size()
    {
      constexpr double most_cells = 64.; // of a box, in the mean

      double sum = 0.;
      for (const auto &box : boxes)
        if (is_finite(box))
          sum += extent(box);
      size = sum > 0. ? sum / boxes.size() : 1.;
      while (number_of_cells() > most_cells * boxes.size())
        size *= 2.;
    }

    // That all boxes overlap, about.
    double
    number_of_cells() const
    {
      double sum = 0.;
      for (const auto &box : boxes)
        if (is_finite(box))
          {
            double n = 1.;
            for (unsigned int d = 0; d < 3; ++d)
              n *= 1. + (box.upper[d] - box.lower[d]) / size;
            sum += n;
          }
      return sum;
    }

    // Not so where a run fails.
    static bool
    is_finite(const Box &box)
    {
      const auto extents = box.upper - box.lower;
      return std::isfinite(extents[0] + extents[1] + extents[2]);
    }

    static double
    extent(const Box &box)
    {
      return std::max(
        {box.upper[0] - box.lower[0], box.upper[1] - box.lower[1], box.upper[2] - box.lower[2]});
    }

    Cell
    cell_of(const dealii::Tensor<1, 3> &x) const
    {
      constexpr double furthest = 1e15; // where doubles are still whole numbers

      Cell cell{};
      for (unsigned int d = 0; d < 3; ++d)
        if (const double at = x[d] / size; !std::isnan(at))
          cell[d] = static_cast<std::int64_t>(std::floor(std::clamp(at, -furthest, furthest)));
      return cell;
    }

    std::size_t
    bucket_of(const Cell &cell) const
    {
      // Multipliers of Teschner et al., Vision, Modeling and Visualization (2003).
      return (static_cast<std::uint64_t>(cell[0]) * 73856093U ^
              static_cast<std::uint64_t>(cell[1]) * 19349663U ^
              static_cast<std::uint64_t>(cell[2]) * 83492791U) &
             mask;
    }

    // visit(bucket, box) for the cells that each box overlaps.
    template <typename Visit>
    void
    visit_entries(const Visit &visit) const
    {
      for (unsigned int box = 0; box < boxes.size(); ++box)
        if (is_finite(boxes[box]))
          {
            const Cell first = cell_of(boxes[box].lower), last = cell_of(boxes[box].upper);
            for (std::int64_t i = first[0]; i <= last[0]; ++i)
              for (std::int64_t j = first[1]; j <= last[1]; ++j)
                for (std::int64_t k = first[2]; k <= last[2]; ++k)
                  visit(bucket_of({{i, j, k}}), box);
          }
    }

    std::vector<Box> boxes;
    std::vector<Limits> limits;                ///< of the same
    double size      = 1.;                     ///< of the cells; length
    std::size_t mask = 0;                      ///< number of buckets, a power of two, less one
    std::vector<unsigned int> begins, entries; ///< by bucket: the numbers of its boxes
  };
} // namespace akmon
