#pragma once

#include <xsimd/xsimd.hpp>

#include <cmath>

namespace akmon
{
  /**
   * One number per SIMD lane. The width is that of the instruction set the build targets (8 doubles
   * on AVX-512, 4 on AVX2, 2 on SSE2). deal.II's VectorizedArray is not used because Debian builds
   * it with width 1.
   */
  using Lanes = xsimd::batch<double>;

  /// Number of cells that one batch computes side by side.
  constexpr unsigned int n_lanes = Lanes::size;

  /// Memory alignment that every lane array needs, bytes.
  constexpr std::size_t lane_alignment = n_lanes * sizeof(double);

  /// Lanes of a number type: [component][lane] arrays of numbers N have this stride.
  template <typename N>
  constexpr unsigned int n_lanes_of = 1;

  template <>
  inline constexpr unsigned int n_lanes_of<Lanes> = n_lanes;

  inline void
  load(const double *from, double &number)
  {
    number = *from;
  }

  /// From n_lanes doubles aligned to lane_alignment.
  inline void
  load(const double *from, Lanes &lanes)
  {
    lanes = Lanes::load_aligned(from);
  }

  inline void
  store(const double number, double *to)
  {
    *to = number;
  }

  inline void
  store(const Lanes &lanes, double *to)
  {
    lanes.store_aligned(to);
  }

  // The operations that laws and kinematics need beyond + - * /, for one number and for lanes
  // alike.

  inline double
  select(const bool condition, const double yes, const double no)
  {
    return condition ? yes : no;
  }

  inline Lanes
  select(const Lanes::batch_bool_type &condition, const Lanes &yes, const Lanes &no)
  {
    return xsimd::select(condition, yes, no);
  }

  inline double
  maximum(const double a, const double b)
  {
    return a > b ? a : b;
  }

  inline Lanes
  maximum(const Lanes &a, const Lanes &b)
  {
    return xsimd::max(a, b);
  }

  inline double
  square_root(const double a)
  {
    return std::sqrt(a);
  }

  inline Lanes
  square_root(const Lanes &a)
  {
    return xsimd::sqrt(a);
  }
} // namespace akmon
