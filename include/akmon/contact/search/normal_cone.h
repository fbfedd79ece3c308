#pragma once

#include <deal.II/base/tensor.h>

#include <boost/container/small_vector.hpp>

#include <algorithm>
#include <cmath>

namespace akmon
{
  /**
   * The normals that a surface takes as it turns about an edge or vertex: the cone
   * { sum a_i n_i, a_i >= 0 } of the unit normals n_i of the faces that share it.
   */
  class NormalCone
  {
  public:
    using Vector = dealii::Tensor<1, 3>;

    void
    push_back(const Vector &normal)
    {
      normals.push_back(normal);
    }

    auto
    begin() const
    {
      return normals.begin();
    }

    auto
    end() const
    {
      return normals.end();
    }

    const Vector &
    back() const
    {
      return normals.back();
    }

    std::size_t
    size() const
    {
      return normals.size();
    }

    /// Whether any is turned far from their unit mean: else the surface is a curved one, meshed.
    bool
    turn_sharply(const Vector &mean) const
    {
      return std::any_of(begin(), end(), [&](const Vector &normal) {
        return normal * mean <= smooth;
      });
    }

    /// The cone of mean normals of those that go on smoothly from one to the next.
    NormalCone
    sides() const
    {
      NormalCone result;
      for (const Vector &normal : normals)
        {
          const auto same = std::find_if(result.normals.begin(),
                                         result.normals.end(),
                                         [&](const Vector &side) {
                                           return side * normal > smooth * side.norm();
                                         });
          if (same == result.normals.end())
            result.push_back(normal);
          else
            *same += normal;
        }
      for (Vector &side : result.normals)
        side /= side.norm();
      return result;
    }

    /// The vector of the cone that is closest to another one, coordinate by coordinate; zero if
    /// that is more than a right angle from all.
    Vector
    closest_to(const Vector &v) const
    {
      constexpr unsigned int most_sweeps = 50;
      constexpr double rounding          = 1e-14;

      boost::container::small_vector<double, 8> a(size(), 0.);
      Vector sum;
      double change = 1.;
      for (unsigned int sweep = 0; sweep < most_sweeps && change > rounding; ++sweep)
        {
          change = 0.;
          for (std::size_t i = 0; i < size(); ++i)
            {
              const double next = std::max(0., a[i] + normals[i] * (v - sum));
              sum += (next - a[i]) * normals[i];
              change = std::max(change, std::abs(next - a[i]));
              a[i]   = next;
            }
        }
      return sum;
    }

  private:
    static constexpr double smooth = 0.85; ///< cosine

    boost::container::small_vector<Vector, 8> normals;
  };
} // namespace akmon
