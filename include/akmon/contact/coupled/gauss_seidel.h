#pragma once

#include <akmon/contact/coupled/frictional_problem.h>

#include <Eigen/Core>

namespace akmon
{
  /**
   * Sweeps over the pairs of a FrictionalProblem: each pair in turn takes projected steps for the
   * forces that the others have by then (nonsmooth Gauss-Seidel: Jean, Comput. Methods Appl. Mech.
   * Eng. 177, 1999). They are slow close to a solution, but where Newton steps go round in a circle
   * they mostly come close to one.
   * @param A  three rows and columns for each pair
   * @param t  start on entry
   */
  void
  sweep(const Eigen::MatrixXd &A,
        const FrictionalProblem &problem,
        const unsigned int n_sweeps,
        FrictionalProblem::Vector &t);
} // namespace akmon
