#include <akmon/contact/search/rank_regions.h>

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

namespace rank_regions_test
{
  using namespace akmon;
  using dealii::Tensor;
  using Ranks = std::vector<unsigned int>;

  RankRegions
  regions_of(const std::vector<std::pair<Tensor<1, 3>, unsigned int>> &points, const double margin)
  {
    RankRegions regions;
    for (const auto &[point, body] : points)
      regions.add(point, body);
    regions.exchange(margin, MPI_COMM_SELF);
    return regions;
  }


  Tensor<1, 3>
  at(const double x, const double y, const double z)
  {
    return Tensor<1, 3>({x, y, z});
  }


  TEST(RankRegions, ReachAsFarAsTheMargin)
  {
    auto regions = regions_of({{at(0, 0, 0), 3}, {at(1, 2, 0), 3}}, 0.5);
    EXPECT_EQ(regions.at(at(0.5, 1, 0)), Ranks({0}));
    EXPECT_EQ(regions.at(at(1.49, 2.49, -0.49)), Ranks({0}));
    EXPECT_TRUE(regions.at(at(1.51, 1, 0)).empty());
    EXPECT_TRUE(regions.at(at(0.5, 1, 0.51)).empty());
  }


  TEST(RankRegions, DoNotReachFromBodyToBody)
  {
    auto regions = regions_of({{at(0, 0, 0), 0}, {at(1, 1, 1), 0}, {at(9, 0, 0), 1}}, 0.5);
    EXPECT_EQ(regions.at(at(9, 0, 0)), Ranks({0}));
    EXPECT_TRUE(regions.at(at(5, 0, 0)).empty());
  }


  TEST(RankRegions, AreMadeOfPartsOfABody)
  {
    std::vector<std::pair<Tensor<1, 3>, unsigned int>> ring; // empty in its middle
    for (unsigned int i = 0; i < 640; ++i)
      ring.emplace_back(at(std::cos(0.01 * i), std::sin(0.01 * i), 0), 0);
    auto regions = regions_of(ring, 0.1);
    for (const auto &[point, body] : ring)
      EXPECT_EQ(regions.at(point), Ranks({0}));
    EXPECT_TRUE(regions.at(at(0, 0, 0)).empty());
  }


  TEST(RankRegions, OfNoPointsAreNowhere)
  {
    auto regions = regions_of({}, 1.);
    EXPECT_TRUE(regions.at(at(0, 0, 0)).empty());
  }
} // namespace rank_regions_test
