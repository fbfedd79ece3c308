#pragma once

#include <akmon/material/tensors.h>

namespace akmon
{
  /**
   * Gradients of a trilinear nodal field with respect to the reference cell [-1,1]^3 at the 2 x 2 x
   * 2 Gauss points. The derivative along one reference direction is bilinear in the two others and
   * does not depend on the direction itself, so each direction has only four different values:
   *
   *     d u/d xi_0 (q) = sum_jk w_j(xi_1) w_k(xi_2) (u_{1jk} - u_{0jk})/2,    w(-+1/sqrt3) = a or
   * b, a = (1 + 1/sqrt 3)/2,   b = (1 - 1/sqrt 3)/2.
   *
   * Evaluating them by tensor products costs 12 operations a direction and component for all eight
   * points.
   */
  template <typename N>
  struct TrilinearGradients
  {
    N value[3][4][3]; ///< [direction][transverse Gauss point][component]

    static constexpr double a = 0.78867513459481288225;
    static constexpr double b = 0.21132486540518711775;

    /// Number of the transverse point of direction d that Gauss point q (lexicographic) belongs to.
    static constexpr unsigned int
    transverse(const unsigned int d, const unsigned int q)
    {
      return d == 0 ? q >> 1 : d == 1 ? (q & 1) | ((q >> 2) << 1) : q & 3;
    }

    /// Node (lexicographic) at the lower end of direction d with transverse corner p.
    static constexpr unsigned int
    lower_node(const unsigned int d, const unsigned int p)
    {
      return d == 0 ? p << 1 : d == 1 ? (p & 1) | ((p >> 1) << 2) : p;
    }

    /// Gradients of nodal values u[node][component].
    static TrilinearGradients
    evaluate(const N (&u)[8][3])
    {
      TrilinearGradients g;
      for (unsigned int d = 0; d < 3; ++d)
        for (unsigned int c = 0; c < 3; ++c)
          {
            N difference[4];
            for (unsigned int p = 0; p < 4; ++p)
              difference[p] = u[lower_node(d, p) + (1u << d)][c] - u[lower_node(d, p)][c];
            N *const values[4] = {&g.value[d][0][c],
                                  &g.value[d][1][c],
                                  &g.value[d][2][c],
                                  &g.value[d][3][c]};
            interpolate(difference, values);
          }
      return g;
    }

    /**
     * The transpose of evaluate(): nodal forces f[node][c] = sum_dp value[d][p][c]
     * d(gradient)/d(u), where value[d][p] already holds the sum over the two points of direction d.
     */
    void
    integrate(N (&f)[8][3]) const
    {
      for (unsigned int c = 0; c < 3; ++c)
        {
          for (unsigned int node = 0; node < 8; ++node)
            f[node][c] = N(0.);
          for (unsigned int d = 0; d < 3; ++d)
            {
              const N at_points[4] = {value[d][0][c],
                                      value[d][1][c],
                                      value[d][2][c],
                                      value[d][3][c]};
              N on_edges[4];
              N *const edges[4] = {&on_edges[0], &on_edges[1], &on_edges[2], &on_edges[3]};
              interpolate(at_points, edges);
              for (unsigned int p = 0; p < 4; ++p)
                {
                  f[lower_node(d, p)][c] -= on_edges[p];
                  f[lower_node(d, p) + (1u << d)][c] += on_edges[p];
                }
            }
        }
    }

    void
    clear()
    {
      for (unsigned int d = 0; d < 3; ++d)
        for (unsigned int p = 0; p < 4; ++p)
          for (unsigned int c = 0; c < 3; ++c)
            value[d][p][c] = N(0.);
    }

    /// Gradient at Gauss point q: matrix(c, d) = d u_c / d xi_d.
    Matrix3<N>
    at(const unsigned int q) const
    {
      Matrix3<N> gradient;
      for (unsigned int d = 0; d < 3; ++d)
        for (unsigned int c = 0; c < 3; ++c)
          gradient(c, d) = value[d][transverse(d, q)][c];
      return gradient;
    }

