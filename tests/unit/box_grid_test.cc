#include <akmon/contact/search/box_grid.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

// The boxes that hold a point, against asking all of them.

namespace box_grid_test
{
  using akmon::Box;
  using akmon::BoxGrid;
  using Vector = dealii::Tensor<1, 3>;

  bool
  holds(const Box &box, const Vector &x)
  {
    for (unsigned int d = 0; d < 3; ++d)
      if (!(box.lower[d] <= x[d] && x[d] <= box.upper[d]))
        return false;
    return true;
  }


  std::vector<unsigned int>
  holding(const std::vector<Box> &boxes, const Vector &x)
  {
    std::vector<unsigned int> numbers;
    for (unsigned int i = 0; i < boxes.size(); ++i)
      if (holds(boxes[i], x))
        numbers.push_back(i);
    return numbers;
  }


  struct Cloud
  {
    // Boxes of sizes up to `size` in the unit cube and in another one far away.
    Cloud(const unsigned int n, const double size)
    {
      std::uniform_real_distribution<double> uniform;
      for (unsigned int i = 0; i < n; ++i)
        {
          Box box;
          for (unsigned int d = 0; d < 3; ++d)
            {
              box.lower[d] = uniform(random) - 0.5 + (i % 2 ? 1000. : 0.);
              box.upper[d] = box.lower[d] + size * uniform(random);
            }
          boxes.push_back(box);
        }
    }

    void
    expect_all_found()
    {
      BoxGrid grid;
      grid.reinit(boxes);
      std::uniform_real_distribution<double> uniform(-0.6, 0.8);
      std::size_t n_found = 0;
      for (unsigned int i = 0; i < 2000; ++i)
        {
          Vector x;
          for (unsigned int d = 0; d < 3; ++d)
            x[d] = uniform(random) + (i % 2 ? 1000. : 0.);
          std::vector<unsigned int> numbers = {7}; // is left alone
          grid.collect(x, numbers);
          auto expected = holding(boxes, x);
          n_found += expected.size();
          expected.insert(expected.begin(), 7);
          EXPECT_EQ(numbers, expected);
        }
      EXPECT_GT(n_found, 100u);
    }

    std::mt19937 random{3};
    std::vector<Box> boxes;
  };


  TEST(BoxGrid, finds_all_boxes_that_hold_a_point)
  {
    Cloud(500, 0.2).expect_all_found();
  }


  TEST(BoxGrid, finds_large_boxes_among_small_ones)
  {
    Cloud cloud(500, 0.1);
    for (const double size : {0.5, 1., 1e4})
      cloud.boxes.push_back({Vector({-size, -size, -size}), Vector({size, size, size})});
    cloud.expect_all_found();
  }


  TEST(BoxGrid, bears_no_boxes_and_what_a_failing_run_leads_to)
  {
    BoxGrid grid;
    std::vector<unsigned int> numbers;
    grid.reinit({});
    grid.collect(Vector(), numbers);
    EXPECT_TRUE(numbers.empty());

    const double nan = std::numeric_limits<double>::quiet_NaN(), huge = 1e300;
    grid.reinit({{Vector({nan, 0., 0.}), Vector({1., 1., 1.})},
                 {Vector({-huge, 0., 0.}), Vector({huge, 1., 1.})},
                 {Vector({huge, 0., 0.}), Vector({huge, 1., 1.})},
                 {Vector(), Vector()}});
    grid.collect(Vector(), numbers);
    EXPECT_EQ(numbers, (std::vector<unsigned int>{1, 3}));
    grid.collect(Vector({nan, nan, nan}), numbers);
    EXPECT_EQ(numbers.size(), 2u);
  }
} // namespace box_grid_test
