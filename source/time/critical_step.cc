#include <akmon/time/critical_step.h>

namespace akmon
{
  namespace
  {
    constexpr unsigned int n_points = CellBatches::n_points;

    // f = K u for linear elasticity on the configuration x, with the cell integration of the time
    // loop.
    template <typename N>
    void
    apply_stiffness(const TrilinearGradients<N> &positions,
                    const Elasticity &elasticity,
                    const CellIntegration integration,
                    const N (&u)[8][3],
                    N (&f)[8][3])
    {
      const auto gradients = TrilinearGradients<N>::evaluate(u);
      Symmetric3<N> strain[n_points];
      N volume(0.), dilatation(0.);
      for (unsigned int q = 0; q < n_points; ++q)
      {
        const Matrix3<N> J         = positions.at(q);
        const Matrix3<N> cofactors = cofactor(J);
        const N j                  = determinant(J, cofactors);
        strain[q] = symmetric_part(times_inverse(gradients.at(q), cofactors, N(1. / j)));
        volume += j;
        dilatation += j * trace(strain[q]);
      }
      TrilinearGradients<N> weights;
      weights.clear();
      const N mean = dilatation / volume;
      for (unsigned int q = 0; q < n_points; ++q)
      {
        if (integration == CellIntegration::mean_dilatation)
          strain[q] = add_to_diagonal(strain[q], N((mean - trace(strain[q])) * (1. / 3.)));
        weights.add(q, elasticity.stress(strain[q]) * cofactor(positions.at(q)));
      }
      // With the mean dilatation in the strain, the pressure part 3 K mean I is constant over the
      // cell and its weights integrate to the mean divergence: no further averaging is needed.
      weights.integrate(f);
    }


    template <typename N>
    N
    mass_norm_squared(const N (&mass)[8], const N (&u)[8][3])
    {
      N sum(0.);
      for (unsigned int v = 0; v < 8; ++v)
        sum += mass[v] * (u[v][0] * u[v][0] + u[v][1] * u[v][1] + u[v][2] * u[v][2]);
      return sum;
    }


    // Start vector of the iteration: stretch along each reference direction, plus a small part of
    // every other pattern so that no eigenvector is missed by symmetry.
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
            u[v][c] += (sign * (1. + 0.17 * d)) * normals(c, d);
          }
          u[v][c] += 0.05 * (((3 * v + 7 * c + v * c) % 11) / 5. - 1.) * normals(c, (v + c) % 3);
        }
    }
  } // namespace


  template <typename N>
  N
  largest_eigenvalue(const N (&x)[8][3],
                     const N (&mass)[8],
                     const Elasticity &elasticity,
                     const CellIntegration integration)
  {
    constexpr unsigned int n_iterations = 30;

    const auto positions = TrilinearGradients<N>::evaluate(x);
    N u[8][3], f[8][3];
    start_vector(positions.at_centre(), u);

    N eigenvalue(0.), residual(0.);
    for (unsigned int iteration = 0; iteration < n_iterations; ++iteration)
    {
      const N scale = 1. / square_root(mass_norm_squared(mass, u));
      for (auto &node : u)
        for (auto &component : node)
          component *= scale;
      apply_stiffness(positions, elasticity, integration, u, f);

      eigenvalue = N(0.);
      for (unsigned int v = 0; v < 8; ++v)
        for (unsigned int c = 0; c < 3; ++c)
        {
          eigenvalue += u[v][c] * f[v][c];
          f[v][c] = f[v][c] / mass[v];
        }
      for (unsigned int v = 0; v < 8; ++v)
        for (unsigned int c = 0; c < 3; ++c)
        {
          const N next = f[v][c];
          f[v][c]      = next - eigenvalue * u[v][c];
          u[v][c]      = next;
        }
      residual = square_root(mass_norm_squared(mass, f));
    }
    return eigenvalue + residual;
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
