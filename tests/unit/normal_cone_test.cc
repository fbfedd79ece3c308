#include <akmon/contact/search/normal_cone.h>

#include <gtest/gtest.h>

namespace normal_cone_test
{
  using namespace akmon;
  using Vector = NormalCone::Vector;

  NormalCone
  cone_of(const std::vector<Vector> &normals)
  {
    NormalCone cone;
    for (const Vector &normal : normals)
      cone.push_back(normal / normal.norm());
    return cone;
  }


  const Vector x({1., 0., 0.}), y({0., 1., 0.}), z({0., 0., 1.});


  TEST(NormalCone, gives_what_is_inside_back)
  {
    const Vector v({.6, .1, .3});
    EXPECT_LT((cone_of({x, y, z}).closest_to(v) - v).norm(), 1e-12);
    const Vector of_edge({.6, 0., .3});
    EXPECT_LT((cone_of({x, z}).closest_to(of_edge) - of_edge).norm(), 1e-12);
  }


  // Of bodies that lie flat on each other: the side of the edge has no part in it.
  TEST(NormalCone, takes_others_to_its_border)
  {
    EXPECT_LT((cone_of({x, z}).closest_to(Vector({-.7, 0., .7})) - .7 * z).norm(), 1e-12);
    EXPECT_LT((cone_of({x, y, z}).closest_to(Vector({-.6, -.6, .6})) - .6 * z).norm(), 1e-12);
    EXPECT_LT((cone_of({x, y, z}).closest_to(Vector({-.6, .5, .6})) - (.5 * y + .6 * z)).norm(),
              1e-12);
    EXPECT_EQ(cone_of({x, z}).closest_to(Vector({-1., 0., -1.})).norm(), 0.);
  }


  // By the condition that tells the closest vector c of a cone: (v - c) . c = 0, and
  // (v - c) . n_i <= 0 for all i.
  TEST(NormalCone, finds_the_closest_vector_of_oblique_cones)
  {
    const auto cone = cone_of(
      {Vector({1., .2, .1}), Vector({.9, -.3, .4}), Vector({.2, .1, 1.}), Vector({.5, .8, .2})});
    for (const Vector v : {Vector({.1, .9, -.4}), Vector({-.5, .2, .8}), Vector({1., -1., .2})})
      {
        const Vector c = cone.closest_to(v);
        EXPECT_NEAR((v - c) * c, 0., 1e-10);
        for (const Vector &normal : cone)
          EXPECT_LE((v - c) * normal, 1e-10);
      }
  }


  TEST(NormalCone, counts_faces_of_a_smooth_side_once)
  {
    const auto cone = cone_of(
      {Vector({0., .1, 1.}), x, Vector({0., -.1, 1.}), Vector({1., .1, 0.})});
    const auto sides = cone.sides();
    ASSERT_EQ(sides.size(), 2u);
    EXPECT_LT((*sides.begin() - z).norm(), 1e-12);
    EXPECT_TRUE(cone.turn_sharply((x + z) / std::sqrt(2.)));
    EXPECT_FALSE(cone_of({Vector({0., .1, 1.}), Vector({0., -.1, 1.})}).turn_sharply(z));
  }
} // namespace normal_cone_test
