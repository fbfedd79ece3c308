#pragma once

#include <akmon/time/critical_step.h>

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/lapack_full_matrix.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "support/report.h"

namespace akmon::test
{
  // Largest eigenvalues of a cell from an independent stiffness matrix: B-matrices in Voigt form at
  // 2 x 2 x 2 Gauss points, B-bar for the mean dilatation, row-sum lumped masses, dense symmetric
  // eigenvalues.

  using dealii::Tensor;

  using Nodes  = std::array<std::array<double, 3>, 8>;
  using Masses = std::array<double, 8>;

  // Of the estimated step below the true one.
  inline constexpr double allowed_loss = 0.03;
  // The estimated step may exceed the true one by rounding only.
  inline constexpr double rounding = 1e-10;

  inline constexpr CellIntegration integrations[] = {CellIntegration::full,
                                                     CellIntegration::mean_dilatation};


  // Critical steps of free meshes of cubes (doc/verification.md, section 7): nu = .3, dt c_d/h to
  // four digits, full integration.
  struct CubeMesh
  {
    std::array<unsigned int, 3> cells;
    double dt;
  };

  inline constexpr CubeMesh cube_meshes[] = {{{{1, 1, 1}}, .7338},
                                             {{{1, 1, 100}}, .8050},
                                             {{{2, 2, 2}}, .9277},
                                             {{{4, 4, 4}}, .9579},
                                             {{{8, 8, 8}}, .9632}};


  struct Shape
  {
    std::array<double, 8> N;
    std::array<std::array<double, 3>, 8> gradient; ///< with respect to x
    double jacobian;
  };


