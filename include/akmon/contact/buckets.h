#pragma once

#include <deal.II/base/array_view.h>

#include <numeric>
#include <vector>

namespace akmon
{
  /// The numbers below n by the bucket that each is in, those of a bucket in rising order. Its
  /// storage is reused.
  class Buckets
  {
  public:
    /// @param bucket_of  of a number: below @p n_buckets
    template <typename BucketOf>
    void
    fill(const unsigned int n_buckets, const unsigned int n, const BucketOf &bucket_of)
    {
      begins.assign(n_buckets + 1, 0);
      for (unsigned int i = 0; i < n; ++i)
        ++begins[bucket_of(i)];
      std::exclusive_scan(begins.begin(), begins.end(), begins.begin(), 0U);
      ends = begins;
      numbers.resize(n);
      for (unsigned int i = 0; i < n; ++i)
        numbers[ends[bucket_of(i)]++] = i;
    }

    std::size_t
    size() const
    {
      return begins.size() - 1;
    }

    dealii::ArrayView<const unsigned int>
    operator[](const std::size_t bucket) const
    {
      return {numbers.data() + begins[bucket], begins[bucket + 1] - begins[bucket]};
    }

  private:
    std::vector<unsigned int> numbers, begins, ends;
  };
} // namespace akmon
