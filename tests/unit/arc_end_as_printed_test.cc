#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/arc_end.h"

// The update as the paper prints it, in each of its readings, against the one that akmon uses:
// accuracy and objectivity.

namespace arc_end_as_printed_test
{
  using namespace akmon;
  using namespace akmon::test;
  using namespace akmon::test::arc_end_paths;

  Matrix
  mid_map(const Matrix &F)
  {
    return identity_plus(0.5, minus_identity(F));
  }


  // Problem 1, (13) with (18)-(24) to the letter: J^t_mid F^mid_t (C : E_mid) F^mid_t^T, where
  // F^mid_t is the inverse of F^t_mid = (I + F)/2 (22), and E_mid from the Green-Lagrange strain
  // (19)(20).
  void
  printed_problem_1(const Matrix &F, Stress &stress)
  {
    const Matrix F_m         = mid_map(F);
    const Matrix inverse_F_m = inverse(F_m);
    const Matrix twice_E_mid = transpose(inverse_F_m) * minus_identity(transpose(F) * F) *
                               inverse_F_m;
    Stress E_mid = symmetric_part(twice_E_mid);
    for (unsigned int i = 0; i < 6; ++i)
      E_mid[i] *= 0.5;
    stress = push_forward(F, stress, 1. / determinant(F)) +
             push_forward(inverse_F_m, elastic.elasticity.stress(E_mid), determinant(F_m));
  }


  // Algorithm 1, step 3 to the letter: the same map, and E_mid = (F_m^T F_m - (F_m F_m^T)^{-1})/2,
  // which is (19) for F = F_m F_m.
  void
  printed_algorithm_1(const Matrix &F, Stress &stress)
  {
    const Matrix F_m         = mid_map(F);
    const Matrix inverse_F_m = inverse(F_m);
    const Stress right       = symmetric_part(transpose(F_m) * F_m);
    const Stress left        = symmetric_part(transpose(inverse_F_m) * inverse_F_m);
    Stress E_mid;
    for (unsigned int i = 0; i < 6; ++i)
      E_mid[i] = 0.5 * (right[i] - left[i]);
    stress = push_forward(F, stress, 1. / determinant(F)) +
             push_forward(inverse_F_m, elastic.elasticity.stress(E_mid), determinant(F_m));
  }


  // A push-forward after all, but with both half maps (I + F)/2 (22).
  void
  equal_half_maps(const Matrix &F, Stress &stress)
  {
    const Matrix F_m         = mid_map(F);
    const Matrix inverse_F_m = inverse(F_m);
    const Matrix L           = minus_identity(F) * inverse_F_m;
    stress                   = push_forward(F, stress, 1. / determinant(F)) +
             push_forward(F_m, elastic.elasticity.stress(symmetric_part(L)), 1. / determinant(F_m));
  }


  struct Reading
  {
    std::string name;
    Update step;
    double order;
  };

  const std::vector<Reading> readings = {{"problem_1", printed_problem_1, 1.},
                                         {"algorithm_1", printed_algorithm_1, 1.},
                                         {"equal_half_maps", equal_half_maps, 2.},
                                         {"arc_end", arc_end, 2.}};


  double
  rotating_error(const Reading &reading, const unsigned int N)
  {
    const Stress exact = rotating_stretch_by_quadrature();
    return distance(integrate(rotating_stretch, N, reading.step), exact) / norm(exact);
  }


  // The lateral stress belongs to it: with equal half maps sigma11 happens to be exact.
  double
  uniaxial_error(const Reading &reading, const unsigned int N)
  {
    const Stress exact{{600., 400. / 3., 400. / 3., 0., 0., 0.}};
    return distance(integrate(uniaxial_strain(1.5), N, reading.step), exact) / norm(exact);
  }


  TEST(ArcEndAsPrinted, InverseMidMapIsOfFirstOrderAndEqualHalfMapsOfSecond)
  {
    for (const auto &reading : readings)
      {
        for (const unsigned int N : {1, 4, 10, 100})
          {
            report(reading.name + "_rotating_error_" + std::to_string(N),
                   rotating_error(reading, N));
            report(reading.name + "_uniaxial_error_" + std::to_string(N),
                   uniaxial_error(reading, N));
          }
        const double rotating = observed_order(rotating_error(reading, 200),
                                               rotating_error(reading, 400));
        const double uniaxial = observed_order(uniaxial_error(reading, 200),
                                               uniaxial_error(reading, 400));
        report(reading.name + "_rotating_order", rotating);
        report(reading.name + "_uniaxial_order", uniaxial);
        EXPECT_NEAR(rotating, reading.order, 0.05) << reading.name;
        EXPECT_NEAR(uniaxial, reading.order, 0.05) << reading.name;
      }
  }


  TEST(ArcEndAsPrinted, InverseMidMapIsObjectiveToFirstOrderAndEqualHalfMapsToSecond)
  {
    for (const auto &reading : readings)
      {
        for (const double degrees : {1., 10., 40., 90.})
          report(reading.name + "_lack_of_objectivity_" + std::to_string(int(degrees)),
                 lack_of_objectivity(reading.step, diagonal(1.02, 0.99, 1.01), rotation(degrees)));
        const double order = observed_order(lack_of_objectivity(reading.step, 0.02),
                                            lack_of_objectivity(reading.step, 0.01));
        report(reading.name + "_objectivity_order", order);
        EXPECT_NEAR(order, reading.order, 0.05) << reading.name;
      }
  }


  TEST(ArcEndAsPrinted, StrainOfAlgorithmOneMakesStressInRigidRotation)
  {
    // All readings but this one have E = 0 for F = Q. With F_m = c R(theta/2) in the plane,
    // c = cos(theta/2), the strain of Algorithm 1 is (c^2 - 1/c^2)/2 there and 0 along the axis;
    // the map c^2 F_m^{-1} (.) F_m^{-T} leaves (lambda + mu)(c^2 - 1/c^2) in the plane and
    // multiplies lambda (c^2 - 1/c^2) along the axis by c^2.
    for (const double degrees : {1., 10., 90.})
      {
        const double c2     = std::pow(std::cos(degrees / 360. * std::acos(-1.)), 2);
        const double strain = c2 - 1. / c2;
        const Matrix Q      = rotation(degrees, 0., 0., 1.);
        const Stress stress = one_step(printed_algorithm_1, Q);
        report("algorithm_1_rigid_rotation_pressure_over_E_" + std::to_string(int(degrees)),
               stress[0] / E);
        EXPECT_LT(distance(stress,
                           {{800. * strain, 800. * strain, 400. * c2 * strain, 0., 0., 0.}}),
                  1e-12 * E);
        for (const auto &step : {printed_problem_1, equal_half_maps, arc_end})
          EXPECT_LT(norm(one_step(step, Q)), 1e-12 * E);
      }
  }
} // namespace arc_end_as_printed_test
