#include <akmon/contact/search/initial_overlap.h>
#include <akmon/parameters.h>

#include <gtest/gtest.h>

#include "support/run_case.h"

// Bodies in each other at the start: found wherever and however deep, and nothing that only
// touches.

namespace initial_overlap_test
{
  using namespace akmon;
  using namespace akmon::test;

  /// The two bars, 10 x 1 x 1 in 20 x 4 x 4 cells along x, changed by overrides.
  std::optional<BodyOverlap>
  overlap_of_bars(const std::vector<std::string> &overrides)
  {
    const Case parameters = Case::read(shipped("two_bars"), overrides);
    return find_deepest_overlap(
      Discretization(parameters.bodies, parameters.materials, MPI_COMM_SELF));
  }


  std::string
  left_at(const std::string &place)
  {
    return "Bodies/left/Position=" + place;
  }


  class NoOverlap : public testing::TestWithParam<std::vector<std::string>>
  {
  };


  TEST_P(NoOverlap, is_found)
  {
    const auto overlap = overlap_of_bars(GetParam());
    EXPECT_FALSE(overlap.has_value()) << "depth " << overlap->depth << " at " << overlap->place;
  }


  INSTANTIATE_TEST_SUITE_P(
    Cases,
    NoOverlap,
    testing::Values(
      // as shipped; the right bar begins at x = 0.01
      std::vector<std::string>{},
      // touching, within rounding, with other cells, along a side
      std::vector<std::string>{"Bodies/left/Position=-4.99, 0, 0"},
      std::vector<std::string>{"Bodies/left/Position=-4.98999999, 0, 0"},
      std::vector<std::string>{"Bodies/left/Position=-4.99, 0, 0", "Bodies/left/Box/Cells=7, 3, 5"},
      std::vector<std::string>{"Bodies/left/Position=5.01, 1, 0", "Bodies/right/Refinement=1"},
      // lying next to each other along a slanted face
      std::vector<std::string>{"Bodies/left/Position=-0.4133974596215561, 0.9160254037844386, 0",
                               "Bodies/left/Rotation angle=30",
                               "Bodies/right/Position=0, 0, 0",
                               "Bodies/right/Rotation angle=30",
                               "Bodies/left/Box/Size=1, 1, 1",
                               "Bodies/right/Box/Size=1, 1, 1"},
      // a ball in the bore of a tube, whose box it lies in
      std::vector<std::string>{"Bodies/left/Shape=sphere",
                               "Bodies/left/Sphere/Radius=0.9",
                               "Bodies/left/Position=0, 0, 1",
                               "Bodies/right/Shape=hollow cylinder",
                               "Bodies/right/Hollow cylinder/Inner radius=1",
                               "Bodies/right/Hollow cylinder/Outer radius=2",
                               "Bodies/right/Hollow cylinder/Length=2",
                               "Bodies/right/Position=0, 0, 0"}));


  TEST(InitialOverlap, of_shallow_contact)
  {
    const auto overlap = overlap_of_bars({left_at("-4.9899, 0, 0")});
    ASSERT_TRUE(overlap.has_value());
    EXPECT_NEAR(overlap->depth, 1e-4, 1e-12);
    EXPECT_NEAR(overlap->place[0], overlap->inside == 0 ? 0.0101 : 0.01, 1e-12);
  }


  // The bars have the same section: the deepest place is on the axis, half a width from the sides.
  TEST(InitialOverlap, of_a_bar_three_lengths_into_the_other)
  {
    const auto overlap = overlap_of_bars({left_at("-1.99, 0, 0")});
    ASSERT_TRUE(overlap.has_value());
    EXPECT_NEAR(overlap->depth, 0.5, 1e-12);
    EXPECT_NEAR(overlap->place[1], 0., 1e-12);
    EXPECT_NEAR(overlap->place[2], 0., 1e-12);
    EXPECT_GE(overlap->place[0], 0.01);
    EXPECT_LE(overlap->place[0], 3.01);
  }


