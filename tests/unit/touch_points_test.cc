#include <akmon/rigid/rotation.h>
#include <akmon/rigid/triangle_shape.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/triangles.h"

// Where rigid shapes touch each other: closest points of corners, edges and rims.

namespace touch_points_test
{
  using namespace akmon;
  using namespace akmon::test;

  // Touch points of a shape against another that stands at a place, turned.
  std::vector<TouchPoint>
  touch(const RigidShape &shape,
        const RigidShape &other,
        const Vector &place,
        const Orientation &turn = Orientation(),
        const double within     = 1e3)
  {
    const auto R = turn.matrix();
    std::vector<TouchPoint> points;
    shape.touch_points(
      [&](const Vector &x) {
        auto there   = other.closest(transpose(R) * (x - place));
        there.normal = R * there.normal;
        return there;
      },
      within,
      points);
    std::sort(points.begin(), points.end(), [](const auto &a, const auto &b) {
      return a.other.distance < b.other.distance;
    });
    return points;
  }


  TEST(TouchPoints, BallAndBall)
  {
    const auto points = touch(BallShape(1.), BallShape(2.), Vector({0., 4., 0.}));
    ASSERT_EQ(points.size(), 1u);
    EXPECT_NEAR(points[0].other.distance, 1., 1e-15);
    EXPECT_NEAR((points[0].other.normal - Vector({0., -1., 0.})).norm(), 0., 1e-15);
  }


  // A cylinder lying on a plane touches it with both rims at its lowest points, however it is
  // rolled.
  TEST(TouchPoints, LyingCylinder)
  {
    const double angle = 0.7;
    // The plane seen from the cylinder's frame: its normal is across the axis.
    const Vector up({std::cos(angle), std::sin(angle), 0.});
    const auto points = touch(RoundBarShape(1., 4., 0.),
                              PlaneShape(),
                              -1.5 * up,
                              Orientation::z_axis_to(up));
    ASSERT_GE(points.size(), 2u);
    for (unsigned int i = 0; i < 2; ++i)
      {
        EXPECT_NEAR(points[i].other.distance, 0.5, 1e-14);
        EXPECT_NEAR(std::abs(points[i].x[2]), 2., 1e-15);
        EXPECT_NEAR(points[i].x[0], -up[0], 1e-14);
        EXPECT_NEAR(points[i].x[1], -up[1], 1e-14);
      }
    EXPECT_GT(points[2].other.distance, 1.4);
  }


  TEST(TouchPoints, StandingCylinderHasFourFeet)
  {
    const auto points = touch(RoundBarShape(1., 4., 0.25), PlaneShape(), Vector({0., 0., -2.}));
    Vector sum;
    for (unsigned int i = 0; i < 4; ++i)
      {
        EXPECT_NEAR(points[i].other.distance, 0., 1e-14);
        sum += points[i].x;
      }
    EXPECT_NEAR(std::hypot(sum[0], sum[1]), 0., 1e-14);
  }


  // Two bars across each other touch in the middle of their sides.
  TEST(TouchPoints, CrossedCylinders)
  {
    const auto points = touch(RoundBarShape(1., 6., 0.),
                              RoundBarShape(1., 6., 0.),
                              Vector({2.5, 0., 0.3}),
                              Orientation::about(Vector({0.5 * dealii::numbers::PI, 0., 0.})));
    EXPECT_NEAR(points[0].other.distance, 0.5, 1e-13);
    const auto place = points[0].x - points[0].radius * points[0].other.normal;
    EXPECT_NEAR((place - Vector({1., 0., 0.3})).norm(), 0., 1e-10);
  }


  TEST(TouchPoints, BoxesEdgeOnEdge)
  {
    // Two cubes turned by 45 degrees about x and y: their edges cross above each other.
    const BlockShape cube(Vector({2., 2., 2.}), 0.);
    const double s   = std::sqrt(2.);
    const double q   = 0.25 * dealii::numbers::PI;
    const auto lower = Orientation::about(Vector({q, 0., 0.}));
    const auto upper = Orientation::about(Vector({0., q, 0.}));
    // Seen from the lower one's frame.
    const auto points = touch(cube,
                              cube,
                              lower.inverse().matrix() * Vector({0.1, 0.2, 2. * s + 0.3}),
                              lower.inverse() * upper);
    EXPECT_GE(points[0].feature, 8u);
    EXPECT_NEAR(points[0].other.distance, 0.3, 1e-13);
    const auto place = lower.matrix() * points[0].x;
    EXPECT_NEAR((place - Vector({0.1, 0., s})).norm(), 0., 1e-10);
    // A surface of triangles has the same corners and edges.
    TriangleMesh mesh = triangle_box(Vector({2., 2., 2.}));
    make_closed(mesh);
    const auto of_mesh = touch(TriangleShape(mesh),
                               cube,
                               lower.inverse().matrix() * Vector({0.1, 0.2, 2. * s + 0.3}),
                               lower.inverse() * upper);
    EXPECT_NEAR((of_mesh[0].x - points[0].x).norm(), 0., 1e-12);
    // Diagonals of its sides are no edges.
    EXPECT_EQ(touch(TriangleShape(mesh), cube, Vector({5., 5., 5.})).size(), 8u);
  }


