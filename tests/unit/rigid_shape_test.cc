#include <akmon/rigid/rigid_shape.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

// Signed distances, closest points and mass properties of analytic rigid shapes.

namespace rigid_shape_test
{
  using namespace akmon;
  using Vector        = dealii::Tensor<1, 3>;
  constexpr double pi = dealii::numbers::PI;

  std::mt19937 generator(1);

  Vector
  random_point(const double reach)
  {
    std::uniform_real_distribution<double> number(-reach, reach);
    return Vector({number(generator), number(generator), number(generator)});
  }


  // The closest point lies on the surface, the normal is the gradient of the distance, and the ball
  // of that radius around x does not reach beyond: what a signed distance is.
  void
  expect_signed_distance(const RigidShape &shape, const double reach)
  {
    constexpr double h = 1e-6;
    for (unsigned int i = 0; i < 2000; ++i)
      {
        const Vector x  = random_point(reach);
        const auto here = shape.closest(x);
        EXPECT_NEAR(here.normal.norm(), 1., 1e-14);
        EXPECT_NEAR(shape.closest(x - here.distance * here.normal).distance, 0., 1e-13 * reach);
        // Distances are Lipschitz with constant one in every direction.
        const Vector y = random_point(reach);
        EXPECT_LE(std::abs(shape.closest(y).distance - here.distance),
                  (y - x).norm() * (1. + 1e-13));
        EXPECT_NEAR(shape.closest(x + h * here.normal).distance, here.distance + h, 1e-12);
      }
  }


  TEST(RigidShape, Distances)
  {
    expect_signed_distance(PlaneShape(), 2.);
    expect_signed_distance(BallShape(1.3), 2.);
    expect_signed_distance(RoundBarShape(0.7, 1.5, 0.), 2.);
    expect_signed_distance(RoundBarShape(0.7, 1.5, 0.2), 2.);
    expect_signed_distance(RoundBarShape(0.7, std::numeric_limits<double>::infinity(), 0.), 2.);
    expect_signed_distance(BlockShape(Vector({1., 2., 0.5}), 0.), 2.);
    expect_signed_distance(BlockShape(Vector({1., 2., 0.5}), 0.1), 2.);
    expect_signed_distance(TorusShape(1., 0.3), 2.);
  }


  TEST(RigidShape, KnownPlaces)
  {
    const auto at = [](const RigidShape &shape, const double x, const double y, const double z) {
      return shape.closest(Vector({x, y, z})).distance;
    };
    EXPECT_DOUBLE_EQ(at(BallShape(2.), 3., 0., 4.), 3.);
    EXPECT_DOUBLE_EQ(at(RoundBarShape(1., 2., 0.), 4., 0., 5.), 5.); // rim (1, 0, 1)
    EXPECT_DOUBLE_EQ(at(RoundBarShape(1., 2., 0.), 0.5, 0., 0.8), -0.2);
    EXPECT_NEAR(at(RoundBarShape(1., 2., 0.5), 3.5, 0., 4.5), 4.5, 1e-15); // circle (.5, 0, .5)
    EXPECT_DOUBLE_EQ(at(BlockShape(Vector({2., 2., 2.}), 0.), 2., 3., 3.), 3.);
    EXPECT_DOUBLE_EQ(at(BlockShape(Vector({2., 2., 2.}), 0.5), 0., 0., 0.9), -0.1);
    EXPECT_DOUBLE_EQ(at(TorusShape(2., 0.5), 5., 0., 4.), 4.5);
    EXPECT_DOUBLE_EQ(at(TorusShape(2., 0.5), 0., 0., 0.), 1.5);
    EXPECT_NEAR(BlockShape(Vector({2., 4., 4.}), 0.).radius(), 3., 1e-15);
    EXPECT_NEAR(RoundBarShape(3., 8., 0.).radius(), 5., 1e-15);
  }


  // In the corner of a container three walls are near at once; outside of it there is one surface.
  TEST(RigidShape, WallsOfContainers)
  {
    const auto block = std::make_shared<BlockShape>(Vector({2., 2., 2.}), 0.);
    const HollowShape box(block);
    std::vector<SurfacePoint> walls;
    box.nearby(Vector({0.9, 0.8, -0.95}), 0.3, walls);
    ASSERT_EQ(walls.size(), 3u);
    Vector sum;
    for (const auto &wall : walls)
      {
        sum += wall.distance * wall.normal;
        EXPECT_GT(wall.distance, 0.);
      }
    EXPECT_NEAR((sum - Vector({-0.1, -0.2, 0.05})).norm(), 0., 1e-15);
    walls.clear();
    box.nearby(Vector({0., 0., 0.}), 0.3, walls);
    EXPECT_TRUE(walls.empty());

    walls.clear();
    HollowShape(std::make_shared<RoundBarShape>(1., 2., 0.))
      .nearby(Vector({0.9, 0., 0.9}), 0.3, walls);
    EXPECT_EQ(walls.size(), 2u);

    walls.clear();
    block->nearby(Vector({1.1, 1.1, 1.1}), 0.3, walls);
    ASSERT_EQ(walls.size(), 1u);
    EXPECT_NEAR(walls[0].distance, 0.1 * std::sqrt(3.), 1e-15);
  }


