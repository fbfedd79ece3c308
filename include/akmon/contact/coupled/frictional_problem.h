#pragma once

#include <akmon/contact/coupled/coulomb_faces.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace akmon
{
  /**
   * The frictional contact problem of a step
   *
   *     w = A t + b,   0 <= t_n _|_ w_n >= 0,   |t_tau| <= mu t_n,   w_tau = -lambda t_tau,
   *     lambda >= 0,   lambda (mu t_n - |t_tau|) = 0
   *
   * for forces t, a vector per pair.
   */
  struct FrictionalProblem
  {
    using Vector = std::vector<CoulombFace::Force>;

    Vector b;                     ///< w without forces
    std::vector<double> friction; ///< mu of the pairs
    std::vector<double> weights;  ///< what a component of w counts in the residual
    double norm;                  ///< an upper bound of the norm of A
    double compliance;            ///< c to begin with, relative to the diagonal of A: one
    double tolerance;             ///< of the residual
    double sufficient;            ///< the same where it takes too long
    unsigned int limit;           ///< of applications of A
    bool start_is_reference;      ///< t_0 is the start, which solves almost the same problem

    /// Whether there is any friction.
    bool
    rubs() const
    {
      return std::any_of(friction.begin(), friction.end(), [](const double mu) { return mu > 0.; });
    }
  };


  /**
   * The problem with a compliance c, w = A t + b + c (t - t_0), at the forces that are tried: w,
   * how far they are from a solution, and friction limits that may be given instead of mu t_n,
   * which leaves the convex problem to minimise
   *
   *     phi(t) = t.(A t/2 + b + c (t/2 - t_0))
   *
   * Operator has apply(t, y): y = A t.
   */
  template <typename Operator>
  class CompliantProblem
  {
  public:
    using Vector = FrictionalProblem::Vector;

    void
    begin(const FrictionalProblem &new_data, Operator &new_op)
    {
      data             = &new_data;
      op               = &new_op;
      n_applications   = 0;
      limits_are_given = false;
      w.resize(data->b.size());
    }

    void
    set_reference(const Vector &t)
    {
      reference = t;
    }

    /// t_0 = 0
    void
    clear_reference()
    {
      reference.assign(data->b.size(), {});
    }

    void
    set_compliance(const double c)
    {
      compliance = c;
      step       = 1.9 / (data->norm + c);
    }

    /// Compute w of forces.
    void
    evaluate(const Vector &t)
    {
      op->apply(t, w);
      ++n_applications;
      drift = 0.;
      for (std::size_t i = 0; i < t.size(); ++i)
        w[i] += data->b[i] + compliance * (t[i] - reference[i]);
    }

    /// Add what a change of forces is known to change w by.
    void
    update(const Vector &image)
    {
      for (std::size_t i = 0; i < w.size(); ++i)
        {
          w[i] += image[i];
          drift = std::max(drift,
                           std::numeric_limits<double>::epsilon() * data->weights[i] *
                             image[i].norm());
        }
    }

    /// A step of length a against the gradient, back to the forces within the limits.
    void
    descend(Vector &t)
    {
      for (std::size_t i = 0; i < t.size(); ++i)
        t[i] = CoulombFace::project(t[i] - step * w[i], limit_of(i, t[i]));
      evaluate(t);
    }

    /// Forces within the limits next to a part of the way from some to others.
    void
    move(const Vector &from, const double part, const Vector &to, Vector &t)
    {
      for (std::size_t i = 0; i < t.size(); ++i)
        t[i] = CoulombFace::project(from[i] + part * (to[i] - from[i]), limits[i]);
      evaluate(t);
    }

    /// y = A t + c t
    void
    apply(const Vector &t, Vector &y)
    {
      op->apply(t, y);
      ++n_applications;
      for (std::size_t i = 0; i < t.size(); ++i)
        y[i] += compliance * t[i];
    }

    /// Largest weighted component of (t - P(t - a w))/a.
    double
    measure(const Vector &t) const
    {
      double residual = 0.;
      for (std::size_t i = 0; i < t.size(); ++i)
        {
          const auto reached = CoulombFace::project(t[i] - step * w[i], limit_of(i, t[i]));
          residual = std::max(residual, data->weights[i] * (t[i] - reached).norm() / step);
        }
      return residual;
    }

    /// Largest weighted component of c (t - t_0).
    double
    error_of_compliance(const Vector &t) const
    {
      double error = 0.;
      for (std::size_t i = 0; i < t.size(); ++i)
        error = std::max(error, compliance * data->weights[i] * (t[i] - reference[i]).norm());
      return error;
    }

    /// Forces become the reference.
    void
    refer_to(const Vector &t)
    {
      for (std::size_t i = 0; i < t.size(); ++i)
        {
          w[i] -= compliance * (t[i] - reference[i]);
          reference[i] = t[i];
        }
    }

    /// Friction limit of a pair with a force.
    double
    limit_of(const std::size_t i, const CoulombFace::Force &t) const
    {
      return limits_are_given ? limits[i] : data->friction[i] * std::max(t[0], 0.);
    }

    /// Take limits from forces.
    void
    give_limits(const Vector &t)
    {
      limits_are_given = false;
      limits.resize(t.size());
      for (std::size_t i = 0; i < t.size(); ++i)
        limits[i] = limit_of(i, t[i]);
      limits_are_given = true;
    }

    /// To what the normal forces allow; whether that changes any force.
    bool
    lower_limits(const Vector &t)
    {
      constexpr double rounding = 1e-12;

      bool any = false;
      for (std::size_t i = 0; i < t.size(); ++i)
        if (const double allowed = data->friction[i] * std::max(t[i][0], 0.); allowed < limits[i])
          {
            any       = any || CoulombFace::tangential_size(t[i]) > (1. + rounding) * allowed;
            limits[i] = allowed;
          }
      return any;
    }

    void
    free_limits()
    {
      limits_are_given = false;
    }

    /// How mu t_n grows with t_n: not at all where limits are given.
    double
    coefficient(const std::size_t i) const
    {
      return limits_are_given ? 0. : data->friction[i];
    }

    /// phi
    double
    potential(const Vector &t) const
    {
      double sum = 0.;
      for (std::size_t i = 0; i < t.size(); ++i)
        sum += 0.5 * (t[i] * (w[i] + data->b[i] - compliance * reference[i]));
      return sum;
    }

    const Vector &
    motion() const
    {
      return w;
    }

    double
    get_compliance() const
    {
      return compliance;
    }

    /// Rounding of w since it was computed, weighted.
    double
    get_drift() const
    {
      return drift;
    }

    unsigned int
    applications() const
    {
      return n_applications;
    }

  private:
    const FrictionalProblem *data = nullptr;
    Operator *op                  = nullptr;
    unsigned int n_applications   = 0;
    double compliance             = 0.; ///< c
    double step                   = 0.; ///< a, of projected gradients
    double drift                  = 0.;
    bool limits_are_given         = false;
    std::vector<double> limits; ///< of friction, if given
    Vector w, reference;
  };
} // namespace akmon
