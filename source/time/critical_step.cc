#include <akmon/forces/elastic_stiffness.h>
#include <akmon/time/critical_step.h>

namespace akmon
{
  namespace
  {
    // u . M w
    template <typename N>
    N
    mass_product(const N (&mass)[8], const N (&u)[8][3], const N (&w)[8][3])
    {
      N sum(0.);
      for (unsigned int v = 0; v < 8; ++v)
        sum += mass[v] * (u[v][0] * w[v][0] + u[v][1] * w[v][1] + u[v][2] * w[v][2]);
      return sum;
    }


    // Start vector of the iteration: stretch along each reference direction, plus a part of every
    // other pattern so that no eigenvector is missed by symmetry.
    template <typename N>
    void
    start_vector(const Matrix3<N> &jacobian, N (&u)[8][3])
    {
      const Matrix3<N> normals = cofactor(jacobian);
      for (unsigned int v = 0; v < 8; ++v)
        for (unsigned int c = 0; c < 3; ++c)
          {
            u[v][c] = N(0.);
            for (unsigned int d = 0; d < 3; ++d)
              {
                const double sign = (v >> d) & 1 ? 1. : -1.;
                // A scatter between -1 and 1 that shares no symmetry with the cell.
                const double other = ((11 * (24 * d + 3 * v + c) + 5) % 37) / 18. - 1.;
                u[v][c] += (sign * (1. + 0.17 * d) + 0.4 * other) * normals(c, d);
              }
          }
    }


    // Largest eigenvalue of the symmetric tridiagonal matrix with diagonal a and squared
    // off-diagonal b2, by bisection from above: x exceeds it if and only if all pivots of x I - T
    // are positive.
    template <typename N, std::size_t n>
    N
    largest_tridiagonal_eigenvalue(const N (&a)[n], const N (&b2)[n])
    {
      constexpr unsigned int n_bisections = 20;

      N lower = a[0], upper(0.);
      for (unsigned int j = 0; j < n; ++j)
        {
          lower          = maximum(lower, a[j]);
          const N radius = square_root(b2[j]) + (j > 0 ? square_root(b2[j - 1]) : N(0.));
          upper          = maximum(upper, N(a[j] + radius));
        }
      for (unsigned int bisection = 0; bisection < n_bisections; ++bisection)
        {
          const N x = 0.5 * (lower + upper);
          N pivot = x - a[0], least = pivot;
          for (unsigned int j = 1; j < n; ++j)
            {
              pivot = x - a[j] - b2[j - 1] / pivot;
              least = select(pivot < least, pivot, least);
            }
          const auto above = least > N(0.);
          upper            = select(above, x, upper);
          lower            = select(above, lower, x);
        }
      return upper;
    }
  } // namespace


  template <typename N>
  N
  largest_eigenvalue(const N (&x)[8][3],
                     const N (&mass)[8],
                     const Elasticity &elasticity,
                     const CellIntegration integration)
  {
    // The cell has 18 strain modes; this many steps find the largest eigenvalue to a few parts in
    // 1000 in
    // the worst of the tested shapes. The margin covers that.
    constexpr unsigned int n_steps = 14;
    constexpr double margin        = 1.004;

    const auto positions = TrilinearGradients<N>::evaluate(x);
    N v[8][3], v_before[8][3], w[8][3], a[n_steps], b2[n_steps];
    start_vector(positions.at_centre(), v);
    N scale = 1. / square_root(mass_product(mass, v, v));
    for (unsigned int node = 0; node < 8; ++node)
      for (unsigned int c = 0; c < 3; ++c)
        {
          v[node][c] *= scale;
          v_before[node][c] = N(0.);
        }

    const ElasticCell<N> cell(positions, elasticity, integration);
    N b(0.), inverse_mass[8];
    for (unsigned int node = 0; node < 8; ++node)
      inverse_mass[node] = 1. / mass[node];
    for (unsigned int j = 0; j < n_steps; ++j)
      {
        cell.apply(v, w);
        for (unsigned int node = 0; node < 8; ++node)
          for (unsigned int c = 0; c < 3; ++c)
            w[node][c] = w[node][c] * inverse_mass[node] - b * v_before[node][c];
        a[j] = mass_product(mass, v, w);
        for (unsigned int node = 0; node < 8; ++node)
          for (unsigned int c = 0; c < 3; ++c)
            w[node][c] -= a[j] * v[node][c];
        b2[j] = mass_product(mass, w, w);
        b     = square_root(b2[j]);
        // Where the vectors span an invariant space what is left is rounding; it must not be scaled
        // up.
        const auto left = b > 1e-5 * a[0];
        b2[j]           = select(left, b2[j], N(0.));
        scale           = select(left, N(1. / b), N(0.));
        b               = select(left, b, N(0.));
        for (unsigned int node = 0; node < 8; ++node)
          for (unsigned int c = 0; c < 3; ++c)
            {
              v_before[node][c] = v[node][c];
              v[node][c]        = scale * w[node][c];
            }
      }
    b2[n_steps - 1] = N(0.);
    return margin * largest_tridiagonal_eigenvalue(a, b2);
  }


  template double
  largest_eigenvalue<double>(const double (&)[8][3],
                             const double (&)[8],
                             const Elasticity &,
                             const CellIntegration);
  template Lanes
  largest_eigenvalue<Lanes>(const Lanes (&)[8][3],
                            const Lanes (&)[8],
                            const Elasticity &,
                            const CellIntegration);
} // namespace akmon