    /// Add a weight conjugate to the gradient at Gauss point q, for integrate().
    void
    add(const unsigned int q, const Matrix3<N> &weight)
    {
      for (unsigned int d = 0; d < 3; ++d)
        for (unsigned int c = 0; c < 3; ++c)
          value[d][transverse(d, q)][c] += weight(c, d);
    }

    /// Gradient at the centre of the cell.
    Matrix3<N>
    at_centre() const
    {
      Matrix3<N> gradient;
      for (unsigned int d = 0; d < 3; ++d)
        for (unsigned int c = 0; c < 3; ++c)
          gradient(c, d) = 0.25 *
                           (value[d][0][c] + value[d][1][c] + value[d][2][c] + value[d][3][c]);
      return gradient;
    }

  private:
    // Bilinear interpolation from the four edges to the four transverse points, with the factor 1/2
    // of the derivative; symmetric, hence its own transpose.
    static void
    interpolate(const N (&in)[4], N *const (&out)[4])
    {
      const N lower_0 = (0.5 * a) * in[0] + (0.5 * b) * in[1];
      const N upper_0 = (0.5 * b) * in[0] + (0.5 * a) * in[1];
      const N lower_1 = (0.5 * a) * in[2] + (0.5 * b) * in[3];
      const N upper_1 = (0.5 * b) * in[2] + (0.5 * a) * in[3];
      *out[0]         = a * lower_0 + b * lower_1;
      *out[1]         = a * upper_0 + b * upper_1;
      *out[2]         = b * lower_0 + a * lower_1;
      *out[3]         = b * upper_0 + a * upper_1;
    }
  };


  /**
   * Volume of a trilinear hexahedron, exactly (Grandy 1997, "Efficient computation of volume of
   * hexahedral cells"): the sum of three triple products over 12, what 2 x 2 x 2 Gauss points give
   * too but for a quarter of their work.
   * @param x  positions [node][component], length
   */
  template <typename N>
  [[gnu::always_inline]] inline N
  hexahedron_volume(const N (&x)[8][3])
  {
    Matrix3<N> triples[3];
    for (unsigned int c = 0; c < 3; ++c)
      {
        const N a[3]     = {x[6][c] - x[0][c], x[5][c] - x[0][c], x[3][c] - x[0][c]};
        const N b[3]     = {x[7][c] - x[1][c], x[7][c] - x[2][c], x[7][c] - x[4][c]};
        triples[0](0, c) = b[0] + a[0];
        triples[0](1, c) = b[1];
        triples[0](2, c) = a[2];
        triples[1](0, c) = a[0];
        triples[1](1, c) = b[1] + a[1];
        triples[1](2, c) = b[2];
        triples[2](0, c) = b[0];
        triples[2](1, c) = a[1];
        triples[2](2, c) = b[2] + a[2];
      }
    return (determinant(triples[0]) + determinant(triples[1]) + determinant(triples[2])) *
           (1. / 12.);
  }


  /**
   * Lumped masses of a cell: row sums of its consistent mass matrix, m_a = int rho N_a dOmega with
   * 2 x 2 x 2 Gauss points. Positive for any valid cell.
   * @param X        initial positions [node][component], length
   * @param density  rho_0, mass/volume
   * @param mass     the cell's share of the nodal masses, mass
   */
  template <typename N>
  void
  lump_cell_mass(const N (&X)[8][3], const double density, N (&mass)[8])
  {
    const auto gradients = TrilinearGradients<N>::evaluate(X);
    for (auto &of_node : mass)
      of_node = N(0.);
    for (unsigned int q = 0; q < 8; ++q)
      {
        const Matrix3<N> J = gradients.at(q);
        const N j          = determinant(J, cofactor(J));
        for (unsigned int v = 0; v < 8; ++v)
          {
            double shape_value = density;
            for (unsigned int d = 0; d < 3; ++d)
              shape_value *= ((v >> d) & 1) == ((q >> d) & 1) ? TrilinearGradients<N>::a :
                                                                TrilinearGradients<N>::b;
            mass[v] += shape_value * j;
          }
      }
  }
} // namespace akmon
