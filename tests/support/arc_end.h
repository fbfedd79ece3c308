#pragma once

#include <akmon/material/arc_end.h>
#include <akmon/material/hypoelastic.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <string>

#include "support/report.h"

namespace akmon::test::arc_end_paths
{
  // The ARC-end update of a hypoelastic point along given paths of deformation.

  using Matrix = Matrix3<double>;
  using Stress = Symmetric3<double>;
  using Path   = std::function<Matrix(double)>; // deformation gradient at 0 <= t <= 1, the identity
                                                // at 0
  using Update = std::function<void(const Matrix &F, Stress &stress)>; // one step

  // E = 1000, nu = 0.25: lambda = mu = 400, M = 1200, K = 2000/3.
  inline const double E  = 1000.;
  inline const double nu = 0.25;
  inline const Hypoelastic elastic{Elasticity::from_young(E, nu)};


  inline Matrix
  diagonal(const double x, const double y, const double z)
  {
    return {{{x, 0., 0.}, {0., y, 0.}, {0., 0., z}}};
  }


  inline Matrix
  transpose(const Matrix &a)
  {
    Matrix result;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        result(i, j) = a(j, i);
    return result;
  }


  inline double
  determinant(const Matrix &a)
  {
    return akmon::determinant(a, cofactor(a));
  }


  inline Matrix
  inverse(const Matrix &a)
  {
    const Matrix identity = diagonal(1., 1., 1.);
    return times_inverse(identity, cofactor(a), 1. / determinant(a));
  }


  // a - I
  inline Matrix
  minus_identity(Matrix a)
  {
    for (unsigned int i = 0; i < 3; ++i)
      a(i, i) -= 1.;
    return a;
  }


  // Rodrigues' formula about the axis (x, y, z), of any length.
  inline Matrix
  rotation(const double degrees, const double x, const double y, const double z)
  {
    const double length = std::sqrt(x * x + y * y + z * z);
    const double n[3]   = {x / length, y / length, z / length};
    const double angle  = degrees * std::acos(-1.) / 180.;
    const double c = std::cos(angle), s = std::sin(angle);
    const double cross[3][3] = {{0., -n[2], n[1]}, {n[2], 0., -n[0]}, {-n[1], n[0], 0.}};
    Matrix result;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        result(i, j) = (i == j ? c : 0.) + s * cross[i][j] + (1. - c) * n[i] * n[j];
    return result;
  }


  inline Matrix
  rotation(const double degrees)
  {
    return rotation(degrees, 1., 2., -0.5);
  }


  // Q s Q^T
  inline Stress
  rotated(const Matrix &Q, const Stress &s)
  {
    return push_forward(Q, s, 1.);
  }


  inline double
  norm(const Stress &s)
  {
    return std::sqrt(contract(s, s));
  }


  inline double
  distance(const Stress &a, const Stress &b)
  {
    Stress difference;
    for (unsigned int i = 0; i < 6; ++i)
      difference[i] = a[i] - b[i];
    return norm(difference);
  }


  template <typename Law>
  StressIncrement<double>
  update(const Law &law, const Matrix &F, Stress &stress, double *internals = nullptr)
  {
    return arc_end_update(law, minus_identity(F), determinant(F), stress, internals);
  }


  inline void
  arc_end(const Matrix &F, Stress &stress)
  {
    update(elastic, F, stress);
  }


  inline Stress
  one_step(const Update &step, const Matrix &F, Stress stress = {})
  {
    step(F, stress);
    return stress;
  }


  // Stress at the end of the path, in N equal steps of its parameter from no stress.
  inline Stress
  integrate(const Path &path, const unsigned int N, const Update &step = arc_end)
  {
    Stress stress = {};
    for (unsigned int n = 0; n < N; ++n)
      step(path((n + 1.) / N) * inverse(path(double(n) / N)), stress);
    return stress;
  }


