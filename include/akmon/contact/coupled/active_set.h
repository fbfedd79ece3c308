#pragma once

#include <Eigen/Core>

namespace akmon
{
  /**
   * Forces t without friction,
   *
   *     w = A t + b,   0 <= t _|_ w >= 0 ,
   *
   * by a set of active pairs that changes by one at a time: the pair that is violated most joins,
   * and pairs leave it whose forces become zero on the way to its closing (Lawson and Hanson,
   * Solving Least Squares Problems, 1974, chapter 23). Slower than Newton's method, which changes
   * many at once, but it comes to an end also where constraints nearly repeat each other.
   * @param A          symmetric, positive semidefinite, with a unit diagonal or zero rows
   * @param weights    what a component of w counts
   * @param tolerance  of the weighted violation -w
   * @param t          solution on return; nothing is taken from it
   * @return           whether one was found
   */
  bool
  solve_by_active_set(const Eigen::MatrixXd &A,
                      const Eigen::VectorXd &b,
                      const Eigen::VectorXd &weights,
                      const double tolerance,
                      Eigen::VectorXd &t);
} // namespace akmon
