#pragma once

#include <deal.II/base/tensor.h>

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace akmon::test
{
  using Vector      = dealii::Tensor<1, 3>;
  using Frame       = dealii::Tensor<2, 3>;
  using DenseMatrix = std::vector<std::vector<double>>;

  inline double
  norm_bound(const DenseMatrix &A)
  {
    double largest = 0.;
    for (const auto &row : A)
      {
        double sum = 0.;
        for (const double a : row)
          sum += std::abs(a);
        largest = std::max(largest, sum);
      }
    return largest;
  }


  /// A frame whose first row is a vector.
  inline Frame
  frame_of(const Vector &n)
  {
    Frame frame;
    frame[0] = n / n.norm();
    frame[1] = cross_product_3d(frame[0], Vector({1., 0.3, 0.}));
    frame[1] /= frame[1].norm();
    frame[2] = cross_product_3d(frame[0], frame[1]);
    return frame;
  }


  /// w = A t + b with the blocks A_ij = S_ij F_i F_j^T, S = G G^T scaled to a unit diagonal, F the
  /// frames of the pairs, and b = F G f + gaps along the normals, gaps >= 0: bounded below whatever
  /// the rank of G is.
  struct RandomContact
  {
    RandomContact(const unsigned int n,
                  const unsigned int n_repeated,
                  const unsigned int seed,
                  const bool flat = false)
      : S(n, std::vector<double>(n))
      , b(n)
      , frame(n)
    {
      std::mt19937 random(seed);
      std::normal_distribution<double> gauss;
      const auto vector = [&]() { return Vector({gauss(random), gauss(random), gauss(random)}); };
      DenseMatrix G(n, std::vector<double>(n));
      for (unsigned int i = 0; i < n; ++i)
        {
          for (auto &g : G[i])
            g = gauss(random);
          frame[i] = frame_of(Vector({0., 0., 1.}) + (flat ? 0. : 0.2) * vector());
        }
      for (unsigned int i = 0; i < n_repeated; ++i)
        {
          G[n - 1 - i]     = G[i];
          frame[n - 1 - i] = frame[i];
        }
      for (auto &row : G)
        {
          double square = 0.;
          for (const double g : row)
            square += g * g;
          for (double &g : row)
            g /= std::sqrt(square);
        }
      std::vector<Vector> f(n);
      for (auto &f_k : f)
        f_k = vector();
      for (unsigned int i = 0; i < n; ++i)
        {
          // Every other gap is closed; rows that repeat each other may have different gaps.
          b[i][0] = i % 2 ? 0. : 0.1 * std::abs(gauss(random));
          for (unsigned int k = 0; k < n; ++k)
            b[i] += G[i][k] * (frame[i] * f[k]);
          for (unsigned int j = 0; j < n; ++j)
            for (unsigned int k = 0; k < n; ++k)
              S[i][j] += G[i][k] * G[j][k];
        }
    }

    void
    apply(const std::vector<Vector> &t, std::vector<Vector> &y) const
    {
      for (std::size_t i = 0; i < S.size(); ++i)
        {
          y[i] = Vector();
          for (std::size_t j = 0; j < S.size(); ++j)
            y[i] += S[i][j] * (frame[i] * (t[j] * frame[j]));
        }
    }

    std::vector<Vector>
    relative_motion(const std::vector<Vector> &t) const
    {
      std::vector<Vector> w(t.size());
      apply(t, w);
      for (std::size_t i = 0; i < t.size(); ++i)
        w[i] += b[i];
      return w;
    }

    std::vector<double>
    gaps(const std::vector<Vector> &t) const
    {
      std::vector<double> result;
      for (const auto &w_i : relative_motion(t))
        result.push_back(w_i[0]);
      return result;
    }

    DenseMatrix S;
    std::vector<Vector> b;
    std::vector<Frame> frame;
  };

  /// A with three rows for each pair.
  inline Eigen::MatrixXd
  matrix_of(const RandomContact &problem)
  {
    const unsigned int n = problem.b.size();
    Eigen::MatrixXd A(3 * n, 3 * n);
    std::vector<Vector> unit(n), image(n);
    for (unsigned int column = 0; column < 3 * n; ++column)
      {
        unit[column / 3][column % 3] = 1.;
        problem.apply(unit, image);
        unit[column / 3][column % 3] = 0.;
        for (unsigned int row = 0; row < 3 * n; ++row)
          A(row, column) = image[row / 3][row % 3];
      }
    return A;
  }


  /// Signorini's and Coulomb's conditions of a solution; lengths and forces are of the order of
  /// one.
  inline void
  expect_conditions(const RandomContact &problem,
                    const std::vector<double> &friction,
                    const std::vector<Vector> &t,
                    const unsigned int seed)
  {
    const auto w = problem.relative_motion(t);
    for (std::size_t i = 0; i < t.size(); ++i)
      {
        const double t_n = t[i][0], w_n = w[i][0], limit = friction[i] * t_n;
        const Vector t_tau({0., t[i][1], t[i][2]}), w_tau({0., w[i][1], w[i][2]});
        EXPECT_GE(t_n, 0.) << seed;
        EXPECT_GE(w_n, -1e-11) << seed;
        EXPECT_LE(std::min(t_n, w_n), 1e-10) << seed;
        EXPECT_LE(t_tau.norm(), limit * (1. + 1e-12) + 1e-14) << seed;
        if (t_tau.norm() < limit * (1. - 1e-9))
          {
            EXPECT_LE(w_tau.norm(), 1e-10) << seed;
          }
        else // opposes: |r w_tau + |w_tau| t_tau| = 0
          {
            EXPECT_LE((limit * w_tau + w_tau.norm() * t_tau).norm(), 1e-9 * (1. + limit)) << seed;
          }
      }
  }


  /// Friction of the pairs, one of which has none.
  inline std::vector<double>
  coefficients(const unsigned int n, const unsigned int seed)
  {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0., 0.8);
    std::vector<double> friction(n);
    for (unsigned int i = 0; i < n; ++i)
      friction[i] = i == 2 ? 0. : uniform(random);
    return friction;
  }
} // namespace akmon::test
