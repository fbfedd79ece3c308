#include <akmon/contact/coupled/active_set.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>
#include <vector>

namespace akmon
{
  namespace
  {
    // The pairs whose gaps are closed, w = 0, and all forces.
    struct ActiveSet
    {
      const Eigen::MatrixXd &A;
      std::vector<int> active;
      Eigen::VectorXd &t;

      Eigen::MatrixXd
      matrix() const
      {
        return A(active, active);
      }

      // Close the gap w of a pair that is not active, while all active ones stay closed; those
      // whose force becomes zero leave. False if there is no such force.
      bool
      close(const int j, double w)
      {
        constexpr double dependent = 1e-13; // of the diagonal: pairs repeat each other

        for (;;)
          {
            const Eigen::VectorXd column = A(active, j);
            const Eigen::VectorXd d      = -matrix().llt().solve(column);
            const double compliance      = A(j, j) + column.dot(d);
            const bool is_free           = compliance > dependent;
            double step     = is_free ? -w / compliance : std::numeric_limits<double>::infinity();
            const int stays = -1;
            int leaves      = stays;
            for (int i = 0; i < d.size(); ++i)
              if (d[i] < 0. && -t[active[i]] > step * d[i])
                {
                  step   = -t[active[i]] / d[i];
                  leaves = i;
                }
            if (leaves == stays && !is_free)
              return false;
            for (int i = 0; i < d.size(); ++i)
              t[active[i]] += step * d[i];
            t[j] += step;
            if (leaves == stays)
              {
                active.push_back(j);
                return true;
              }
            w += step * compliance;
            t[active[leaves]] = 0.;
            active.erase(active.begin() + leaves);
          }
      }


      // What has been lost in many steps.
      void
      refine(const Eigen::VectorXd &b)
      {
        const Eigen::VectorXd exact = -matrix().llt().solve(b(active));
        if (exact.size() > 0 && exact.minCoeff() >= 0.)
          t(active) = exact;
      }
    };
  } // namespace


  bool
  solve_by_active_set(const Eigen::MatrixXd &A,
                      const Eigen::VectorXd &b,
                      const Eigen::VectorXd &weights,
                      const double tolerance,
                      Eigen::VectorXd &t)
  {
    constexpr int most_changes = 10; // for each pair

    // From none: pairs that are known to press may repeat each other, which spoils what follows.
    t.setZero(b.size());
    ActiveSet set{A, {}, t};
    for (int n = 0; n <= most_changes * b.size(); ++n)
      {
        set.refine(b);
        const Eigen::VectorXd w  = A * t + b;
        Eigen::VectorXd weighted = w.cwiseProduct(weights);
        for (const int i : set.active)
          weighted[i] = 0.;
        int worst;
        if (weighted.size() == 0 || weighted.minCoeff(&worst) >= -tolerance)
          return true;
        if (!(A(worst, worst) > 0.) || !set.close(worst, w[worst]))
          return false;
      }
    return false;
  }
} // namespace akmon
