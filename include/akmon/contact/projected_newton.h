#pragma once

#include <akmon/contact/friction_cylinders.h>

#include <deal.II/base/array_view.h>
#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace akmon
{
  /**
   * Solves the frictional contact problem of a step
   *
   *     w = A t + b,   0 <= t_n _|_ w_n >= 0,   |t_tau| <= r(t_n),   w_tau = -lambda t_tau,
   *     lambda >= 0,   lambda (r - |t_tau|) = 0
   *
   * for forces t, a vector per pair. For given friction limits r these are the conditions of the
   * minimum of (1/2) t . A t + b . t over cylinders (FrictionCylinders); the limits follow t_n in
   * an outer loop. A may be singular where constraints repeat each other: a compliance c makes
   * forces unique, (1/2) t . A t + (c/2) |t - t_0|^2 + b . t, first with t_0 = 0, then with the
   * first solution (Tikhonov's method, iterated once), which leaves an error of c^2.
   *
   * The minimum is found face by face of the cylinders (Dostal, Optimal Quadratic Programming
   * Algorithms, 2009): while the gradient in the face outweighs what leaving bounds would bring, a
   * Newton step with the curvature of the friction circles, its system solved by preconditioned
   * conjugate gradients, projected; where that fails, up to the first bound; where that fails, a
   * projected gradient step.
   *
   * Operator has apply(t, y): y = A t, and limits(t, r): the friction limits at t (both
   * collective). Preconditioner has reinit(free directions) and then apply(r, z): z close to (A +
   * curvatures + c)^{-1} r in the free directions.
   */
  template <typename Operator, typename Preconditioner>
  class ProjectedNewton
  {
  public:
    using Unknown = FrictionCylinders::Unknown;
    using Vector  = std::vector<Unknown>;

    struct Problem
    {
      Vector b;                    ///< w without forces
      std::vector<double> weights; ///< what a component of w counts in the residual
      double norm;                 ///< an upper bound of the norm of A
      bool friction;               ///< whether any limit may be above zero, the same on all ranks
      double compliance;           ///< c, relative to the diagonal of A: one
    };

    struct Result
    {
      unsigned int n_applications; ///< of A
      double residual;             ///< largest weighted component of the projected gradient
      bool converged;
    };

    ProjectedNewton(Operator &op,
                    Preconditioner &precondition,
                    const MPI_Comm communicator,
                    const double tolerance,
                    const unsigned int limit)
      : op(op)
      , precondition(precondition)
      , communicator(communicator)
      , tolerance(tolerance)
      , limit(limit)
    {
    }

    /// @param t  start on entry, solution on return
    Result
    solve(const Problem &new_problem, Vector &t)
    {
      problem        = &new_problem;
      n_applications = 0;
      if (!(problem->norm > 0.)) // nothing can move
        return {0, 0., true};
      step = 1.9 / (problem->norm + problem->compliance);
      start(t);
      compute_gradient(t);
      double residual = solve_for_reference(t);
      refer_to(t);
      residual = solve_for_reference(t);
      return {n_applications, residual, residual <= tolerance};
    }

  private:
    using Tangential = FreeDirections::Tangential;

    // Results that every rank needs.
    double
    largest_of_ranks(const double value) const
    {
      return dealii::Utilities::MPI::max(value, communicator);
    }

    double
    product(const Vector &a, const Vector &b) const
    {
      double sum = 0.;
      for (std::size_t i = 0; i < a.size(); ++i)
        sum += a[i] * b[i];
      return dealii::Utilities::MPI::sum(sum, communicator);
    }

    double
    weighted_size(const Vector &w) const
    {
      double largest = 0.;
      for (std::size_t i = 0; i < w.size(); ++i)
        largest = std::max(largest, problem->weights[i] * w[i].norm());
      return largest_of_ranks(largest);
    }

    void
    compute_gradient(const Vector &t)
    {
      g.resize(t.size());
      op.apply(t, g);
      ++n_applications;
      for (std::size_t i = 0; i < t.size(); ++i)
        g[i] += problem->b[i] + problem->compliance * (t[i] - reference[i]);
    }

    // Largest weighted component of the projected gradient (t - P(t - a g))/a.
    double
    measure(const Vector &t) const
    {
      double residual = 0.;
      for (std::size_t i = 0; i < t.size(); ++i)
        {
          const Unknown reached = set.project(i, t[i] - step * g[i]);
          residual = std::max(residual, problem->weights[i] * (t[i] - reached).norm() / step);
        }
      return largest_of_ranks(residual);
    }

    // Take a start into the set; what is at a bound is kept there at first.
    void
    start(Vector &t)
    {
      set.radius.resize(t.size());
      faces.resize(t.size());
      for (std::size_t i = 0; i < t.size(); ++i)
        t[i][0] = std::max(0., t[i][0]);
      op.limits(t, set.radius);
      for (std::size_t i = 0; i < t.size(); ++i)
        {
          t[i]     = set.project(i, t[i]);
          faces[i] = set.face_at(i, t[i]);
        }
      reference.assign(t.size(), Unknown());
    }

    // The friction limits become those of the present t. What slips goes on doing so.
    void
    follow_limits(Vector &t)
    {
      if (!problem->friction)
        return;
      op.limits(t, set.radius);
      bool moved = false;
      for (std::size_t i = 0; i < t.size(); ++i)
        {
          const Unknown t_tau    = set.tangential(t[i]);
          const double size      = t_tau.norm();
          Tangential &tangential = faces[i].tangential;
          if (!(set.radius[i] > 0.))
            tangential = Tangential::none;
          else if (size >= set.radius[i])
            tangential = Tangential::circle;
          else if (tangential == Tangential::none || size == 0.)
            tangential = Tangential::disc;
          if (tangential != Tangential::disc && size > 0. && size != set.radius[i])
            {
              t[i] += (set.radius[i] / size - 1.) * t_tau;
              moved = true;
            }
        }
      if (dealii::Utilities::MPI::max(int(moved), communicator) > 0)
        compute_gradient(t);
    }

    void
    refer_to(const Vector &t)
    {
      for (std::size_t i = 0; i < t.size(); ++i)
        {
          g[i] -= problem->compliance * (t[i] - reference[i]);
          reference[i] = t[i];
        }
    }

    // Solve the problem with its present reference; returns the residual.
    double
    solve_for_reference(Vector &t)
    {
      // For given limits the problem is convex and whatever is reached is harmless; limits that
      // never settle could grow without end.
      constexpr unsigned int most_limits = 50;

      double residual = measure(t);
      for (unsigned int k = 0; k < most_limits && residual > tolerance && n_applications < limit;
           ++k)
        {
          while (residual > 0.5 * tolerance && n_applications < limit)
            {
              choose_directions(t);
              find_direction(t.size());
              residual = newton_step(residual, t);
            }
          follow_limits(t);
          residual = measure(t);
        }
      return residual;
    }

    // Leave the bounds that the negative gradient leads away from once that outweighs the gradient
    // in the face.
    void
    choose_directions(const Vector &t)
    {
      const std::size_t n = t.size();
      released.resize(n);
      r.resize(n);
      q.resize(n);
      for (std::size_t i = 0; i < n; ++i)
        {
          released[i] = set.released(t[i], g[i], faces[i]);
          r[i]        = set.restrict_to(faces[i], g[i]);
          q[i]        = set.restrict_to(released[i], g[i]);
        }
      if (weighted_size(r) <= std::max(0.5 * tolerance, 0.5 * weighted_size(q)))
        faces.swap(released);
      for (std::size_t i = 0; i < n; ++i)
        set.update_circle(i, t[i], g[i], faces[i]);
    }

    // The Newton direction (Z A Z + D + c)^{-1} Z g by conjugate gradients, and what A makes of it.
    void
    find_direction(const std::size_t n)
    {
      z.resize(n);
      p.assign(n, Unknown());
      direction.assign(n, Unknown());
      A_direction.assign(n, Unknown());
      for (std::size_t i = 0; i < n; ++i)
        r[i] = set.restrict_to(faces[i], g[i]);
      precondition.reinit(faces);
      double r_z_old = 0.;
      do
        {
          precondition.apply(r, z);
          for (std::size_t i = 0; i < n; ++i)
            z[i] = set.restrict_to(faces[i], z[i]);
          const double r_z = product(r, z);
          if (!(r_z > 0.))
            return;
          const double beta = r_z_old > 0. ? r_z / r_z_old : 0.;
          for (std::size_t i = 0; i < n; ++i)
            p[i] = z[i] + beta * p[i];
          r_z_old = r_z;
          conjugate_step(r_z);
        }
      while (weighted_size(r) > 0.15 * tolerance && n_applications < limit);
    }

    void
    conjugate_step(const double r_z)
    {
      const std::size_t n = p.size();
      op.apply(p, q);
      ++n_applications;
      for (std::size_t i = 0; i < n; ++i)
        {
          q[i] += problem->compliance * p[i];
          z[i] = set.restrict_to(faces[i], q[i]);
          if (faces[i].curvature > 0.)
            z[i] += (faces[i].curvature * (p[i] * faces[i].along)) * faces[i].along;
        }
      const double alpha = r_z / product(p, z);
      for (std::size_t i = 0; i < n; ++i)
        {
          direction[i] += alpha * p[i];
          A_direction[i] += alpha * q[i];
          r[i] -= alpha * z[i];
        }
    }

    // Along the direction by one, or to the first bound, as long as that is an improvement, else
    // along the gradient. Returns the residual after it.
    double
    newton_step(const double residual_before, Vector &t)
    {
      constexpr unsigned int most_trials = 4;
      constexpr double least_step        = 1e-3;

      t_old        = t;
      g_old        = g;
      double alpha = 1.;
      for (unsigned int trial = 0; trial < most_trials && alpha > 0.; ++trial)
        {
          move(alpha, t);
          const double residual = measure(t);
          // A step that ends at once at a bound changes nothing but the face.
          const bool only_binds = trial == 1 && alpha < least_step;
          if (residual <= 0.5 * residual_before || is_lower(t) || only_binds ||
              n_applications >= limit)
            {
              bind(t);
              return residual;
            }
          alpha = trial == 0 ? longest_step() : 0.25 * alpha;
        }
      for (std::size_t i = 0; i < t.size(); ++i)
        {
          t[i]     = set.project(i, t_old[i] - step * g_old[i]);
          faces[i] = set.face_at(i, t[i]);
        }
      compute_gradient(t);
      return measure(t);
    }

    // t = P(t_old - alpha direction) and its gradient, which is known as long as P does nothing.
    void
    move(const double alpha, Vector &t)
    {
      bool inside = true;
      for (std::size_t i = 0; i < t.size(); ++i)
        {
          const Unknown moved = t_old[i] - alpha * direction[i];
          t[i]                = set.project(i, moved);
          inside = inside && (t[i] - moved).norm_square() <= 1e-30 * moved.norm_square();
        }
      if (dealii::Utilities::MPI::min(int(inside), communicator) == 0)
        compute_gradient(t);
      else
        for (std::size_t i = 0; i < t.size(); ++i)
          g[i] = g_old[i] - alpha * A_direction[i];
    }

    // Whether the quadratic function is lower at t than at t_old, by the trapezoidal rule, which is
    // exact.
    bool
    is_lower(const Vector &t) const
    {
      double sum = 0.;
      for (std::size_t i = 0; i < t.size(); ++i)
        sum += (t[i] - t_old[i]) * (g[i] + g_old[i]);
      return dealii::Utilities::MPI::sum(sum, communicator) < 0.;
    }

    // What has reached a bound is kept there.
    void
    bind(Vector &t)
    {
      constexpr double rounding = 1e-12; // what a step to the bound leaves of a force
      for (std::size_t i = 0; i < t.size(); ++i)
        {
          if (t[i][0] <= rounding * t_old[i][0])
            {
              t[i][0]         = 0.;
              faces[i].normal = false;
            }
          if (faces[i].tangential == Tangential::disc && !set.is_inside_circle(i, t[i]))
            faces[i].tangential = Tangential::circle;
        }
    }

    double
    longest_step() const
    {
      double alpha = 1.;
      for (std::size_t i = 0; i < t_old.size(); ++i)
        alpha = std::min(alpha, set.longest_step(i, faces[i], t_old[i], direction[i]));
      return dealii::Utilities::MPI::min(alpha, communicator);
    }

    Operator &op;
    Preconditioner &precondition;
    const MPI_Comm communicator;
    const double tolerance;
    const unsigned int limit;
    const Problem *problem      = nullptr;
    unsigned int n_applications = 0;
    double step                 = 0.;
    FrictionCylinders set;
    std::vector<FreeDirections> faces, released;
    Vector g, reference, t_old, g_old, direction, A_direction;
    Vector r, z, p, q; ///< of conjugate gradients
  };
} // namespace akmon
