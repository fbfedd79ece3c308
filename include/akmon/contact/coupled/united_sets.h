#pragma once

#include <deal.II/base/array_view.h>

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

    /// The sets in the order of their smallest numbers, one behind the other, each in rising order.
    struct Lists
    {
      std::vector<unsigned int> numbers;
      std::vector<unsigned int> begins; ///< of the sets, and one past the end

      std::size_t
      size() const
      {
        return begins.size() - 1;
      }

      dealii::ArrayView<const unsigned int>
      operator[](const std::size_t set) const
      {
        return {numbers.data() + begins[set], begins[set + 1] - begins[set]};
      }
    };

    Lists
    lists()
    {
      Lists result;
      std::vector<unsigned int> list_of(parents.size(), parents.size()); // by root
      for (unsigned int i = 0; i < parents.size(); ++i)
        {
          const unsigned int root = root_of(i);
          if (list_of[root] == parents.size())
            {
              list_of[root] = result.begins.size();
              result.begins.push_back(0);
            }
          ++result.begins[list_of[root]];
        }
      std::exclusive_scan(result.begins.begin(), result.begins.end(), result.begins.begin(), 0U);
      result.begins.push_back(parents.size());
      auto ends = result.begins;
      result.numbers.resize(parents.size());
      for (unsigned int i = 0; i < parents.size(); ++i)
        result.numbers[ends[list_of[root_of(i)]]++] = i;
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
