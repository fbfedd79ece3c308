#include <akmon/contact/coupled/gauss_seidel.h>

#include <algorithm>

namespace akmon
{
  void
  sweep(const Eigen::MatrixXd &A,
        const FrictionalProblem &problem,
        const unsigned int n_sweeps,
        FrictionalProblem::Vector &t)
  {
    constexpr unsigned int n_steps = 3; // of a pair: its friction limit follows its normal force

    const Eigen::Map<const Eigen::VectorXd> forces(t.front().begin_raw(), A.rows());
    for (unsigned int k = 0; k < n_sweeps; ++k)
      for (std::size_t i = 0; i < t.size(); ++i)
        {
          const double norm = A.block<3, 3>(3 * i, 3 * i).cwiseAbs().rowwise().sum().maxCoeff();
          if (!(norm > 0.)) // nothing can move
            continue;
          for (unsigned int n = 0; n < n_steps; ++n)
            {
              const Eigen::Vector3d moved = A.middleRows<3>(3 * i) * forces;
              CoulombFace::Force q        = t[i];
              for (unsigned int d = 0; d < 3; ++d)
                q[d] -= (moved[d] + problem.b[i][d]) / norm;
              t[i] = CoulombFace::project(q, problem.friction[i] * std::max(q[0], 0.));
            }
        }
  }
} // namespace akmon
