#include <akmon/contact/coupled/front_panel.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace akmon
{
  namespace
  {
    // C -= A B for a tile of C that stays in registers.
    template <unsigned int n_lanes, unsigned int n_columns>
    void
    subtract_tile(const double *const A,
                  const std::size_t stride_of_A,
                  const double *const B,
                  const std::size_t stride_of_B,
                  double *const C,
                  const std::size_t stride_of_C,
                  const std::size_t depth)
    {
      Lanes sums[n_columns][n_lanes];
      for (unsigned int j = 0; j < n_columns; ++j)
        for (unsigned int l = 0; l < n_lanes; ++l)
          sums[j][l] = Lanes::load_unaligned(C + j * stride_of_C + l * Lanes::size);
      for (std::size_t k = 0; k < depth; ++k)
        {
          Lanes a[n_lanes];
          for (unsigned int l = 0; l < n_lanes; ++l)
            a[l] = Lanes::load_unaligned(A + k * stride_of_A + l * Lanes::size);
          for (unsigned int j = 0; j < n_columns; ++j)
            {
              const Lanes b(B[j * stride_of_B + k]);
              for (unsigned int l = 0; l < n_lanes; ++l)
                sums[j][l] = xsimd::fnma(a[l], b, sums[j][l]);
            }
        }
      for (unsigned int j = 0; j < n_columns; ++j)
        for (unsigned int l = 0; l < n_lanes; ++l)
          sums[j][l].store_unaligned(C + j * stride_of_C + l * Lanes::size);
    }


    // The same for a vector, with two sums for each of its numbers: one would wait for itself.
    template <unsigned int n_lanes>
    void
    subtract_tile(const double *const A,
                  const std::size_t stride_of_A,
                  const double *const b,
                  double *const c,
                  const std::size_t depth)
    {
      Lanes sums[2][n_lanes];
      for (unsigned int l = 0; l < n_lanes; ++l)
        {
          sums[0][l] = Lanes::load_unaligned(c + l * Lanes::size);
          sums[1][l] = Lanes(0.);
        }
      const auto subtract_column = [&](const std::size_t k, Lanes(&sum)[n_lanes]) {
        const Lanes factor(b[k]);
        for (unsigned int l = 0; l < n_lanes; ++l)
          sum[l] = xsimd::fnma(Lanes::load_unaligned(A + k * stride_of_A + l * Lanes::size),
                               factor,
                               sum[l]);
      };
      std::size_t k = 0;
      for (; k + 2 <= depth; k += 2)
        {
          subtract_column(k, sums[0]);
          subtract_column(k + 1, sums[1]);
        }
      if (k < depth)
        subtract_column(k, sums[0]);
      for (unsigned int l = 0; l < n_lanes; ++l)
        (sums[0][l] + sums[1][l]).store_unaligned(c + l * Lanes::size);
    }


    // tile(n_lanes, first row) for all rows, as many Lanes at a time as there are left, at most
    // `most`.
    template <unsigned int most, typename Tile>
    void
    for_tiles(const std::size_t first, const std::size_t n_rows, const Tile &tile)
    {
      std::size_t i = first;
      for (; i + (most - 1) * Lanes::size < n_rows; i += most * Lanes::size)
        tile(std::integral_constant<unsigned int, most>(), i);
      if constexpr (most > 1)
        for_tiles<most - 1>(i, n_rows, tile);
    }


    template <unsigned int n_columns>
    void
    subtract_columns(const ConstPanel &A,
                     const ConstPanel &B,
                     const Panel &C,
                     const std::size_t n_rows,
                     const std::size_t depth)
    {
      for_tiles<3>(0, n_rows, [&](const auto n_lanes, const std::size_t i) {
        subtract_tile<n_lanes, n_columns>(A.values + i,
                                          A.stride,
                                          B.values,
                                          B.stride,
                                          C.values + i,
                                          C.stride,
                                          depth);
      });
    }


    // column -= factor * other
    template <unsigned int n_lanes>
    void
    subtract(const double factor, const Lanes (&other)[n_lanes], double *const column)
    {
      for (unsigned int l = 0; l < n_lanes; ++l)
        xsimd::fnma(Lanes(factor), other[l], Lanes::load_unaligned(column + l * Lanes::size))
          .store_unaligned(column + l * Lanes::size);
    }


    // The column of a matrix from row `begin` to `end`, else zeros.
    template <unsigned int n_lanes>
    void
    load_part(const double *const column,
              const std::size_t begin,
              const std::size_t end,
              const double factor,
              Lanes (&part)[n_lanes])
    {
      alignas(lane_alignment) double values[n_lanes * Lanes::size] = {};
      for (std::size_t i = begin; i < end; ++i)
        values[i] = factor * column[i];
      for (unsigned int l = 0; l < n_lanes; ++l)
        part[l] = Lanes::load_aligned(values + l * Lanes::size);
    }


    // Gauss's elimination of (A | 1) gives (U | L^{-1}), that of (U | 1) from below U^{-1}.
    template <unsigned int n_lanes>
    bool
    eliminate(const Panel &A,
              const std::size_t n,
              const double least,
              const Panel &inverse_L,
              const Panel &inverse_U)
    {
      Lanes factors[n_lanes];
      for (std::size_t k = 0; k < n; ++k)
        {
          if (!(std::abs(A(k, k)) > least))
            return false;
          load_part(&A(0, k), k + 1, n, 1. / A(k, k), factors);
          for (std::size_t j = k + 1; j < n; ++j)
            subtract(A(k, j), factors, &A(0, j));
          for (std::size_t j = 0; j <= k; ++j)
            subtract(inverse_L(k, j), factors, &inverse_L(0, j));
        }
      for (std::size_t k = n; k-- > 0;)
        {
          load_part(&A(0, k), 0, k, 1., factors);
          for (std::size_t j = k; j < n; ++j)
            {
              inverse_U(k, j) /= A(k, k);
              subtract(inverse_U(k, j), factors, &inverse_U(0, j));
            }
        }
      return true;
    }


    template <unsigned int n_lanes>
    bool
    eliminate_with(const Panel &A,
                   const std::size_t n,
                   const double least,
                   const Panel &inverse_L,
                   const Panel &inverse_U)
    {
      if constexpr (n_lanes > 1)
        if (n <= (n_lanes - 1) * Lanes::size)
          return eliminate_with<n_lanes - 1>(A, n, least, inverse_L, inverse_U);
      return eliminate<n_lanes>(A, n, least, inverse_L, inverse_U);
    }
  } // namespace


  void
  subtract_product(const ConstPanel &A,
                   const ConstPanel &B,
                   const Panel &C,
                   const std::size_t n_rows,
                   const std::size_t depth,
                   const std::size_t n_columns)
  {
    // As many columns as there are registers for the sums.
    constexpr unsigned int at_once = Lanes::size < 8 ? 3 : 6;

    std::size_t j = 0;
    for (; j + at_once <= n_columns; j += at_once)
      subtract_columns<at_once>(A, B.from(0, j), C.from(0, j), n_rows, depth);
    for (; j + 3 <= n_columns; j += 3)
      subtract_columns<3>(A, B.from(0, j), C.from(0, j), n_rows, depth);
    for (; j < n_columns; ++j)
      subtract_product(A, &B(0, j), &C(0, j), n_rows, depth);
  }


  void
  subtract_product(const ConstPanel &A,
                   const double *const b,
                   double *const c,
                   const std::size_t n_rows,
                   const std::size_t depth)
  {
    for_tiles<4>(0, n_rows, [&](const auto n_lanes, const std::size_t i) {
      subtract_tile<n_lanes>(A.values + i, A.stride, b, c + i, depth);
    });
  }


  bool
  invert_factors(const Panel &A,
                 const std::size_t n,
                 const Panel &inverse_L,
                 const Panel &inverse_U)
  {
    constexpr double least = 1e-14; // of the largest entry

    double largest = 0.;
    for (std::size_t j = 0; j < n; ++j)
      {
        for (std::size_t i = 0; i < n; ++i)
          largest = std::max(largest, std::abs(A(i, j)));
        std::fill_n(&inverse_L(0, j), padded(n), 0.);
        std::fill_n(&inverse_U(0, j), padded(n), 0.);
        inverse_L(j, j) = inverse_U(j, j) = 1.;
      }
    return eliminate_with<max_panel / Lanes::size>(A, n, least * largest, inverse_L, inverse_U);
  }
} // namespace akmon