  TEST(InitialOverlap, of_a_body_completely_inside)
  {
    const auto overlap = overlap_of_bars(
      {left_at("3.3, 0.125, 0"), "Bodies/left/Box/Size=0.5, 0.25, 0.25"});
    ASSERT_TRUE(overlap.has_value());
    EXPECT_EQ(overlap->inside, 0u);
    EXPECT_EQ(overlap->outside, 1u);
    EXPECT_NEAR(overlap->depth, 0.5, 1e-12);
    EXPECT_NEAR(overlap->place[1], 0., 1e-12);
  }


  TEST(InitialOverlap, of_bodies_in_the_same_place)
  {
    const auto overlap = overlap_of_bars({left_at("5.01, 0, 0")});
    ASSERT_TRUE(overlap.has_value());
    EXPECT_NEAR(overlap->depth, 0.25, 1e-12); // centre of a cell at an end
  }


  // A cross: no node of either body is in the other.
  TEST(InitialOverlap, of_crossing_single_cells)
  {
    const auto overlap = overlap_of_bars({left_at("5.01, 0, 0"),
                                          "Bodies/left/Rotation angle=90",
                                          "Bodies/left/Box/Cells=1, 1, 1",
                                          "Bodies/right/Box/Cells=1, 1, 1"});
    ASSERT_TRUE(overlap.has_value());
    EXPECT_NEAR(overlap->depth, 0.5, 1e-12);
  }


  TEST(InitialOverlap, of_a_turned_body)
  {
    // The edge of a unit cube turned by 45 degrees about z, 0.2 deep in the end face at x = 0.
    const auto overlap = overlap_of_bars({"Bodies/right/Position=5, 0, 0",
                                          left_at("-0.50710678118654755, 0, 0"),
                                          "Bodies/left/Rotation angle=45",
                                          "Bodies/left/Box/Size=1, 1, 1",
                                          "Bodies/left/Box/Cells=1, 1, 1"});
    ASSERT_TRUE(overlap.has_value());
    EXPECT_EQ(overlap->inside, 0u);
    EXPECT_NEAR(overlap->depth, 0.2, 1e-12);
    EXPECT_NEAR((overlap->place - dealii::Point<3>(0.2, 0., 0.)).norm(), 0., 1e-12);
  }


  TEST(InitialOverlap, of_a_ball_too_large_for_its_tube)
  {
    const auto overlap = overlap_of_bars({"Bodies/left/Shape=sphere",
                                          "Bodies/left/Sphere/Radius=1.2",
                                          "Bodies/left/Position=0, 0, 1",
                                          "Bodies/right/Shape=hollow cylinder",
                                          "Bodies/right/Hollow cylinder/Inner radius=1",
                                          "Bodies/right/Hollow cylinder/Outer radius=2",
                                          "Bodies/right/Hollow cylinder/Length=2",
                                          "Bodies/right/Position=0, 0, 0"});
    ASSERT_TRUE(overlap.has_value());
    EXPECT_EQ(overlap->inside, 0u);
    EXPECT_GT(overlap->depth, 0.15);
    EXPECT_LT(overlap->depth, 0.3);
  }


  TEST(InitialOverlap, is_refused_with_bodies_place_and_depth)
  {
    const Case parameters = Case::read(shipped("two_bars"), {left_at("-4.9, 0, 0")});
    const Discretization discretization(parameters.bodies, parameters.materials, MPI_COMM_SELF);
    try
      {
        refuse_body_overlap(discretization);
        FAIL();
      }
    catch (const InputError &error)
      {
        const std::string text = error.what();
        for (const char *const part : {"'left'", "'right'", "0.09 deep", "(0.1, "})
          EXPECT_NE(text.find(part), std::string::npos) << text;
      }
  }
} // namespace initial_overlap_test
