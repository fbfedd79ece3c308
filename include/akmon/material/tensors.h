#pragma once

namespace akmon
{
  /**
   * 3 x 3 matrix of numbers of type N (double, or Lanes: one matrix per SIMD lane). deal.II's
   * Tensor admits no foreign SIMD types, hence these two small types for the cell kernel and the
   * laws. All functions are inlined by force: a call would pass every operand through memory, which
   * costs the kernel a third of its speed.
   */
  template <typename N>
  struct Matrix3
  {
    N m[3][3];

    N &
    operator()(const unsigned int i, const unsigned int j)
    {
      return m[i][j];
    }

    const N &
    operator()(const unsigned int i, const unsigned int j) const
    {
      return m[i][j];
    }
  };


  /// Symmetric 3 x 3 tensor (Cauchy stress, strain increment), components xx, yy, zz, xy, xz, yz.
  template <typename N>
  struct Symmetric3
  {
    static constexpr unsigned int n_components = 6;

    N c[n_components];

    N &
    operator[](const unsigned int i)
    {
      return c[i];
    }

    const N &
    operator[](const unsigned int i) const
    {
      return c[i];
    }
  };


  template <typename N>
  [[gnu::always_inline]] inline Matrix3<N>
  operator*(const Matrix3<N> &a, const Matrix3<N> &b)
  {
    Matrix3<N> result;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        result(i, j) = a(i, 0) * b(0, j) + a(i, 1) * b(1, j) + a(i, 2) * b(2, j);
    return result;
  }


  /// a + factor * b, the factor a constant or a number of its own per lane
  template <typename N, typename Factor>
  [[gnu::always_inline]] inline Matrix3<N>
  add(const Matrix3<N> &a, const Factor &factor, const Matrix3<N> &b)
  {
    Matrix3<N> result;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        result(i, j) = a(i, j) + factor * b(i, j);
    return result;
  }


  /// I + factor * a
  template <typename N>
  [[gnu::always_inline]] inline Matrix3<N>
  identity_plus(const double factor, const Matrix3<N> &a)
  {
    Matrix3<N> result;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        result(i, j) = i == j ? 1. + factor * a(i, j) : factor * a(i, j);
    return result;
  }


  /// Cofactor matrix: det(a) a^{-T}.
  template <typename N>
  [[gnu::always_inline]] inline Matrix3<N>
  cofactor(const Matrix3<N> &a)
  {
    Matrix3<N> result;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        {
          const unsigned int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
          const unsigned int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
          result(i, j) = a(i1, j1) * a(i2, j2) - a(i1, j2) * a(i2, j1);
        }
    return result;
  }


  /// Determinant of a matrix whose cofactors are known.
  template <typename N>
  [[gnu::always_inline]] inline N
  determinant(const Matrix3<N> &a, const Matrix3<N> &cofactors)
  {
    return a(0, 0) * cofactors(0, 0) + a(0, 1) * cofactors(0, 1) + a(0, 2) * cofactors(0, 2);
  }


  template <typename N>
  [[gnu::always_inline]] inline N
  determinant(const Matrix3<N> &a)
  {
    return a(0, 0) * (a(1, 1) * a(2, 2) - a(1, 2) * a(2, 1)) +
           a(0, 1) * (a(1, 2) * a(2, 0) - a(1, 0) * a(2, 2)) +
           a(0, 2) * (a(1, 0) * a(2, 1) - a(1, 1) * a(2, 0));
  }


  /// a b^{-1}, from the cofactors and the inverse determinant of b.
  template <typename N>
  [[gnu::always_inline]] inline Matrix3<N>
  times_inverse(const Matrix3<N> &a, const Matrix3<N> &cofactors_b, const N &inverse_determinant_b)
  {
    Matrix3<N> result;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        result(i, j) = (a(i, 0) * cofactors_b(j, 0) + a(i, 1) * cofactors_b(j, 1) +
                        a(i, 2) * cofactors_b(j, 2)) *
                       inverse_determinant_b;
    return result;
  }


