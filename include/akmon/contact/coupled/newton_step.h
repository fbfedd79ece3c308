#pragma once

#include <akmon/contact/coupled/coulomb_faces.h>
#include <akmon/contact/coupled/frictional_problem.h>
#include <akmon/contact/coupled/gmres.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace akmon
{
  /**
   * A step of SemismoothNewton: on given faces the problem is a linear system, solved by
   * preconditioned GMRES. Its storage is reused.
   */
  template <typename Operator, typename Preconditioner>
  class NewtonStep
  {
  public:
    using Vector  = FrictionalProblem::Vector;
    using Problem = CompliantProblem<Operator>;

    /// All are referred to.
    void
    begin(const FrictionalProblem &new_data, Problem &new_problem, Preconditioner &new_precondition)
    {
      data         = &new_data;
      problem      = &new_problem;
      precondition = &new_precondition;
      for (Vector *const v : {&r, &direction, &image, &remainder})
        v->resize(data->b.size());
    }

    /**
     * t + p with w + (A + c) p = 0 in the free components, where turning along a circle counts with
     * its curvature.
     * @param reduction  of the residual that is enough
     * @param most       applications of A
     */
    void
    take(const std::vector<CoulombFace> &faces,
         const double reduction,
         const unsigned int most,
         Vector &t)
    {
      double weighted = 0.;
      for (std::size_t i = 0; i < t.size(); ++i)
        {
          r[i]     = -faces[i].restrict_to(problem->motion()[i]);
          weighted = std::max(weighted, data->weights[i] * r[i].norm());
        }
      precondition->reinit(faces, problem->get_compliance());
      if (precondition->is_exact())
        {
          precondition_on(faces, r, direction);
          apply_on(faces, direction, image, remainder);
        }
      else
        solve(faces, reduction, most, weighted);
      for (std::size_t i = 0; i < t.size(); ++i)
        t[i] += direction[i];
      problem->update(image);
    }

  private:
    // By GMRES: direction and image.
    void
    solve(const std::vector<CoulombFace> &faces,
          const double reduction,
          const unsigned int most,
          const double weighted)
    {
      constexpr unsigned int dimension = 80;

      const double norm = std::sqrt(Gmres::product(r, r));
      const double goal = weighted > 0. ? 0.15 * data->tolerance / weighted : 1.;
      gmres.solve([&](Vector &p, Vector &of_p, Vector &y) { apply_on(faces, p, of_p, y); },
                  [&](const Vector &v, Vector &z) { precondition_on(faces, v, z); },
                  r,
                  std::max(reduction, goal) * norm,
                  std::min(dimension, most));
      gmres.combine(direction, image);
    }

    void
    precondition_on(const std::vector<CoulombFace> &faces, const Vector &v, Vector &z)
    {
      precondition->apply(v, z);
      for (std::size_t i = 0; i < v.size(); ++i)
        z[i] = faces[i].restrict_to(z[i]);
    }

    // Takes p from its free components to changes of forces.
    void
    apply_on(const std::vector<CoulombFace> &faces, Vector &p, Vector &of_p, Vector &y)
    {
      for (std::size_t i = 0; i < p.size(); ++i)
        {
          y[i] = (faces[i].curvature * (p[i] * faces[i].along)) * faces[i].along;
          p[i] = faces[i].lift(p[i]);
        }
      problem->apply(p, of_p);
      for (std::size_t i = 0; i < p.size(); ++i)
        y[i] += faces[i].restrict_to(of_p[i]);
    }

    const FrictionalProblem *data = nullptr;
    Problem *problem              = nullptr;
    Preconditioner *precondition  = nullptr;
    Gmres gmres;
    Vector r, direction, image, remainder;
  };
} // namespace akmon
