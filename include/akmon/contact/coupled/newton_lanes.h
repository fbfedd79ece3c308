#pragma once

#include <akmon/contact/coupled/frictional_problem.h>
#include <akmon/contact/coupled/linear_lanes.h>
#include <akmon/simd.h>

#include <Eigen/Core>
#include <array>
#include <vector>

namespace akmon
{
  /**
   * Frictional contact problems of few pairs, one in each SIMD lane: the Newton steps of
   * SemismoothNewton that nearly all of them are solved by, with all faces chosen anew in every
   * step. A problem that these do not solve is left to SemismoothNewton as it was. What becomes of
   * a problem does not depend on the other lanes.
   */
  class NewtonLanes
  {
  public:
    /// A problem, and what has become of it.
    struct Problem
    {
      const Eigen::MatrixXd *A;      ///< three rows for each pair, symmetric
      const FrictionalProblem *data; ///< its limit is at least twice most_steps
      FrictionalProblem::Vector *t;  ///< start on entry, solution on return where there is one
      bool is_solved              = false;
      unsigned int n_applications = 0;  ///< of A
      double residual             = 0.; ///< as in SemismoothNewton
    };

    static constexpr unsigned int most_pairs = 12; ///< beyond, factors that are kept and halved
                                                   ///< where nothing slips are worth more
    static constexpr unsigned int most_steps = 25;

    /**
     * @param problems  at most one for each lane, of at most most_pairs
     */
    void
    solve(std::vector<Problem> &problems);

  private:
    using Mask = Lanes::batch_bool_type;

    // As CoulombFace. Where nothing slips the direction of slip is any.
    struct Face
    {
      Mask normal, disc, circle;
      Lanes slip_1, slip_2; ///< d
      Lanes curvature, mu;

      // The normal, along the circle, that of slip.
      std::array<Mask, 3>
      free_directions() const
      {
        return {{normal, disc | circle, disc}};
      }
    };

    void
    pack(const std::vector<Problem> &problems);
    void
    pack_into(const unsigned int lane, const Problem &problem);
    void
    clear_lanes();
    void
    choose_faces();
    void
    evaluate();
    Lanes
    measure() const;
    Lanes
    error_of_compliance() const;
    void
    settle(const Lanes &residual);
    void
    lose_patience(const Lanes &residual);
    void
    newton_step();
    void
    make_jacobian();
    void
    make_block(const unsigned int i, const unsigned int j);
    void
    unpack(std::vector<Problem> &problems) const;

    unsigned int n = 0;            ///< pairs of the largest problem; others are filled up with
                                   ///< pairs that are open
    std::vector<Lanes> A;          ///< by row and column
    std::vector<Lanes> b, t, w;    ///< by row
    std::vector<Lanes> reference;  ///< t_0
    std::vector<Lanes> mu, weight; ///< by pair
    std::vector<Face> faces;       ///< by pair
    LinearLanes system;            ///< of the Newton step
    Lanes compliance, step, tolerance, sufficient;
    Lanes enough; ///< residual that is small enough for the present reference
    Lanes best;   ///< residual
    Lanes steps_since_best;
    Lanes last_error; ///< of compliance
    Lanes n_references;
    Lanes n_applications;
    Lanes final_residual;
    Mask active; ///< not solved and not given up
    Mask solved;
  };
} // namespace akmon
