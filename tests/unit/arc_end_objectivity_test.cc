#include <gtest/gtest.h>

#include <cmath>

#include "support/arc_end.h"

// The ARC-end update seen from turned frames: what it keeps exactly, and what to which order.

namespace arc_end_objectivity_test
{
  using namespace akmon;
  using namespace akmon::test;
  using namespace akmon::test::arc_end_paths;

  TEST(ArcEnd, RigidRotationInOneStepTurnsTheStress)
  {
    // E = 0 for F = Q, so sigma_{n+1} = Q sigma_n Q^T; at 180 degrees F_m is singular.
    const Stress before = {{120., -340., 55., 210., -75., 33.}};
    for (const double degrees : {10., 90., 170.})
      {
        const Matrix Q  = rotation(degrees);
        Stress after    = before;
        const auto step = update(elastic, Q, after);
        EXPECT_LT(distance(after, rotated(Q, before)), 1e-12 * norm(before)) << degrees;
        EXPECT_LT(norm(step.strain), 1e-13) << degrees;
      }
  }


  TEST(ArcEnd, ChangeOfFrameChangesNothing)
  {
    Random random;
    // Both configurations turned by the same Q: F -> Q F Q^T, sigma_n -> Q sigma_n Q^T. C is
    // isotropic, so sigma_{n+1} -> Q sigma_{n+1} Q^T and E_mid likewise.
    for (const double degrees : {10., 90., 170.})
      for (unsigned int trial = 0; trial < 20; ++trial)
        {
          const Matrix Q       = rotation(degrees);
          const Matrix F       = random.deformation();
          Stress fixed         = random.stress();
          Stress turned        = rotated(Q, fixed);
          const auto in_fixed  = update(elastic, F, fixed);
          const auto in_turned = update(elastic, Q * F * transpose(Q), turned);
          EXPECT_LT(distance(turned, rotated(Q, fixed)), 1e-12 * norm(fixed));
          EXPECT_LT(distance(in_turned.strain, rotated(Q, in_fixed.strain)), 1e-13);
        }
  }


  TEST(ArcEnd, OldStressIsCarriedObjectivelyWhateverTheStepDoes)
  {
    Random random;
    // sigma_hat = J^{-1} F sigma_n F^T (18), seen by a law without stiffness: for F -> Q F exactly
    // Q sigma_hat Q^T.
    const Hypoelastic no_stiffness{};
    const Matrix F{{{1.3, 0.2, -0.1}, {-0.05, 0.8, 0.15}, {0.1, 0.05, 1.1}}};
    const Stress before = random.stress();
    Stress straight     = before;
    update(no_stiffness, F, straight);
    EXPECT_LT(distance(straight, push_forward(F, before, 1. / determinant(F))),
              1e-12 * norm(straight));
    for (const double degrees : {10., 90., 150.})
      {
        const Matrix Q = rotation(degrees);
        Stress turned  = before;
        update(no_stiffness, Q * F, turned);
        EXPECT_LT(distance(turned, rotated(Q, straight)), 1e-12 * norm(straight)) << degrees;
      }
  }


  TEST(ArcEnd, StretchAndTurnInOneStepIsObjectiveToSecondOrderOnly)
  {
    // Turning x_{n+1} alone, F -> Q F, turns the new stress exactly if F is a rotation, not if it
    // stretches: F_me E_mid F_me^T = Q F C_m^{-1} E C_m^{-1} F^T Q^T, and
    // C_m = F_m^T F_m = (I + F^T F + Q F + F^T Q^T)/4 depends on Q. Its change is O(h^2) for
    // stretch and turn of O(h), as is the error of the method.
    const double order = observed_order(lack_of_objectivity(arc_end, 0.1),
                                        lack_of_objectivity(arc_end, 0.05));
    report("order_of_objectivity_arc_end", order);
    EXPECT_GT(order, 1.95);
    EXPECT_LT(order, 2.05);

    // For a vanishing stretch, in the plane of the rotation F_m = c R(theta/2) with c =
    // cos(theta/2), so F_me = R(theta/2)/c, J_me = 1/c^2 and E_mid = E/c^2; along the axis both
    // maps are 1. Strain e along the axis then gives M e c^2 instead of M e ...
    const double e     = 1e-7;
    const double angle = 40. * std::acos(-1.) / 180.;
    const double c2    = std::pow(std::cos(angle / 2.), 2);
    const Matrix Q     = rotation(40., 0., 0., 1.);
    const Stress along = one_step(arc_end, Q * diagonal(1., 1., 1. + e));
    EXPECT_NEAR(along[2], 1200. * e * c2, 1e-5 * 1200. * e);
    // ... and e in all directions of the plane 2 (lambda + mu) e/c^2 instead of 2 (lambda + mu) e.
    const Stress across = one_step(arc_end, Q * diagonal(1. + e, 1. + e, 1.));
    EXPECT_NEAR(across[0], 1600. * e / c2, 1e-5 * 1600. * e);
  }
} // namespace arc_end_objectivity_test
