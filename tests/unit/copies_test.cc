#include <akmon/case.h>
#include <akmon/parameters.h>

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "support/run_case.h"

// Copies of a body: places, names, random shifts and turns, surfaces by the name of all, refused
// input.

namespace copies_test
{
  using namespace akmon;
  using namespace akmon::test;
  using Vector = dealii::Tensor<1, 3>;

  // The shipped pour with two small lattices.
  std::vector<Body>
  bodies(const std::vector<std::string> &overrides)
  {
    std::vector<std::string> all = {"Output directory=never_written"};
    for (const auto &entry : overrides)
      all.push_back("Bodies/ball/" + entry);
    return Case::read(shipped("poured_spheres"), all).bodies;
  }


  TEST(Copies, stand_on_a_lattice_first_along_x)
  {
    const auto all = bodies({"Position=1, 2, 3",
                             "Copies/Count=2, 1, 3",
                             "Copies/Spacing=0.5, 0, -1",
                             "Copies/Jitter=0",
                             "Copies/Turn=false"});
    ASSERT_EQ(all.size(), 6u);
    for (unsigned int i = 0; i < 6; ++i)
      {
        EXPECT_EQ(all[i].name, "ball." + std::to_string(i + 1));
        EXPECT_EQ(all[i].section_name(), "ball");
        EXPECT_TRUE(all[i].is_called("ball"));
        EXPECT_TRUE(all[i].is_called(all[i].name));
        EXPECT_FALSE(all[i].is_called("ball.7"));
        EXPECT_EQ(all[i].position, Vector({1. + 0.5 * (i % 2), 2., 3. - 1. * (i / 2)}));
        EXPECT_EQ(all[i].rotation, all[0].rotation);
      }
    const auto single = bodies({"Copies/Count=1, 1, 1"});
    ASSERT_EQ(single.size(), 1u);
    EXPECT_EQ(single[0].name, "ball");
  }


  TEST(Copies, are_shifted_and_turned_at_random_within_bounds)
  {
    const std::vector<std::string> keys = {"Position=0, 0, 0",
                                           "Copies/Count=10, 10, 10",
                                           "Copies/Spacing=1, 1, 1",
                                           "Copies/Jitter=0.1"};
    const auto all                      = bodies(keys);
    ASSERT_EQ(all.size(), 1000u);
    Vector mean, square;
    dealii::Tensor<2, 3> mean_rotation;
    for (unsigned int i = 0; i < all.size(); ++i)
      {
        const Vector shift = all[i].position -
                             Vector({1. * (i % 10), 1. * (i / 10 % 10), 1. * (i / 100)});
        for (unsigned int d = 0; d < 3; ++d)
          {
            EXPECT_LE(std::abs(shift[d]), 0.1);
            mean[d] += shift[d] / 1000.;
            square[d] += shift[d] * shift[d] / 1000.;
          }
        const auto &R = all[i].rotation;
        EXPECT_LE((transpose(R) * R - dealii::unit_symmetric_tensor<3>()).norm(), 1e-14);
        EXPECT_NEAR(determinant(R), 1., 1e-14);
        mean_rotation += R / 1000.;
      }
    // Uniform: variance 0.1^2/3, no direction before others.
    for (unsigned int d = 0; d < 3; ++d)
      {
        EXPECT_NEAR(mean[d], 0., 0.01);
        EXPECT_NEAR(square[d], 0.01 / 3., 3e-4);
      }
    EXPECT_LE(mean_rotation.norm(), 0.12);

    auto other = keys;
    other.push_back("Copies/Seed=2");
    const auto again = bodies(keys), different = bodies(other);
    EXPECT_EQ(again[77].position, all[77].position);
    EXPECT_EQ(again[77].rotation, all[77].rotation);
    EXPECT_NE(different[77].position, all[77].position);
  }


  TEST(Copies, have_a_part_of_all_of_them)
  {
    auto all             = bodies({"Copies/Count=2, 1, 1"});
    const auto materials = Case::read(shipped("poured_spheres"), {"Output directory=never_written"})
                             .materials;
    const Discretization model(all, materials, MPI_COMM_SELF);
    const auto of_all = model.boundary_ids("", "", "ball:surface"),
               first  = model.boundary_ids("", "", "ball.1:surface"),
               second = model.boundary_ids("", "", "ball.2:surface");
    EXPECT_EQ(of_all.size(), first.size() + second.size());
    for (const auto id : first)
      EXPECT_EQ(of_all.count(id) + second.count(id), 1u);
    EXPECT_EQ(model.faces_on(of_all).size(), 2 * 54u);
    EXPECT_EQ(model.body_index("", "", "ball.2"), 1u);
    EXPECT_THROW(model.body_index("", "", "ball"), InputError);
    EXPECT_THROW(model.boundary_ids("", "", "ball:top"), InputError);
    EXPECT_THROW(model.boundary_ids("", "", "bull:surface"), InputError);
  }


  std::string
  error_of(const std::vector<std::string> &overrides)
  {
    try
      {
        bodies(overrides);
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "no error";
  }


  TEST(Copies, that_cannot_be_are_refused)
  {
    EXPECT_NE(error_of({"Copies/Spacing=0.1, 0, 0.1"})
                .find("[Bodies/ball/Copies] Spacing = 0.1, 0, 0.1: "),
              std::string::npos);
    EXPECT_NE(error_of({"Copies/Count=1000, 1000, 2"}).find("allowed are up to 100000 copies"),
              std::string::npos);
    EXPECT_NE(error_of({"Copies/Count=0, 1, 1"}), "no error");
  }
} // namespace copies_test