  void
  expect_mass(const MassProperties &actual,
              const double mass,
              const double xx,
              const double yy,
              const double zz)
  {
    EXPECT_NEAR(actual.mass, mass, 1e-12 * mass);
    EXPECT_NEAR(actual.inertia[0][0], xx, 1e-12 * xx);
    EXPECT_NEAR(actual.inertia[1][1], yy, 1e-12 * yy);
    EXPECT_NEAR(actual.inertia[2][2], zz, 1e-12 * zz);
    EXPECT_EQ(actual.inertia[0][1], 0.);
    EXPECT_EQ(actual.centre.norm(), 0.);
  }


  TEST(RigidShape, MassProperties)
  {
    const double R = 1.7, rho = 3.;
    const double ball = 4. / 3. * pi * R * R * R * rho, I_ball = 0.4 * ball * R * R;
    expect_mass(BallShape(R).mass_properties(rho), ball, I_ball, I_ball, I_ball);
    // Rounded as far as it goes, a box and a cylinder are balls.
    expect_mass(BlockShape(Vector({2. * R, 2. * R, 2. * R}), R).mass_properties(rho),
                ball,
                I_ball,
                I_ball,
                I_ball);
    expect_mass(RoundBarShape(R, 2. * R, R).mass_properties(rho), ball, I_ball, I_ball, I_ball);

    const double L = 5., bar = pi * R * R * L * rho;
    const double across = bar * (3. * R * R + L * L) / 12.;
    expect_mass(RoundBarShape(R, L, 0.).mass_properties(rho),
                bar,
                across,
                across,
                0.5 * bar * R * R);
    // A capsule: a bar between two half balls, whose centres are 3/8 R beyond the bar's ends.
    const double I_ends = I_ball + ball * (0.25 * L * L + 3. / 8. * L * R);
    expect_mass(RoundBarShape(R, L + 2. * R, R).mass_properties(rho),
                bar + ball,
                across + I_ends,
                across + I_ends,
                0.5 * bar * R * R + I_ball);
    expect_mass(BlockShape(Vector({2. * R, 2. * R, L + 2. * R}), R).mass_properties(rho),
                bar + ball,
                across + I_ends,
                across + I_ends,
                0.5 * bar * R * R + I_ball);
    const double box = 1. * 2. * 3. * rho;
    expect_mass(BlockShape(Vector({1., 2., 3.}), 0.).mass_properties(rho),
                box,
                box * 13. / 12.,
                box * 10. / 12.,
                box * 5. / 12.);
    const double torus = 2. * pi * pi * 2. * 0.25 * rho;
    expect_mass(TorusShape(2., 0.5).mass_properties(rho),
                torus,
                torus * (2. + 0.625 * 0.25),
                torus * (2. + 0.625 * 0.25),
                torus * (4. + 0.75 * 0.25));
    EXPECT_TRUE(std::isinf(PlaneShape().mass_properties(rho).mass));
  }


  // Steiner's formula for the volume; a sum over a grid, smoothed over a cell at the surface.
  TEST(RigidShape, MassOfRoundedBox)
  {
    const double r = 0.2, a = 0.6, b = 0.4, c = 0.2;
    const BlockShape shape(Vector({a + 2. * r, b + 2. * r, c + 2. * r}), r);
    constexpr unsigned int n = 100;
    const double h           = 1. / n;
    double zz                = 0.;
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
        for (unsigned int k = 0; k < n; ++k)
          {
            const Vector x({(i + 0.5) * h - 0.5, (j + 0.5) * h - 0.5, (k + 0.5) * h - 0.5});
            const double filled = std::clamp(0.5 - shape.closest(x).distance / h, 0., 1.);
            zz += filled * h * h * h * (x[0] * x[0] + x[1] * x[1]);
          }
    const auto actual = shape.mass_properties(1.);
    EXPECT_NEAR(actual.mass,
                a * b * c + 2. * (a * b + b * c + c * a) * r + pi * (a + b + c) * r * r +
                  4. / 3. * pi * r * r * r,
                1e-13);
    EXPECT_NEAR(actual.inertia[2][2], zz, 1e-3 * zz);
  }
} // namespace rigid_shape_test
