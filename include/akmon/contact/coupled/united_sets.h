#pragma once

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

    /// The sets in the order of their smallest numbers, each in rising order.
    std::vector<std::vector<unsigned int>>
    lists()
    {
      std::vector<std::vector<unsigned int>> result;
      std::vector<unsigned int> list_of_root(parents.size(), parents.size());
      for (unsigned int i = 0; i < parents.size(); ++i)
        {
          unsigned int &list = list_of_root[root_of(i)];
          if (list == parents.size())
            {
              list = result.size();
              result.emplace_back();
            }
          result[list].push_back(i);
        }
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
