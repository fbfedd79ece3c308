#pragma once

#include <akmon/contact/coupled/coulomb_faces.h>
#include <akmon/contact/coupled/frictional_problem.h>
#include <akmon/contact/coupled/newton_step.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace akmon
{
  /**
   * Solves a FrictionalProblem by a semi-smooth Newton method: the predictor t - rho w tells for
   * all pairs at once which are open, stick or slip (CoulombFace); on these faces the problem is a
   * linear system, not symmetric where pairs slip, since t_tau follows t_n; its solution gives the
   * next predictor (Alart and Curnier 1991; without friction the primal-dual active set method of
   * Hueber and Wohlmuth, Comput. Methods Appl. Mech. Eng. 194, 2005). The systems are solved by
   * preconditioned GMRES. Where faces go round in a circle, friction limits are given and follow
   * t_n in a loop, and other values of rho are tried.
   *
   * Large problems start with projected gradient steps.
   *
   * A may be singular where constraints repeat each other: a compliance c makes forces unique
   * (CompliantProblem), first with t_0 = 0, then with the first solution (Tikhonov's method,
   * iterated once), which leaves an error of c^2; from the start with t_0 = t where that solves
   * almost the same problem. Where it is so small that the faces never settle, a larger one is
   * taken with more iterations (the proximal point method).
   *
   * Where no solution is found friction is what is wrong, not gaps (close_gaps).
   *
   * Operator has apply(t, y): y = A t. Preconditioner has reinit(faces, c) and then apply(r, z): z
   * close to (A + curvatures + c)^{-1} r in the free directions, or is_exact(); is_made_for(faces,
   * c) tells whether reinit() would do nothing.
   */
  template <typename Operator, typename Preconditioner>
  class SemismoothNewton
  {
  public:
    using Vector  = FrictionalProblem::Vector;
    using Problem = FrictionalProblem;

    struct Result
    {
      unsigned int n_applications; ///< of A
      double residual;             ///< largest weighted component of the projected gradient
      bool converged;              ///< else w_n is right for friction that is not
    };

    /**
     * @param t      start on entry, solution on return
     * @param faces  of the solution on return; on entry, if the start is the reference, of that
     */
    Result
    solve(const Problem &new_data,
          Operator &op,
          Preconditioner &new_precondition,
          Vector &t,
          std::vector<CoulombFace> &faces_of_t)
    {
      begin(new_data, op, new_precondition);
      std::swap(faces, faces_of_t);
      const Result result = run(t);
      std::swap(faces, faces_of_t);
      return result;
    }

    /**
     * The same from no forces, with compliances from that of the pairs themselves down to hardly
     * any: where constraints repeat each other nearly and rub in different directions, faces settle
     * for each of them from those of the one before.
     */
    Result
    follow_compliance(const Problem &new_data,
                      Operator &op,
                      Preconditioner &new_precondition,
                      Vector &t,
                      std::vector<CoulombFace> &faces_of_t)
    {
      constexpr double most = 1., least = 1e-9, fastest = 0.1, slowest = 0.98;
      constexpr unsigned int patience = 8;

      begin(new_data, op, new_precondition);
      most_applications = data->limit;
      t.assign(t.size(), {});
      faces.assign(t.size(), {});
      double residual = std::numeric_limits<double>::max(), c = most, part = fastest;
      while (c > least && part < slowest && residual > data->sufficient && is_allowed())
        {
          t_of_limits = t;
          problem.set_compliance(c);
          problem.clear_reference();
          problem.evaluate(t);
          const double enough = 0.5 * data->tolerance;
          if (find_faces(t, enough, patience, Effort::usual) > enough && c < most)
            {
              t = t_of_limits;
              c /= part;
              part = std::sqrt(part);
            }
          else
            {
              problem.refer_to(t);
              residual = problem.measure(t); // without compliance
              part     = std::max(fastest, part * std::sqrt(part));
            }
          c *= part;
        }
      keep_limits(t);
      std::swap(faces, faces_of_t);
      return {problem.applications(), residual, residual <= data->sufficient};
    }

  private:
    void
    begin(const Problem &new_data, Operator &op, Preconditioner &new_precondition)
    {
      data         = &new_data;
      precondition = &new_precondition;
      problem.begin(*data, op);
      step.begin(*data, problem, new_precondition);
    }

    // What the tolerance left beyond them.
    void
    keep_limits(Vector &t) const
    {
      for (std::size_t i = 0; i < t.size(); ++i)
        t[i] = CoulombFace::project(t[i], problem.limit_of(i, t[i]));
    }

    Result
    run(Vector &t)
    {
      constexpr double stiffer = 1e3; // where faces do not settle

      most_applications = data->limit;
      n_relaxations     = 25;
      if (!(data->norm > 0.)) // nothing can move
        return {0, 0., true};
      const std::size_t n = t.size();
      if (!data->start_is_reference)
        faces.clear();
      faces.resize(n);
      data->start_is_reference ? problem.set_reference(t) : problem.clear_reference();
      if (!data->start_is_reference)
        approach(t);
      double residual = solve_with(data->compliance, 4, Effort::usual, t);
      if (residual > data->sufficient && is_allowed())
        {
          problem.set_reference(t);
          residual = solve_with(stiffer * data->compliance, 20, Effort::thorough, t);
        }
      const bool converged = residual <= data->sufficient;
      if (!converged && data->rubs())
        residual = close_gaps(t);
      keep_limits(t);
      return {problem.applications(), residual, converged};
    }

    // Most faces that change settle in a few projected gradient steps. Factors of large matrices
    // cost more, unless there are some that fit.
    void
    approach(Vector &t)
    {
      constexpr std::size_t many     = 60; // pairs
      constexpr unsigned int n_steps = 20;

      if (t.size() <= many)
        return;
      problem.set_compliance(data->compliance);
      problem.evaluate(t);
      choose_faces(t, 1.);
      if (!precondition->is_made_for(faces, data->compliance))
        for (unsigned int k = 0; k < n_steps && is_allowed(); ++k)
          problem.descend(t);
    }

    unsigned int
    applications_left() const
    {
      return most_applications - std::min(problem.applications(), most_applications);
    }

    bool
    is_allowed() const
    {
      return applications_left() > 0;
    }

    enum class Effort
    {
      usual,
      thorough,
      given_limits ///< thorough, for limits that stay
    };

    // Limits are given by the last normal forces, which leaves a convex problem, and lowered until
    // no force is beyond the cone, so that some pairs slip with less friction than Coulomb's.
    double
    close_gaps(Vector &t)
    {
      constexpr unsigned int most_rounds = 50, enough_applications = 1000;

      most_applications = problem.applications() + enough_applications;
      problem.give_limits(t);
      for (unsigned int round = 0; round < most_rounds; ++round)
        {
          problem.set_reference(t);
          solve_with(data->compliance, 50, Effort::given_limits, t);
          if (!problem.lower_limits(t))
            break;
        }
      problem.free_limits();
      return problem.measure(t);
    }

    // Solve with a compliance and as many references as it takes; returns the residual. While the
    // reference is still to change, a part of the error it makes is good enough.
    double
    solve_with(const double compliance,
               const unsigned int most_references,
               const Effort effort,
               Vector &t)
    {
      constexpr double part = 0.1;

      problem.set_compliance(compliance);
      problem.evaluate(t);
      double last_error = std::numeric_limits<double>::max();
      for (unsigned int k = 0; k <= most_references; ++k)
        {
          const double enough   = std::max(0.5 * data->tolerance,
                                         part * problem.error_of_compliance(t));
          const double residual = effort == Effort::given_limits ?
                                    solve_for_limits(enough, t) :
                                    solve_for_reference(enough, effort, t);
          const double error    = problem.error_of_compliance(t);
          if (residual > std::max(enough, data->sufficient) || error <= data->tolerance ||
              (error <= data->sufficient && error > 0.5 * last_error)) // the rest would take long
            return std::max(residual, error);
          last_error = error;
          problem.refer_to(t);
        }
      return problem.measure(t); // which is without compliance now
    }

    // Solve the problem with its present reference; returns the residual. For given friction limits
    // it is convex and always solved: where the faces of the true problem do not settle, limits
    // follow normal forces in a loop around it, until its faces do for the true problem.
    double
    solve_for_reference(const double enough, const Effort effort, Vector &t)
    {
      constexpr double part = 0.05; // of the residual, while limits still change
      // Steps without improvement that tell of a circle.
      constexpr unsigned int patience = 8, patience_between = 3;
      const bool thorough            = effort != Effort::usual;
      const unsigned int most_limits = thorough ? 50 : 6;

      problem.free_limits();
      double residual = find_faces(t, enough, patience, effort);
      for (unsigned int k = 0; k < most_limits && residual > enough && is_allowed(); ++k)
        {
          problem.give_limits(t);
          residual                    = problem.measure(t);
          const double while_changing = std::max(enough, part * residual);
          if (thorough)
            descend(t, while_changing);
          else if (find_faces(t, while_changing, patience, effort) > while_changing)
            break;
          problem.free_limits();
          t_of_limits = t;
          residual    = find_faces(t, enough, patience_between, Effort::usual);
          if (residual > enough)
            {
              t = t_of_limits;
              problem.evaluate(t);
            }
        }
      problem.free_limits();
      return problem.measure(t); // where limits have led
    }

    double
    solve_for_limits(const double enough, Vector &t)
    {
      constexpr unsigned int patience = 8;

      const double residual = descend(t, enough);
      return residual > enough ? find_faces(t, enough, patience, Effort::given_limits) : residual;
    }

    // Newton steps until the residual is small enough or has not improved for some of them; returns
    // it.
    double
    find_faces(Vector &t, const double enough, const unsigned int patience, const Effort effort)
    {
      struct Attempt
      {
        double rho;       // of the predictor
        double reduction; // of the residual of linear systems
      };
      constexpr std::array<Attempt, 5> attempts = {
        {{1., 1e-5}, {1., 1e-9}, {0.1, 1e-9}, {2., 1e-9}, {0.5, 1e-9}}};

      constexpr double while_changing = 0.1; // reduction before faces settle
      const bool thorough             = effort != Effort::usual;

      double best = std::numeric_limits<double>::max();
      t_best      = t;
      for (const auto &attempt : attempts)
        {
          for (unsigned int since_best = 0; since_best < patience; ++since_best)
            {
              const bool changed    = choose_faces(t, attempt.rho);
              const double residual = problem.measure(t);
              if (residual <= enough)
                return residual;
              if (residual < 0.9 * best)
                {
                  best       = residual;
                  t_best     = t;
                  since_best = 0;
                }
              if (!is_allowed())
                break;
              step.take(faces,
                        changed && !thorough ? while_changing : attempt.reduction,
                        applications_left(),
                        t);
            }
          t = t_best;
          problem.evaluate(t);
          if (!thorough || !is_allowed())
            break;
          if (&attempt != attempts.data()) // exact systems may be all that was missing
            relax(t);
        }
      return best;
    }

    // For given limits: Newton steps are shortened until phi falls, or else replaced by projected
    // gradient steps, which lead to the solution from anywhere. Returns the residual.
    double
    descend(Vector &t, const double enough)
    {
      constexpr unsigned int most_steps = 30, most_parts = 8;
      constexpr double reduction = 1e-9; // of the residual of linear systems

      double residual = problem.measure(t);
      for (unsigned int n = 0; n < most_steps && residual > enough && is_allowed(); ++n)
        {
          const Vector before = t;
          const double phi    = problem.potential(t);
          choose_faces(t, 1.);
          step.take(faces, reduction, applications_left(), t);
          const Vector reached = t;
          bool falls           = false;
          double part          = 1.;
          for (unsigned int k = 0; k < most_parts && !falls; ++k, part *= 0.25)
            {
              problem.move(before, part, reached, t);
              falls = problem.potential(t) < phi || problem.measure(t) < 0.5 * residual;
            }
          if (!falls)
            {
              t = before;
              problem.evaluate(t);
              problem.descend(t);
            }
          residual = problem.measure(t);
        }
      return residual;
    }

    // Projected gradient steps: slow, but for given limits they lead to the solution from anywhere.
    // More of them each time they are needed in a solution.
    void
    relax(Vector &t)
    {
      constexpr unsigned int most = 400;

      for (unsigned int k = 0; k < n_relaxations && is_allowed(); ++k)
        problem.descend(t);
      n_relaxations = std::min(2 * n_relaxations, most);
    }

    // The faces that the predictor tells, and the forces taken there; whether the faces are new.
    bool
    choose_faces(Vector &t, const double rho)
    {
      constexpr double rounding = 1e-14;

      bool moved = false, changed = false;
      for (std::size_t i = 0; i < t.size(); ++i)
        {
          const auto before = t[i], q = before - rho * problem.motion()[i];
          const auto old = faces[i];
          faces[i]       = CoulombFace::predicted_by(q,
                                               problem.limit_of(i, q),
                                               problem.coefficient(i),
                                               rho);
          changed        = changed || !alike(old, faces[i]);
          t[i]           = faces[i].settle(before, problem.limit_of(i, before));
          moved          = moved || (t[i] - before).norm() > rounding * before.norm();
        }
      // By updating w instead of computing it some of it is lost.
      if (moved || problem.get_drift() > 0.05 * data->tolerance)
        problem.evaluate(t);
      return changed;
    }

    const Problem *data          = nullptr;
    Preconditioner *precondition = nullptr;
    CompliantProblem<Operator> problem;
    NewtonStep<Operator, Preconditioner> step;
    unsigned int most_applications = 0;
    unsigned int n_relaxations     = 0; ///< in the next relaxation
    std::vector<CoulombFace> faces;
    Vector t_best, t_of_limits;
  };
} // namespace akmon
