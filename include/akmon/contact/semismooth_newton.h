#pragma once

#include <akmon/contact/coulomb_faces.h>
#include <akmon/contact/gmres.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace akmon
{
  /**
   * Solves the frictional contact problem of a step
   *
   *     w = A t + b,   0 <= t_n _|_ w_n >= 0,   |t_tau| <= mu t_n,   w_tau = -lambda t_tau,
   *     lambda >= 0,   lambda (mu t_n - |t_tau|) = 0
   *
   * for forces t, a vector per pair, by a semi-smooth Newton method: the predictor t - rho w tells
   * for all pairs at once which are open, stick or slip (CoulombFace); on these faces the problem
   * is a linear system, not symmetric where pairs slip, since t_tau follows t_n; its solution gives
   * the next predictor (Alart and Curnier 1991; without friction the primal-dual active set method
   * of Hueber and Wohlmuth, Comput. Methods Appl. Mech. Eng. 194, 2005). The systems are solved by
   * preconditioned GMRES. Where faces go round in a circle, other values of rho are tried.
   *
   * A may be singular where constraints repeat each other: a compliance c makes forces unique, w =
   * A t + c (t - t_0) + b, first with t_0 = 0, then with the first solution (Tikhonov's method,
   * iterated once), which leaves an error of c^2; from the start with t_0 = t where that solves
   * almost the same problem. Where it is so small that the faces never settle,
   * a larger one is taken with more iterations (the proximal point method).
   *
   * Operator has apply(t, y): y = A t. Preconditioner has reinit(faces, c) and then apply(r, z): z
   * close to (A + curvatures + c)^{-1} r in the free directions.
   */
  template <typename Operator, typename Preconditioner>
  class SemismoothNewton
  {
  public:
    using Vector = std::vector<CoulombFace::Force>;

    struct Problem
    {
      Vector b;                     ///< w without forces
      std::vector<double> friction; ///< mu of the pairs
      std::vector<double> weights;  ///< what a component of w counts in the residual
      double norm;                  ///< an upper bound of the norm of A
      double compliance;            ///< c to begin with, relative to the diagonal of A: one
      double tolerance;             ///< of the residual
      double sufficient;            ///< the same where it takes too long
      unsigned int limit;           ///< of applications of A
      bool start_is_reference;      ///< t_0 is the start, which solves almost the same problem
    };

    struct Result
    {
      unsigned int n_applications; ///< of A
      double residual;             ///< largest weighted component of the projected gradient
      bool converged;              ///< else w_n is right for friction limits that are not
    };

    /**
     * @param t      start on entry, solution on return
     * @param faces  of the solution on return; on entry, if the start is the reference, of that
     */
    Result
    solve(const Problem &new_problem,
          Operator &new_op,
          Preconditioner &new_precondition,
          Vector &t,
          std::vector<CoulombFace> &faces_of_t)
    {
      problem      = &new_problem;
      op           = &new_op;
      precondition = &new_precondition;
      std::swap(faces, faces_of_t);
      const Result result = run(t);
      std::swap(faces, faces_of_t);
      return result;
    }

  private:
    Result
    run(Vector &t)
    {
      n_applications    = 0;
      most_applications = problem->limit;
      n_relaxations     = 25;
      if (!(problem->norm > 0.)) // nothing can move
        return {0, 0., true};
      constexpr double stiffer = 1e3; // where faces do not settle

      const std::size_t n = t.size();
      if (!problem->start_is_reference)
        faces.clear();
      faces.resize(n);
      for (Vector *const v : {&g, &r, &direction, &image})
        v->resize(n);
      if (problem->start_is_reference)
        reference = t;
      else
        reference.assign(n, CoulombFace::Force());
      double residual = solve_with(problem->compliance, 4, false, t);
      if (residual > problem->sufficient && n_applications < most_applications)
        {
          reference = t;
          residual  = solve_with(stiffer * problem->compliance, 20, true, t);
        }
      const bool converged = residual <= problem->sufficient;
      if (!converged)
        close_gaps(t);
      for (std::size_t i = 0; i < n; ++i) // what the tolerance left
        t[i] = CoulombFace::project(t[i], limit_of(i, t[i]));
      limits_are_given = false;
      return {n_applications, residual, converged};
    }

    // Where no solution is found friction is what is wrong, not gaps: limits are given by the last
    // normal forces, which leaves a convex problem, and stay so.
    void
    close_gaps(Vector &t)
    {
      most_applications += problem->limit;
      give_limits(t);
      limits_stay = true;
      reference   = t;
      solve_with(problem->compliance, 20, true, t);
      limits_stay = false;
    }

    void
    give_limits(const Vector &t)
    {
      limits_are_given = false;
      limits.resize(t.size());
      for (std::size_t i = 0; i < t.size(); ++i)
        limits[i] = limit_of(i, t[i]);
      limits_are_given = true;
    }

    // Solve with a compliance and as many references as it takes; returns the residual. While the
    // reference is still to change, a part of the error it makes is good enough.
    double
    solve_with(const double new_compliance,
               const unsigned int most_references,
               const bool thoroughly,
               Vector &t)
    {
      constexpr double part = 0.1;

      compliance = new_compliance;
      step       = 1.9 / (problem->norm + compliance);
      compute_gradient(t);
      double residual = 0., last_error = std::numeric_limits<double>::max();
      for (unsigned int k = 0; k <= most_references; ++k)
        {
          const double enough = std::max(0.5 * problem->tolerance, part * error_of_compliance(t));
          residual            = solve_for_reference(enough, thoroughly, t);
          const double error  = error_of_compliance(t);
          if (residual > enough || error <= problem->tolerance)
            break;
          if (error <= problem->sufficient && error > 0.5 * last_error)
            return std::max(residual, error); // the rest would take long
          last_error = error;
          refer_to(t);
        }
      return residual;
    }

    double
    limit_of(const std::size_t i, const CoulombFace::Force &t) const
    {
      return limits_are_given ? limits[i] : problem->friction[i] * std::max(t[0], 0.);
    }

    void
    compute_gradient(const Vector &t)
    {
      op->apply(t, g);
      ++n_applications;
      drift = 0.;
      for (std::size_t i = 0; i < t.size(); ++i)
        g[i] += problem->b[i] + compliance * (t[i] - reference[i]);
    }

    // Largest weighted component of (t - P(t - a g))/a.
    double
    measure(const Vector &t) const
    {
      double residual = 0.;
      for (std::size_t i = 0; i < t.size(); ++i)
        {
          const auto reached = CoulombFace::project(t[i] - step * g[i], limit_of(i, t[i]));
          residual = std::max(residual, problem->weights[i] * (t[i] - reached).norm() / step);
        }
      return residual;
    }

    // Largest weighted component of c (t - t_0).
    double
    error_of_compliance(const Vector &t) const
    {
      double error = 0.;
      for (std::size_t i = 0; i < t.size(); ++i)
        error = std::max(error, compliance * problem->weights[i] * (t[i] - reference[i]).norm());
      return error;
    }

    void
    refer_to(const Vector &t)
    {
      for (std::size_t i = 0; i < t.size(); ++i)
        {
          g[i] -= compliance * (t[i] - reference[i]);
          reference[i] = t[i];
        }
    }

    // Solve the problem with its present reference; returns the residual. For given friction limits
    // it is convex and always solved: where the faces of the true problem do not settle, limits
    // follow normal forces in a loop around it, until its faces do for the true problem.
    double
    solve_for_reference(const double enough, const bool thoroughly, Vector &t)
    {
      constexpr double part = 0.05; // of the residual, while limits still change
      // Steps without improvement that tell of a circle.
      constexpr unsigned int patience_of_limits = 8, patience_between = 3;
      const unsigned int patience    = thoroughly ? 8 : 4;
      const unsigned int most_limits = thoroughly ? 50 : 6;

      if (limits_stay)
        return find_faces(t, enough, patience_of_limits, thoroughly);
      limits_are_given = false;
      double residual  = find_faces(t, enough, patience, thoroughly);
      for (unsigned int k = 0;
           k < most_limits && residual > enough && n_applications < most_applications;
           ++k)
        {
          give_limits(t);
          residual                    = measure(t);
          const double while_changing = std::max(enough, part * residual);
          if (find_faces(t, while_changing, patience_of_limits, thoroughly) > while_changing &&
              !thoroughly)
            break;
          limits_are_given = false;
          t_of_limits      = t;
          residual         = find_faces(t, enough, patience_between, false);
          if (residual > enough)
            {
              t = t_of_limits;
              compute_gradient(t);
            }
        }
      limits_are_given = false;
      return residual;
    }

    // Newton steps until the residual is small enough or has not improved for some of them; returns
    // it.
    double
    find_faces(Vector &t, const double enough, const unsigned int patience, const bool thoroughly)
    {
      struct Attempt
      {
        double rho;       // of the predictor
        double reduction; // of the residual of linear systems
      };
      constexpr std::array<Attempt, 5> attempts = {
        {{1., 1e-5}, {1., 1e-9}, {0.1, 1e-9}, {2., 1e-9}, {0.5, 1e-9}}};

      constexpr double while_changing = 0.1; // reduction before faces settle

      double best = std::numeric_limits<double>::max();
      t_best      = t;
      for (const auto &attempt : attempts)
        {
          for (unsigned int since_best = 0; since_best < patience; ++since_best)
            {
              choose_faces(t, attempt.rho);
              const double residual = measure(t);
              if (residual <= enough)
                return residual;
              if (residual < 0.9 * best)
                {
                  best       = residual;
                  t_best     = t;
                  since_best = 0;
                }
              if (n_applications >= most_applications)
                break;
              newton_step(t, faces_changed && !thoroughly ? while_changing : attempt.reduction);
            }
          t = t_best;
          compute_gradient(t);
          if (!thoroughly || n_applications >= most_applications)
            break;
          if (&attempt != attempts.data()) // exact systems may be all that was missing
            relax(t);
        }
      return best;
    }

    // Projected gradient steps: slow, but for given limits they lead to the solution from anywhere.
    // More of them each time they are needed in a solution.
    void
    relax(Vector &t)
    {
      constexpr unsigned int most = 400;

      for (unsigned int k = 0; k < n_relaxations && n_applications < most_applications; ++k)
        {
          for (std::size_t i = 0; i < t.size(); ++i)
            t[i] = CoulombFace::project(t[i] - step * g[i], limit_of(i, t[i]));
          compute_gradient(t);
        }
      n_relaxations = std::min(2 * n_relaxations, most);
    }

    // The faces that the predictor tells, and the forces taken there.
    void
    choose_faces(Vector &t, const double rho)
    {
      constexpr double rounding = 1e-14;

      double lost  = drift; // by updating the gradient instead of computing it
      bool changed = false;
      for (std::size_t i = 0; i < t.size(); ++i)
        {
          const auto before = t[i], q = before - rho * g[i];
          const auto old = faces[i];
          faces[i]       = CoulombFace::predicted_by(q,
                                               limit_of(i, q),
                                               limits_are_given ? 0. : problem->friction[i],
                                               rho);
          changed        = changed || !alike(old, faces[i]);
          t[i]           = faces[i].settle(before, limit_of(i, before));
          if ((t[i] - before).norm() > rounding * before.norm())
            lost = std::numeric_limits<double>::max();
        }
      if (lost > 0.05 * problem->tolerance)
        compute_gradient(t);
      faces_changed = changed;
    }

    // t + p with g + (A + c) p = 0 in the free components, where turning along a circle counts with
    // its curvature.
    void
    newton_step(Vector &t, const double reduction)
    {
      constexpr unsigned int dimension = 80;

      double weighted = 0.;
      for (std::size_t i = 0; i < t.size(); ++i)
        {
          r[i]     = -faces[i].restrict_to(g[i]);
          weighted = std::max(weighted, problem->weights[i] * r[i].norm());
        }
      const double norm = std::sqrt(Gmres::product(r, r));
      const double goal = weighted > 0. ? 0.15 * problem->tolerance / weighted : 1.;
      precondition->reinit(faces, compliance);
      gmres.solve([&](Vector &p, Vector &of_p, Vector &y) { apply_on_faces(p, of_p, y); },
                  [&](const Vector &v, Vector &z) {
                    precondition->apply(v, z);
                    for (std::size_t i = 0; i < v.size(); ++i)
                      z[i] = faces[i].restrict_to(z[i]);
                  },
                  r,
                  std::max(reduction, goal) * norm,
                  std::min(dimension,
                           most_applications - std::min(n_applications, most_applications)));
      gmres.combine(direction, image);
      for (std::size_t i = 0; i < t.size(); ++i)
        {
          t[i] += direction[i];
          g[i] += image[i];
          drift = std::max(drift,
                           std::numeric_limits<double>::epsilon() * problem->weights[i] *
                             image[i].norm());
        }
    }

    // Takes p from its free components to changes of forces.
    void
    apply_on_faces(Vector &p, Vector &of_p, Vector &y)
    {
      for (std::size_t i = 0; i < p.size(); ++i)
        {
          y[i] = (faces[i].curvature * (p[i] * faces[i].along)) * faces[i].along;
          p[i] = faces[i].lift(p[i]);
        }
      op->apply(p, of_p);
      ++n_applications;
      for (std::size_t i = 0; i < p.size(); ++i)
        {
          of_p[i] += compliance * p[i];
          y[i] += faces[i].restrict_to(of_p[i]);
        }
    }

    Gmres gmres;
    Operator *op                   = nullptr;
    Preconditioner *precondition   = nullptr;
    const Problem *problem         = nullptr;
    unsigned int most_applications = 0;
    unsigned int n_applications    = 0;
    unsigned int n_relaxations     = 0;  ///< in the next relaxation
    double compliance              = 0.; ///< c
    double step                    = 0.;
    bool faces_changed             = true; ///< by the last choice of them
    double drift                   = 0.;   ///< rounding of g since it was computed
    bool limits_are_given = false, limits_stay = false;
    std::vector<double> limits; ///< of friction, if given
    std::vector<CoulombFace> faces;
    Vector g; ///< A t + b + c (t - t_0)
    Vector reference, t_best, t_of_limits, r, direction, image;
  };
} // namespace akmon