  // Observed order of convergence from the errors with N and 2N steps.
  inline double
  observed_order(const double error, const double error_half_step)
  {
    return std::log2(error / error_half_step);
  }


  inline Path
  uniaxial_strain(const double stretch)
  {
    return [=](const double t) { return diagonal(1. + (stretch - 1.) * t, 1., 1.); };
  }


  // Turns by 90 degrees while it stretches.
  inline Matrix
  rotating_stretch(const double t)
  {
    return rotation(90. * t, 0., 0., 1.) * diagonal(1. + 0.3 * t, 1. - 0.1 * t, 1. + 0.1 * t);
  }

  // Exact at t = 1: the Truesdell rate does not see the rotation, so the stretch alone may be
  // integrated (d sigma_i/dt = (2 l_i'/l_i - sum l_k'/l_k) sigma_i + lambda sum l_k'/l_k + 2 mu
  // l_i'/l_i, by quadrature) and turned by 90 degrees at the end.
  inline const Stress rotating_stretch_exact = {{12.021976, 358.185785, 172.621651, 0., 0., 0.}};


  // As above with Simpson's rule over the integrating factor J/l_i^2, for orders at small errors.
  inline Stress
  rotating_stretch_by_quadrature()
  {
    const double rates[3] = {0.3, -0.1, 0.1};
    const auto stretch    = [&](const unsigned int i, const double t) { return 1. + rates[i] * t; };
    const auto volume     = [&](const double t) {
      return stretch(0, t) * stretch(1, t) * stretch(2, t);
    };
    const auto integrand = [&](const unsigned int i, const double t) {
      double volumetric = 0.;
      for (unsigned int k = 0; k < 3; ++k)
        volumetric += rates[k] / stretch(k, t);
      return volume(t) / (stretch(i, t) * stretch(i, t)) *
             (elastic.elasticity.lambda * volumetric +
              2. * elastic.elasticity.mu * rates[i] / stretch(i, t));
    };
    double principal[3];
    const unsigned int intervals = 1000;
    for (unsigned int i = 0; i < 3; ++i)
      {
        double sum = 0.;
        for (unsigned int k = 0; k < intervals; ++k)
          sum += (integrand(i, double(k) / intervals) + 4. * integrand(i, (k + 0.5) / intervals) +
                  integrand(i, (k + 1.) / intervals)) /
                 (6. * intervals);
        principal[i] = sum * stretch(i, 1.) * stretch(i, 1.) / volume(1.);
      }
    return {{principal[1], principal[0], principal[2], 0., 0., 0.}};
  }


  // The same numbers in every test, run alone or with the others.
  struct Random
  {
    std::mt19937 generator{1};

    double
    between(const double low, const double high)
    {
      return low + (high - low) * (generator() / 4294967296.);
    }

    // I + entries up to 0.3: 50 % strains and 20 degree turns, no inversion.
    Matrix
    deformation()
    {
      Matrix F = diagonal(1., 1., 1.);
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          F(i, j) += between(-0.3, 0.3);
      return F;
    }

    Stress
    stress()
    {
      Stress result;
      for (unsigned int i = 0; i < 6; ++i)
        result[i] = between(-300., 300.);
      return result;
    }
  };


  // |sigma(Q F) - Q sigma(F) Q^T| / |sigma(F)|, from no stress
  inline double
  lack_of_objectivity(const Update &step, const Matrix &F, const Matrix &Q)
  {
    const Stress straight = one_step(step, F);
    return distance(one_step(step, Q * F), rotated(Q, straight)) / norm(straight);
  }


  // A step of relative size h that stretches by up to 20 % h and turns by 40 degrees h.
  inline double
  lack_of_objectivity(const Update &step, const double h)
  {
    return lack_of_objectivity(step,
                               diagonal(1. + 0.2 * h, 1. - 0.1 * h, 1. + 0.1 * h),
                               rotation(40. * h));
  }
} // namespace akmon::test::arc_end_paths
