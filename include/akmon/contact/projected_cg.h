#pragma once

#include <deal.II/base/mpi.h>
#include <deal.II/base/tensor.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace akmon
{
  /// Unknowns of normal contact: t >= 0.
  struct HalfLine
  {
    using Unknown = double;

    double
    project(const std::size_t, const double t) const
    {
      return std::max(0., t);
    }

    bool
    is_interior(const std::size_t, const double t) const
    {
      return t > 0.;
    }

    /// Largest alpha with t - alpha p admissible.
    double
    longest_step(const std::size_t, const double t, const double p) const
    {
      return p > 0. ? t / p : std::numeric_limits<double>::max();
    }
  };


  /// Unknowns of friction with given bounds: |t_i| <= r_i.
  struct Discs
  {
    using Unknown = dealii::Tensor<1, 3>;

    std::vector<double> radius;

    Unknown
    project(const std::size_t i, const Unknown &t) const
    {
      const double size = t.norm();
      return size <= radius[i] ? t : t * (radius[i] / size);
    }

    bool
    is_interior(const std::size_t i, const Unknown &t) const
    {
      // What lies on the circle up to rounding belongs to it.
      return t.norm_square() < (1. - 1e-12) * radius[i] * radius[i];
    }

    /// Largest alpha with t - alpha p admissible, for an interior t.
    double
    longest_step(const std::size_t i, const Unknown &t, const Unknown &p) const
    {
      const double a = p * p, b = t * p, c = t * t - radius[i] * radius[i];
      return a > 0. ? (b + std::sqrt(std::max(0., b * b - a * c))) / a :
                      std::numeric_limits<double>::max();
    }
  };


  /**
   * Minimizes (1/2) t . A t + b . t over a product of convex sets by proportional conjugate
   * gradients with projections (MPGP; Dostal, Optimal Quadratic Programming Algorithms, 2009, ch. 5
   * and 6): conjugate gradients on the unknowns strictly inside their sets, projected gradient
   * steps when the sets change. A may be singular as long as the problem is bounded below; one
   * application of A per iteration but for iterations that meet a bound.
   */
  template <typename Set>
  class ProjectedConjugateGradients
  {
  public:
    using Unknown = typename Set::Unknown;
    using Vector  = std::vector<Unknown>;

    struct Result
    {
      unsigned int n_applications; ///< of A
      double residual;             ///< largest weighted component of the projected gradient
      bool converged;
    };

    ProjectedConjugateGradients(const MPI_Comm communicator,
                                const double tolerance,
                                const unsigned int limit)
      : communicator(communicator)
      , tolerance(tolerance)
      , limit(limit)
    {
    }

    /**
     * @param apply    apply(t, y): y = A t (collective)
     * @param b        linear term
     * @param weights  what a component of the gradient counts in the residual
     * @param norm     an upper bound of the norm of A
     * @param t        start on entry, solution on return
     */
    template <typename Operator>
    Result
    solve(const Operator &apply,
          const Vector &b,
          const Set &set,
          const std::vector<double> &weights,
          const double norm,
          Vector &t)
    {
      const std::size_t n = t.size();
      const double step   = norm > 0. ? 1.9 / norm : 0.;
      n_applications      = 0;
      for (std::size_t i = 0; i < n; ++i)
        t[i] = set.project(i, t[i]);
      recompute_gradient(apply, b, t);
      p = free_gradient(set, t);
      while (true)
        {
          // Split of the projected gradient: free part phi (and its reduced form), boundary part
          // beta.
          double residual = 0.;
          std::array<double, 3> sums{{0., 0., 0.}}; // beta . beta, reduced phi . phi, p . g
          for (std::size_t i = 0; i < n; ++i)
            {
              const Unknown projected = (t[i] - set.project(i, t[i] - step * g[i])) / step;
              residual                = std::max(residual, weights[i] * size(projected));
              if (set.is_interior(i, t[i]))
                sums[1] += projected * g[i];
              else
                sums[0] += projected * projected;
              sums[2] += p[i] * g[i];
            }
          residual = dealii::Utilities::MPI::max(residual, communicator);
          if (residual <= tolerance || n_applications >= limit)
            return {n_applications, residual, residual <= tolerance};
          sum_over_ranks(sums);

          if (sums[0] > sums[1] || !conjugate_step(apply, b, set, step, sums[2], t))
            project_step(apply, b, set, step, t);
        }
    }

  private:
    static double
    size(const double value)
    {
      return std::abs(value);
    }

    static double
    size(const dealii::Tensor<1, 3> &value)
    {
      return value.norm();
    }

    template <std::size_t n>
    void
    sum_over_ranks(std::array<double, n> &values) const
    {
      dealii::Utilities::MPI::sum(dealii::ArrayView<const double>(values.data(), n),
                                  communicator,
                                  dealii::ArrayView<double>(values.data(), n));
    }

    template <typename Operator>
    void
    recompute_gradient(const Operator &apply, const Vector &b, const Vector &t)
    {
      g.resize(t.size());
      apply(t, g);
      ++n_applications;
      for (std::size_t i = 0; i < t.size(); ++i)
        g[i] += b[i];
    }

    Vector
    free_gradient(const Set &set, const Vector &t) const
    {
      Vector phi(t.size());
      for (std::size_t i = 0; i < t.size(); ++i)
        if (set.is_interior(i, t[i]))
          phi[i] = g[i];
      return phi;
    }

    // Projected gradient step on all unknowns; restarts the conjugate directions.
    template <typename Operator>
    void
    project_step(const Operator &apply,
                 const Vector &b,
                 const Set &set,
                 const double step,
                 Vector &t)
    {
      for (std::size_t i = 0; i < t.size(); ++i)
        t[i] = set.project(i, t[i] - step * g[i]);
      recompute_gradient(apply, b, t);
      p = free_gradient(set, t);
    }

    // One conjugate gradient step, cut at the first bound it meets and followed by a projected step
    // then. Returns false if the direction has no curvature.
    template <typename Operator>
    bool
    conjugate_step(const Operator &apply,
                   const Vector &b,
                   const Set &set,
                   const double step,
                   const double p_g,
                   Vector &t)
    {
      const std::size_t n = t.size();
      Ap.resize(n);
      apply(p, Ap);
      ++n_applications;
      std::array<double, 1> p_Ap{{0.}};
      double longest = std::numeric_limits<double>::max();
      for (std::size_t i = 0; i < n; ++i)
        {
          p_Ap[0] += p[i] * Ap[i];
          if (p[i] != Unknown())
            longest = std::min(longest, set.longest_step(i, t[i], p[i]));
        }
      sum_over_ranks(p_Ap);
      longest = dealii::Utilities::MPI::min(longest, communicator);
      if (!(p_Ap[0] > 0.) || !(p_g > 0.))
        return false;

      const double alpha = std::min(p_g / p_Ap[0], longest);
      for (std::size_t i = 0; i < n; ++i)
        {
          t[i] -= alpha * p[i];
          g[i] -= alpha * Ap[i];
        }
      if (alpha < longest)
        {
          Vector phi = free_gradient(set, t);
          std::array<double, 1> phi_Ap{{0.}};
          for (std::size_t i = 0; i < n; ++i)
            phi_Ap[0] += phi[i] * Ap[i];
          sum_over_ranks(phi_Ap);
          for (std::size_t i = 0; i < n; ++i)
            p[i] = phi[i] - (phi_Ap[0] / p_Ap[0]) * p[i];
        }
      else
        {
          for (std::size_t i = 0; i < n; ++i)
            if (p[i] != Unknown())
              t[i] = set.project(i, t[i] - step * g[i]);
          recompute_gradient(apply, b, t);
          p = free_gradient(set, t);
        }
      return true;
    }

    const MPI_Comm communicator;
    const double tolerance;
    const unsigned int limit;
    unsigned int n_applications = 0;
    Vector g, p, Ap;
  };
} // namespace akmon
