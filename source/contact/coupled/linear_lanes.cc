#include <akmon/contact/coupled/linear_lanes.h>

namespace akmon
{
  LinearLanes::Mask
  LinearLanes::solve()
  {
    Mask regular = Lanes(0.) == Lanes(0.);
    for (unsigned int i = 0; i < n; ++i)
      {
        for (unsigned int k = 0; k < i; ++k)
          eliminate(i, k);
        regular = regular & factorize_diagonal(i);
      }
    substitute();
    return regular;
  }


  // The rows of pair i less what makes their block k zero of those of pair k.
  void
  LinearLanes::eliminate(const unsigned int i, const unsigned int k)
  {
    const Lanes zero(0.);
    Lanes *const rows[3]         = {&values[columns * 3 * i],
                                    &values[columns * (3 * i + 1)],
                                    &values[columns * (3 * i + 2)]};
    const Lanes *const pivots[3] = {&values[columns * 3 * k],
                                    &values[columns * (3 * k + 1)],
                                    &values[columns * (3 * k + 2)]};
    Lanes factors[3][3];
    Mask all_zero = zero == zero;
    for (unsigned int r = 0; r < 3; ++r)
      for (unsigned int m = 0; m < 3; ++m)
        {
          Lanes sum = rows[r][3 * k + m];
          for (unsigned int l = 0; l < m; ++l)
            sum = xsimd::fnma(factors[r][l], pivots[l][3 * k + m], sum);
          factors[r][m] = sum * reciprocal[3 * k + m];
          all_zero      = all_zero & (factors[r][m] == zero);
        }
    if (xsimd::all(all_zero)) // of pairs that share no node, which are many
      return;
    for (unsigned int j = 3 * k + 3; j < columns; ++j)
      for (unsigned int r = 0; r < 3; ++r)
        {
          Lanes sum  = xsimd::fnma(factors[r][0], pivots[0][j], rows[r][j]);
          sum        = xsimd::fnma(factors[r][1], pivots[1][j], sum);
          rows[r][j] = xsimd::fnma(factors[r][2], pivots[2][j], sum);
        }
  }


  LinearLanes::Mask
  LinearLanes::factorize_diagonal(const unsigned int i)
  {
    constexpr double least_pivot = 1e-14;

    Mask regular = Lanes(0.) == Lanes(0.);
    for (unsigned int r = 3 * i; r < 3 * i + 3; ++r)
      {
        Lanes *const row = &values[columns * r];
        for (unsigned int m = 3 * i; m < r; ++m)
          {
            const Lanes factor       = row[m] * reciprocal[m];
            const Lanes *const pivot = &values[columns * m];
            for (unsigned int j = m + 1; j < columns; ++j)
              row[j] = xsimd::fnma(factor, pivot[j], row[j]);
          }
        const Mask has_pivot = xsimd::abs(row[r]) > Lanes(least_pivot);
        regular              = regular & has_pivot;
        reciprocal[r]        = Lanes(1.) / select(has_pivot, row[r], Lanes(1.));
      }
    return regular;
  }


  void
  LinearLanes::substitute()
  {
    for (unsigned int i = 3 * n; i-- > 0;)
      {
        const Lanes *const row = &values[columns * i];
        Lanes sum              = row[3 * n];
        for (unsigned int j = i + 1; j < 3 * n; ++j)
          sum = xsimd::fnma(row[j], right_hand(j), sum);
        right_hand(i) = sum * reciprocal[i];
      }
  }
} // namespace akmon
