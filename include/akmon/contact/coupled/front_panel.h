#pragma once

#include <akmon/simd.h>

#include <cstddef>

namespace akmon
{
  /// The numbers in as many Lanes as n need.
  constexpr std::size_t
  padded(const std::size_t n)
  {
    return (n + Lanes::size - 1) / Lanes::size * Lanes::size;
  }


  /// A matrix by columns whose length is a multiple of Lanes' size at least, `stride` apart. What
  /// stands below the rows is finite and means nothing.
  template <typename Number>
  struct Columns
  {
    Number *values;
    std::size_t stride;

    Columns(Number *const values, const std::size_t stride)
      : values(values)
      , stride(stride)
    {
    }

    /// Of constant numbers, too.
    template <typename Other>
    Columns(const Columns<Other> &other)
      : Columns(other.values, other.stride)
    {
    }

    Number &
    operator()(const std::size_t row, const std::size_t column) const
    {
      return values[column * stride + row];
    }

    Columns
    from(const std::size_t row, const std::size_t column) const
    {
      return {values + column * stride + row, stride};
    }
  };

  using Panel      = Columns<double>;
  using ConstPanel = Columns<const double>;


  /// Largest size of the matrices of invert_factors().
  constexpr std::size_t max_panel = 24;


  /**
   * C -= A B
   * @param n_rows     of A and C; as many more are touched as fill the last Lanes
   * @param depth      columns of A, rows of B
   * @param n_columns  of B and C
   */
  void
  subtract_product(const ConstPanel &A,
                   const ConstPanel &B,
                   const Panel &C,
                   const std::size_t n_rows,
                   const std::size_t depth,
                   const std::size_t n_columns);


  /// The same of a vector.
  void
  subtract_product(const ConstPanel &A,
                   const double *const b,
                   double *const c,
                   const std::size_t n_rows,
                   const std::size_t depth);


  /**
   * Inverses of the triangular factors of a small matrix A = L U, L with a unit diagonal, without
   * pivoting.
   * @param A  is overwritten
   * @return whether there are pivots
   */
  bool
  invert_factors(const Panel &A,
                 const std::size_t n,
                 const Panel &inverse_L,
                 const Panel &inverse_U);
} // namespace akmon
