#include <akmon/contact/reproducible_sums.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

// Sums that do not depend on the order of their addends.

namespace reproducible_sums_test
{
  using namespace akmon;

  // Addends of all magnitudes that nearly cancel, against a sum in twice the precision.
  TEST(ReproducibleSums, have_the_same_bits_in_any_order_and_are_exact_to_round_off)
  {
    std::mt19937 random(3);
    std::vector<double> addends;
    for (unsigned int i = 0; i < 2000; ++i)
      {
        const double a = std::ldexp(std::uniform_real_distribution<double>(-1., 1.)(random),
                                    -int(random() % 40));
        addends.push_back(a);
        addends.push_back(-a * (1. + 1e-9));
      }
    const auto sum = [](const std::vector<double> &values) {
      return reproducible_sums({values, {1., 2.}}, MPI_COMM_SELF)[0];
    };
    long double exact = 0;
    double naive      = 0.;
    for (const double a : addends)
      exact += a;
    const double reference = sum(addends);
    EXPECT_NEAR(reference, double(exact), 4000. * std::ldexp(1., -63));
    unsigned int n_naive = 0;
    for (unsigned int round = 0; round < 20; ++round)
      {
        std::shuffle(addends.begin(), addends.end(), random);
        EXPECT_EQ(sum(addends), reference);
        double in_turn = 0.;
        for (const double a : addends)
          in_turn += a;
        n_naive += round > 0 && in_turn != naive;
        naive = in_turn;
      }
    EXPECT_GT(n_naive, 0u); // what this is for
  }


  TEST(ReproducibleSums, of_nothing_and_of_what_is_no_number)
  {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const auto sums           = reproducible_sums(
      {{}, {0., 0.}, {1e-310, 2e-310}, {1., NAN}, {NAN}, {infinity, 1.}, {1e300, 2e300}},
      MPI_COMM_SELF);
    EXPECT_EQ(sums[0], 0.);
    EXPECT_EQ(sums[1], 0.);
    EXPECT_NEAR(sums[2], 3e-310, 1e-290);
    EXPECT_TRUE(std::isnan(sums[3]));
    EXPECT_TRUE(std::isnan(sums[4]));
    EXPECT_EQ(sums[5], infinity);
    EXPECT_EQ(sums[6], 3e300);
  }
} // namespace reproducible_sums_test
