#include "machine.h"

#include <akmon/simd.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <vector>

namespace akmon::benchmark
{
  namespace
  {
    constexpr unsigned int n_repetitions = 5;


    double
    fused_multiply_adds_per_second()
    {
      // More chains than latency (4 cycles) times instructions a cycle (2 at most), fewer than
      // registers.
      constexpr unsigned int n_chains = 12, n_links = 4'000'000;

      double best = 0.;
      for (unsigned int repetition = 0; repetition < n_repetitions; ++repetition)
        {
          Lanes chains[n_chains];
          for (unsigned int i = 0; i < n_chains; ++i)
            chains[i] = Lanes(1. + i);
          const Lanes factor(0.999999), term(1e-9);
          const double start = processor_seconds();
          for (unsigned int link = 0; link < n_links; ++link)
            for (auto &chain : chains)
              chain = xsimd::fma(chain, factor, term);
          const double seconds = processor_seconds() - start;
          double sum           = 0.;
          for (const auto &chain : chains)
            sum += xsimd::hadd(chain);
          if (!(sum > 0.)) // never; but the compiler must not know
            std::puts("");
          best = std::max(best, double(n_chains) * n_links / seconds);
        }
      return best;
    }


    double
    triad_entries_per_second()
    {
      std::vector<double> a(std::size_t(1) << 23, 0.), b(a.size(), 1.), c(a.size(), 2.);
      double best = 0.;
      for (unsigned int repetition = 0; repetition < n_repetitions; ++repetition)
        {
          const double start = processor_seconds();
          for (std::size_t i = 0; i < a.size(); ++i)
            a[i] = b[i] + 3. * c[i];
          best          = std::max(best, a.size() / (processor_seconds() - start));
          b[repetition] = a[repetition];
        }
      return best;
    }
  } // namespace


  Machine
  measure_machine()
  {
    return {2. * n_lanes * fused_multiply_adds_per_second(), 24. * triad_entries_per_second()};
  }


  double
  processor_seconds()
  {
    return double(std::clock()) / CLOCKS_PER_SEC;
  }
} // namespace akmon::benchmark
