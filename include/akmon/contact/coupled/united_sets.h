#pragma once

#include <akmon/contact/buckets.h>

#include <numeric>
#include <vector>

namespace akmon
{
  /// Sets of the numbers below n, one for each to begin with, that are united step by step.
  class UnitedSets
  {
  public:
    explicit UnitedSets(const unsigned int n)
      : parents(n)
    {
      std::iota(parents.begin(), parents.end(), 0U);
    }

    void
    unite(const unsigned int a, const unsigned int b)
    {
      parents[root_of(b)] = root_of(a);
    }

    /// The sets in the order of their smallest numbers.
    Buckets
    lists()
    {
      const unsigned int n = parents.size();
      std::vector<unsigned int> list_of(n, n); // by root
      unsigned int n_lists = 0;
      for (unsigned int i = 0; i < n; ++i)
        if (unsigned int &list = list_of[root_of(i)]; list == n)
          list = n_lists++;
      Buckets result;
      result.fill(n_lists, n, [&](const unsigned int i) { return list_of[root_of(i)]; });
      return result;
    }

  private:
    unsigned int
    root_of(unsigned int i)
    {
      while (parents[i] != i)
        i = parents[i] = parents[parents[i]];
      return i;
    }

    std::vector<unsigned int> parents;
  };
} // namespace akmon