  template <typename N>
  [[gnu::always_inline]] inline Matrix3<N>
  transpose(const Matrix3<N> &a)
  {
    Matrix3<N> result;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        result(i, j) = a(j, i);
    return result;
  }


  /// a s, with a symmetric s.
  template <typename N>
  [[gnu::always_inline]] inline Matrix3<N>
  operator*(const Matrix3<N> &a, const Symmetric3<N> &s)
  {
    Matrix3<N> result;
    for (unsigned int i = 0; i < 3; ++i)
      {
        result(i, 0) = a(i, 0) * s[0] + a(i, 1) * s[3] + a(i, 2) * s[4];
        result(i, 1) = a(i, 0) * s[3] + a(i, 1) * s[1] + a(i, 2) * s[5];
        result(i, 2) = a(i, 0) * s[4] + a(i, 1) * s[5] + a(i, 2) * s[2];
      }
    return result;
  }


  /// s a, with a symmetric s.
  template <typename N>
  [[gnu::always_inline]] inline Matrix3<N>
  operator*(const Symmetric3<N> &s, const Matrix3<N> &a)
  {
    Matrix3<N> result;
    for (unsigned int j = 0; j < 3; ++j)
      {
        result(0, j) = s[0] * a(0, j) + s[3] * a(1, j) + s[4] * a(2, j);
        result(1, j) = s[3] * a(0, j) + s[1] * a(1, j) + s[5] * a(2, j);
        result(2, j) = s[4] * a(0, j) + s[5] * a(1, j) + s[2] * a(2, j);
      }
    return result;
  }


  /// factor * a s a^T
  template <typename N>
  [[gnu::always_inline]] inline Symmetric3<N>
  push_forward(const Matrix3<N> &a, const Symmetric3<N> &s, const N &factor)
  {
    const Matrix3<N> t  = a * s;
    const auto contract = [&](const unsigned int i, const unsigned int j) {
      return factor * (t(i, 0) * a(j, 0) + t(i, 1) * a(j, 1) + t(i, 2) * a(j, 2));
    };
    return {{contract(0, 0),
             contract(1, 1),
             contract(2, 2),
             contract(0, 1),
             contract(0, 2),
             contract(1, 2)}};
  }


  /// (a + a^T)/2
  template <typename N>
  [[gnu::always_inline]] inline Symmetric3<N>
  symmetric_part(const Matrix3<N> &a)
  {
    return {{a(0, 0),
             a(1, 1),
             a(2, 2),
             0.5 * (a(0, 1) + a(1, 0)),
             0.5 * (a(0, 2) + a(2, 0)),
             0.5 * (a(1, 2) + a(2, 1))}};
  }


  template <typename N>
  [[gnu::always_inline]] inline N
  trace(const Symmetric3<N> &s)
  {
    return s[0] + s[1] + s[2];
  }


  /// a : b
  template <typename N>
  [[gnu::always_inline]] inline N
  contract(const Symmetric3<N> &a, const Symmetric3<N> &b)
  {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + 2. * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]);
  }


  template <typename N>
  [[gnu::always_inline]] inline Symmetric3<N>
  operator+(const Symmetric3<N> &a, const Symmetric3<N> &b)
  {
    Symmetric3<N> result;
    for (unsigned int i = 0; i < 6; ++i)
      result[i] = a[i] + b[i];
    return result;
  }


  /// s + p I
  template <typename N>
  [[gnu::always_inline]] inline Symmetric3<N>
  add_to_diagonal(Symmetric3<N> s, const N &p)
  {
    for (unsigned int i = 0; i < 3; ++i)
      s[i] += p;
    return s;
  }


  /// Von Mises equivalent stress sqrt(3/2) |dev s|, squared.
  template <typename N>
  [[gnu::always_inline]] inline N
  equivalent_stress_squared(const Symmetric3<N> &s)
  {
    const Symmetric3<N> deviator = add_to_diagonal(s, N(trace(s) * (-1. / 3.)));
    return 1.5 * contract(deviator, deviator);
  }
} // namespace akmon
