#include <akmon/contact/search/face_box.h>
#include <akmon/contact/search/face_geometry.h>

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <vector>

// Boxes along faces: how far a point is from a segment at least.

namespace face_box_test
{
  using namespace akmon;

  using Corners = std::array<FaceBox<double>::Vector, 4>;

  // A unit square with corners moved by up to a fifth of it.
  struct Squares
  {
    Segment
    make()
    {
      Segment corners;
      for (unsigned int k = 0; k < 4; ++k)
        corners[k] = point(0.2) +
                     dealii::Tensor<1, 3>({k == 1 || k == 2 ? 1. : 0., k < 2 ? 0. : 1., 0.});
      return corners;
    }

    dealii::Tensor<1, 3>
    point(const double furthest)
    {
      std::uniform_real_distribution<double> uniform(-furthest, furthest);
      dealii::Tensor<1, 3> x;
      for (unsigned int d = 0; d < 3; ++d)
        x[d] = uniform(random);
      return x;
    }

    static Corners
    corners_of(const Segment &segment)
    {
      Corners corners;
      for (unsigned int k = 0; k < 4; ++k)
        corners[k] = components(segment[k]);
      return corners;
    }

    std::mt19937 random{5};
  };


  // Nearly so far from far away, zero in the segment.
  TEST(FaceBox, is_no_further_away_than_its_segment)
  {
    Squares squares;
    for (unsigned int i = 0; i < 1000; ++i)
      {
        const Segment segment = squares.make();
        const FaceBox<double> box(Squares::corners_of(segment));
        const auto x          = squares.point(4.);
        const double distance = project(x, segment).offset.norm();
        const double bound    = box.bound_of_distance(components(x));
        EXPECT_LE(bound, distance);
        EXPECT_GE(bound, distance - 0.8);
        EXPECT_EQ(bound, std::sqrt(box.bound_of_square(components(x))));
        EXPECT_EQ(box.bound_of_distance(components(middle_of(segment))), 0.);
      }
  }


  // One by one from lanes, those that are asked for alone.
  TEST(FaceBox, of_a_lane_is_that_of_its_segment)
  {
    Squares squares;
    std::vector<Segment> segments;
    alignas(lane_alignment) double values[n_lanes];
    std::array<FaceBox<Lanes>::Vector, 4> corners;
    for (unsigned int lane = 0; lane < n_lanes; ++lane)
      segments.push_back(squares.make());
    for (unsigned int k = 0; k < 4; ++k)
      for (unsigned int d = 0; d < 3; ++d)
        {
          for (unsigned int lane = 0; lane < n_lanes; ++lane)
            values[lane] = segments[lane][k][d];
          load(values, corners[k][d]);
        }
    std::vector<FaceBox<double>> boxes(n_lanes);
    boxes.back().area = -1.;
    FaceBox<Lanes>(corners).split(n_lanes - 1, boxes.data());
    EXPECT_EQ(boxes.back().area, -1.);
    for (unsigned int lane = 0; lane + 1 < n_lanes; ++lane)
      {
        const FaceBox<double> expected(Squares::corners_of(segments[lane]));
        EXPECT_NEAR(boxes[lane].area, expected.area, 1e-14);
        for (unsigned int d = 0; d < 3; ++d)
          {
            EXPECT_NEAR(boxes[lane].middle[d], expected.middle[d], 1e-14);
            EXPECT_NEAR(boxes[lane].half_lengths[d], expected.half_lengths[d], 1e-14);
            for (unsigned int i = 0; i < 3; ++i)
              EXPECT_NEAR(boxes[lane].edges[d][i], expected.edges[d][i], 1e-13);
          }
      }
  }
} // namespace face_box_test