  TEST(TouchPoints, TorusOnBall)
  {
    // A ring put over a ball whose centre is a little off the axis.
    const auto points = touch(TorusShape(2., 0.5), BallShape(1.), Vector({0.3, 0.4, 0.}));
    EXPECT_NEAR(points[0].other.distance, 0., 1e-14);
    EXPECT_NEAR((points[0].x - Vector({1.2, 1.6, 0.})).norm(), 0., 1e-9);
    EXPECT_TRUE(touch(TorusShape(2., 0.5), BallShape(1.), Vector({9., 0., 0.}), {}, 1.).empty());
  }


  // A bar across a ring touches it at two places; the ring tells them, not the bar's axis.
  TEST(TouchPoints, BarAcrossRing)
  {
    const TorusShape ring(2., 0.25);
    const RoundBarShape bar(0.5, 10., 0.);
    const Vector place({0., 1., 0.7});
    const auto turn   = Orientation::about(Vector({0., 0.5 * dealii::numbers::PI, 0.}));
    const auto points = touch(ring, bar, place, turn);
    ASSERT_GE(points.size(), 2u);
    for (unsigned int i = 0; i < 2; ++i)
      {
        // Where the circle is closest to the line y = 1, z = 0.7.
        EXPECT_NEAR(points[i].other.distance, 0.7 - 0.75, 1e-13);
        EXPECT_NEAR(points[i].x[1], 1., 1e-9);
        EXPECT_NEAR(std::abs(points[i].x[0]), std::sqrt(3.), 1e-9);
        EXPECT_TRUE(points[i].least);
      }
    EXPECT_LT(points[0].x[0] * points[1].x[0], 0.);
    const auto of_bar = touch(bar, ring, turn.inverse().matrix() * -place, turn.inverse(), 1.);
    EXPECT_TRUE(of_bar.empty());
  }


  // Edges that cross and touch, up to rounding to this side or that: the normal is across both.
  TEST(TouchPoints, NormalsOfEdgesThatTouch)
  {
    const BlockShape cube(Vector({2., 2., 2.}), 0.);
    const double q = 0.25 * dealii::numbers::PI, s = std::sqrt(2.);
    const auto lower = Orientation::about(Vector({q, 0., 0.}));
    const auto upper = Orientation::about(Vector({0., q, 0.}));
    for (const double gap : {-1e-14, 0., 1e-14})
      {
        const auto points = touch(cube,
                                  cube,
                                  lower.inverse().matrix() * Vector({0.1, 0.2, 2. * s + gap}),
                                  lower.inverse() * upper);
        EXPECT_NEAR(points[0].other.distance, gap, 3e-15);
        const auto normal = lower.matrix() * points[0].other.normal;
        EXPECT_NEAR((normal - Vector({0., 0., -1.})).norm(), 0., 1e-8);
      }
  }


  // An edge across a bar is as close as it gets in its middle, at a quarter or anywhere.
  TEST(TouchPoints, EdgeAcrossBar)
  {
    const BlockShape block(Vector({1., 1., 4.}), 0.);
    const RoundBarShape bar(0.5, 10., 0.);
    const auto turn = Orientation::about(Vector({0., 0.5 * dealii::numbers::PI, 0.}));
    for (const double z : {0., -1., 0.5, 1. / 3.})
      {
        const auto points = touch(block, bar, Vector({5.2, 1.1, z}), turn, 0.5);
        ASSERT_EQ(points.size(), 1u) << z;
        EXPECT_NEAR(points[0].other.distance, 0.1, 1e-13);
        EXPECT_NEAR((points[0].x - Vector({0.5, 0.5, z})).norm(), 0., 1e-8);
      }
  }
} // namespace touch_points_test
