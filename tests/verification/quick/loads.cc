#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "support/run_case.h"

// Surface loads and body force against Newton's second law: the momentum is the impulse. A free
// brick 2 x 1 x 1 with mass 2 under the load; its faces keep their areas to the small strains here.

namespace loads
{
  using namespace akmon::test;

  Table
  run_brick(const std::string &sections)
  {
    const ScratchDirectory scratch;
    const std::string file = scratch.path + "/brick.prm";
    std::ofstream(file) << "subsection Time\n set End = 2\nend\n"
                           "subsection Materials\n set Names = stiff\n subsection stiff\n"
                           "  set Density = 1\n  set Young's modulus = 1e4\n"
                           "  set Poisson's ratio = 0.3\n end\nend\n"
                           "subsection Bodies\n set Names = brick\n subsection brick\n"
                           "  set Material = stiff\n  set Shape = box\n  subsection Box\n"
                           "   set Size = 2, 1, 1\n   set Cells = 4, 2, 2\n  end\n end\nend\n"
                        << sections;
    // Equal steps: the velocity of a level is then the mean of its half steps exactly.
    return run_case(file, {"Time/Step=0.002"});
  }


  std::string
  load(const std::string &type, const std::string &surfaces, const std::string &function)
  {
    return "subsection Loads\n set Names = push\n subsection push\n  set Type = " + type +
           "\n  set Surfaces = " + surfaces + "\n  set Function = " + function + "\n end\nend\n";
  }


  TEST(SurfaceLoad, pressure_pushes_against_the_outward_normal)
  {
    const Table history = run_brick(load("pressure", "brick:x+", "0.5"));
    EXPECT_NEAR(history["momentum_x"].back(), -0.5 * 2., 1e-3);
    EXPECT_NEAR(history["momentum_y"].back(), 0., 1e-12);
    EXPECT_NEAR(history["external_work"].back(), 0.5 * 1. * 1. / 2., 2e-3);
  }


  // Nothing but rounding moves at first, which is no error of the energy balance.
  TEST(SurfaceLoad, may_rise_from_zero_on_a_body_at_rest)
  {
    const Table history = run_brick(load("pressure", "brick:x+", "0.5e-6*(1 - cos(pi*t))") +
                                    "subsection Output\n set History steps = 1\nend\n");
    // int_0^2 of the pressure
    EXPECT_NEAR(history["momentum_x"].back(), -1e-6, 1e-9);
    for (const double error : history["energy_error"])
      EXPECT_NEAR(error, 0., 1e-2);
  }


  TEST(SurfaceLoad, pressure_all_around_is_in_balance)
  {
    const Table history = run_brick(load("pressure", "brick", "0.5"));
    for (const char *const axis : {"x", "y", "z"})
      EXPECT_NEAR(history[std::string("momentum_") + axis].back(), 0., 1e-12);
  }


  TEST(SurfaceLoad, traction_is_a_function_of_space_and_time)
  {
    // int over y- (2 x 1 at y = -1/2) of (0.1 t, 0, 0.3 x^2): (0.2 t, 0, 0.3 * 2/3)
    const Table history = run_brick(load("traction", "brick:y-", "0.1*t; 0; 0.3*x^2"));
    EXPECT_NEAR(history["momentum_x"].back(), 0.1 * 2. * 2., 2e-3);
    // Two Gauss points along x in each of the four cells integrate x^2 exactly.
    EXPECT_NEAR(history["momentum_z"].back(), 0.2 * 2., 2e-3);
  }


  TEST(BodyForce, depends_on_time)
  {
    const Table history = run_brick(
      "subsection Body force\n set Acceleration = 0; 3*t; -9.81\nend\n");
    EXPECT_NEAR(history["momentum_z"].back(), -9.81 * 2. * 2., 1e-9 * 40.);
    EXPECT_NEAR(history["momentum_y"].back(), 3. * 2. * 2., 1e-4); // int 3 t m dt
  }


  // 2 int rho x x dV over the brick, lumped at nodes 1/2 apart: 2 (2/3 + 4/12 (1/2)^2).
  TEST(InitialVelocity, is_a_function_of_position)
  {
    const Table history = run_brick("subsection Bodies\n subsection brick\n"
                                    "  set Velocity = 0, 0, 1\n"
                                    "  set Velocity field = 3; 2*x; 0\n end\nend\n");
    EXPECT_NEAR(history["momentum_x"].front(), 3. * 2., 1e-12);
    EXPECT_NEAR(history["momentum_y"].front(), 0., 1e-12);
    EXPECT_NEAR(history["momentum_z"].front(), 1. * 2., 1e-12);
    EXPECT_NEAR(history["angular_momentum_z"].front(), 1.5, 1e-12);
    EXPECT_NEAR(history["angular_momentum_z"].back(), 1.5, 1e-11);
  }


  // Momentum decays by exp(-eta t) until the damping ends, and stays from then on.
  TEST(Damping, ends_at_its_time)
  {
    const Table history = run_brick("subsection Bodies\n subsection brick\n"
                                    "  set Velocity = 3, 0, 0\n end\nend\n"
                                    "subsection Body force\n set Damping = 2\n"
                                    " set Damping end = 0.8\nend\n");
    const double left   = 6. * std::exp(-2. * 0.8);
    EXPECT_NEAR(history["momentum_x"].back(), left, 4e-3 * left);
    const auto rows = history.rows_between(0.81, 2.);
    for (const std::size_t i : rows)
      EXPECT_NEAR(history["momentum_x"][i], history["momentum_x"].back(), 1e-12);
    const double rest = history["momentum_x"].back();
    EXPECT_NEAR(history["damping_dissipation"].back(), 9. - rest * rest / 4., 1e-9);
    EXPECT_LT(std::abs(history["energy_error"].back()), 1e-9);
  }
} // namespace loads
