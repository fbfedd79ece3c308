#pragma once

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace akmon
{
  /**
   * Sums over all ranks whose bits depend neither on the order of the addends nor on the ranks that
   * have them: the largest addend tells a grid, on which the addends' leading parts have exact
   * sums; then the same with what is left of them (Demmel and Nguyen, Fast reproducible
   * floating-point summation, 21st IEEE Symposium on Computer Arithmetic, 2013). Of up to two
   * million addends the error is 2^-66 of the largest one for each (collective).
   * @param addends  of this rank, a list for every sum
   */
  inline std::vector<double>
  reproducible_sums(const std::vector<std::vector<double>> &addends, const MPI_Comm communicator)
  {
    constexpr int bits_of_number = 20; // of addends

    const std::size_t n = addends.size();
    std::vector<double> largest(n, 0.);
    for (std::size_t i = 0; i < n; ++i)
      for (const double a : addends[i])
        largest[i] = std::max(largest[i], std::abs(a));
    dealii::Utilities::MPI::max(largest, communicator, largest);

    std::vector<double> parts(2 * n, 0.);
    for (std::size_t i = 0; i < n; ++i)
      {
        if (!(largest[i] > 0.) || !std::isfinite(largest[i]))
          {
            parts[2 * i] = std::accumulate(addends[i].begin(), addends[i].end(), 0.);
            continue;
          }
        int exponent;
        std::frexp(largest[i], &exponent);
        const double coarse = std::ldexp(1.5, std::clamp(exponent + bits_of_number, -900, 1020));
        const double fine   = std::ldexp(coarse, bits_of_number - 53);
        for (const double a : addends[i])
          {
            const double leading = (a + coarse) - coarse;
            parts[2 * i] += leading;
            parts[2 * i + 1] += ((a - leading) + fine) - fine;
          }
      }
    dealii::Utilities::MPI::sum(parts, communicator, parts);
    std::vector<double> sums(n);
    for (std::size_t i = 0; i < n; ++i)
      sums[i] = parts[2 * i] + parts[2 * i + 1];
    return sums;
  }
} // namespace akmon
