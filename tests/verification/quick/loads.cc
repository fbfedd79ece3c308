#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "support/run_case.h"

// Surface loads and body force against Newton's second law: the momentum is the impulse. A free
// brick 2 x 1 x 1 with mass 2 under the load; its faces keep their areas to the small strains here.

using namespace akmon::test;

namespace
{
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
} // namespace
