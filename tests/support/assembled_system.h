#pragma once

#include <akmon/forces/elastic_stiffness.h>
#include <akmon/simulation.h>

#include <Eigen/Eigenvalues>
#include <random>
#include <vector>

namespace akmon::test
{
  // omega_max^2 of M^{-1} K of all bodies with the elastic stiffness on the configuration x:
  // Lanczos' method, all vectors kept orthogonal, until the residual of the largest pair is below
  // 1e-5 of it. One rank.
  inline double
  assembled_frequency_squared(const Discretization &discretization, const NodalVector &x)
  {
    const unsigned int n = 3 * discretization.n_nodes;
    std::vector<double> root_mass(n);
    for (unsigned int i = 0; i < n; ++i)
      root_mass[i] = std::sqrt(discretization.mass[i / 3]);

    const auto apply = [&](const Eigen::VectorXd &q) {
      Eigen::VectorXd y = Eigen::VectorXd::Zero(n);
      for (const auto &cell : discretization.cells)
        {
          double positions[8][3], u[8][3], f[8][3];
          for (unsigned int v = 0; v < 8; ++v)
            for (unsigned int d = 0; d < 3; ++d)
              {
                const unsigned int i = 3 * cell.nodes[v] + d;
                positions[v][d]      = x.local_element(i);
                u[v][d]              = q[i] / root_mass[i];
              }
          ElasticCell<double>(TrilinearGradients<double>::evaluate(positions),
                              discretization.material_of(cell.body).elasticity(),
                              discretization.get_bodies()[cell.body].integration)
            .apply(u, f);
          for (unsigned int v = 0; v < 8; ++v)
            for (unsigned int d = 0; d < 3; ++d)
              {
                const unsigned int i = 3 * cell.nodes[v] + d;
                y[i] += f[v][d] / root_mass[i];
              }
        }
      return y;
    };

    std::mt19937 generator(7);
    std::normal_distribution<double> normal;
    std::vector<Eigen::VectorXd> basis;
    std::vector<double> a, b;
    Eigen::VectorXd q(n);
    for (auto &value : q)
      value = normal(generator);
    q.normalize();
    while (true)
      {
        basis.push_back(q);
        q = apply(q);
        a.push_back(q.dot(basis.back()));
        for (unsigned int pass = 0; pass < 2; ++pass)
          for (const auto &vector : basis)
            q -= q.dot(vector) * vector;
        b.push_back(q.norm());
        const unsigned int m = a.size();
        if (m % 20 == 0 || m >= n || b.back() < 1e-10 * a[0])
          {
            Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
            solver.computeFromTridiagonal(Eigen::Map<Eigen::VectorXd>(a.data(), m),
                                          Eigen::Map<Eigen::VectorXd>(b.data(), m - 1));
            const double largest  = solver.eigenvalues()[m - 1];
            const double residual = b.back() * std::abs(solver.eigenvectors()(m - 1, m - 1));
            if (m >= n || (m >= std::min(100u, n) && residual < 1e-5 * largest) ||
                b.back() < 1e-10 * a[0])
              return largest;
          }
        q /= b.back();
      }
  }
} // namespace akmon::test