  inline Shape
  shape_at(const Nodes &x, const std::array<double, 3> &xi)
  {
    Shape shape;
    std::array<std::array<double, 3>, 8> reference_gradient;
    double J[3][3] = {};
    for (unsigned int a = 0; a < 8; ++a)
      {
        double factor[3], slope[3];
        for (unsigned int d = 0; d < 3; ++d)
          {
            const double sign = (a >> d) & 1 ? 1. : -1.;
            factor[d]         = 0.5 * (1. + sign * xi[d]);
            slope[d]          = 0.5 * sign;
          }
        shape.N[a]            = factor[0] * factor[1] * factor[2];
        reference_gradient[a] = {{slope[0] * factor[1] * factor[2],
                                  factor[0] * slope[1] * factor[2],
                                  factor[0] * factor[1] * slope[2]}};
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int d = 0; d < 3; ++d)
            J[i][d] += x[a][i] * reference_gradient[a][d];
      }
    Tensor<2, 3> jacobian;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int d = 0; d < 3; ++d)
        jacobian[i][d] = J[i][d];
    shape.jacobian     = determinant(jacobian);
    const auto inverse = invert(jacobian);
    for (unsigned int a = 0; a < 8; ++a)
      for (unsigned int i = 0; i < 3; ++i)
        {
          shape.gradient[a][i] = 0.;
          for (unsigned int d = 0; d < 3; ++d)
            shape.gradient[a][i] += reference_gradient[a][d] * inverse[d][i];
        }
    return shape;
  }


  // Gauss points with their weights 1.
  inline std::vector<std::array<double, 3>>
  gauss_points()
  {
    const double g = 1. / std::sqrt(3.);
    std::vector<std::array<double, 3>> points;
    for (const double z : {-g, g})
      for (const double y : {-g, g})
        for (const double x : {-g, g})
          points.push_back({{x, y, z}});
    return points;
  }


  inline Masses
  lumped_masses(const Nodes &x, const double density)
  {
    Masses mass{};
    for (const auto &point : gauss_points())
      {
        const Shape shape = shape_at(x, point);
        for (unsigned int a = 0; a < 8; ++a)
          mass[a] += density * shape.N[a] * shape.jacobian;
      }
    return mass;
  }


  inline bool
  valid(const Nodes &x)
  {
    for (const double i : {-1., 1.})
      for (const double j : {-1., 1.})
        for (const double k : {-1., 1.})
          if (!(shape_at(x, {{i, j, k}}).jacobian > 0.))
            return false;
    return true;
  }


  // omega_max^2 of M^{-1} K.
  inline double
  exact_eigenvalue(const Nodes &x,
                   const Masses &mass,
                   const Elasticity &elasticity,
                   const CellIntegration integration)
  {
    std::array<std::array<double, 3>, 8> mean_gradient{};
    double volume = 0.;
    for (const auto &point : gauss_points())
      {
        const Shape shape = shape_at(x, point);
        volume += shape.jacobian;
        for (unsigned int a = 0; a < 8; ++a)
          for (unsigned int i = 0; i < 3; ++i)
            mean_gradient[a][i] += shape.gradient[a][i] * shape.jacobian;
      }

    dealii::LAPACKFullMatrix<double> K(24, 24);
    for (unsigned int i = 0; i < 24; ++i)
      for (unsigned int j = 0; j < 24; ++j)
        K(i, j) = 0.;
    for (const auto &point : gauss_points())
      {
        const Shape shape   = shape_at(x, point);
        double B[6][24]     = {}; // xx, yy, zz, 2xy, 2yz, 2zx
        const double lambda = elasticity.lambda, mu = elasticity.mu;
        for (unsigned int a = 0; a < 8; ++a)
          for (unsigned int i = 0; i < 3; ++i)
            {
              const unsigned int next = (i + 1) % 3;
              B[i][3 * a + i]         = shape.gradient[a][i];
              B[3 + i][3 * a + i]     = shape.gradient[a][next];
              B[3 + i][3 * a + next]  = shape.gradient[a][i];
            }
        if (integration == CellIntegration::mean_dilatation)
          for (unsigned int a = 0; a < 8; ++a)
            for (unsigned int i = 0; i < 3; ++i)
              for (unsigned int k = 0; k < 3; ++k)
                B[k][3 * a + i] += (mean_gradient[a][i] / volume - shape.gradient[a][i]) / 3.;

        double C[6][6] = {};
        for (unsigned int i = 0; i < 3; ++i)
          {
            for (unsigned int j = 0; j < 3; ++j)
              C[i][j] = lambda;
            C[i][i] += 2. * mu;
            C[3 + i][3 + i] = mu;
          }
        for (unsigned int i = 0; i < 24; ++i)
          for (unsigned int j = 0; j < 24; ++j)
            for (unsigned int k = 0; k < 6; ++k)
              for (unsigned int l = 0; l < 6; ++l)
                K(i, j) += B[k][i] * C[k][l] * B[l][j] * shape.jacobian;
      }
    for (unsigned int i = 0; i < 24; ++i)
      for (unsigned int j = 0; j < 24; ++j)
        K(i, j) = K(i, j) / std::sqrt(mass[i / 3] * mass[j / 3]);
    dealii::Vector<double> eigenvalues;
    dealii::FullMatrix<double> eigenvectors;
    K.compute_eigenvalues_symmetric(-1e300, 1e300, 0., eigenvalues, eigenvectors);
    return *std::max_element(eigenvalues.begin(), eigenvalues.end());
  }


  inline double
  estimate(const Nodes &x,
           const Masses &mass,
           const Elasticity &elasticity,
           const CellIntegration integration)
  {
    double positions[8][3], masses[8];
    for (unsigned int a = 0; a < 8; ++a)
      {
        masses[a] = mass[a];
        std::copy(x[a].begin(), x[a].end(), positions[a]);
      }
    return largest_eigenvalue(positions, masses, elasticity, integration);
  }


  // Estimated over true critical step.
  inline double
  ratio_of_steps(const double estimate, const double exact)
  {
    return std::sqrt(exact / estimate);
  }


  inline Nodes
  brick(const double a, const double b, const double c)
  {
    Nodes x;
    for (unsigned int v = 0; v < 8; ++v)
      x[v] = {{v & 1 ? a : 0., v & 2 ? b : 0., v & 4 ? c : 0.}};
    return x;
  }


  // Extremes of the ratio of steps over many cells.
  struct Range
  {
    double low = 1e300, high = 0.;

    void
    add(const double value)
    {
      low  = std::min(low, value);
      high = std::max(high, value);
    }
  };
} // namespace akmon::test
