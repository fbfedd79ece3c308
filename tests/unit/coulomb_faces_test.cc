#include <akmon/contact/coupled/coulomb_faces.h>

#include <gtest/gtest.h>

// The faces of Coulomb's cone.

namespace coulomb_faces_test
{
  using namespace akmon;
  using Vector = dealii::Tensor<1, 3>;


  TEST(CoulombFace, projects)
  {
    EXPECT_LE((CoulombFace::project(Vector({2., 6., 8.}), 5.) - Vector({2., 3., 4.})).norm(),
              1e-15);
    EXPECT_EQ(CoulombFace::project(Vector({-3., 1., 2.}), 5.), Vector({0., 1., 2.}));
    EXPECT_EQ(CoulombFace::project(Vector({3., 1., 2.}), 0.), Vector({3., 0., 0.}));
  }


  TEST(CoulombFace, is_told_by_the_predictor)
  {
    using Tangential = CoulombFace::Tangential;
    const Vector v({3., 1., 2.});

    const auto open = CoulombFace::predicted_by(Vector({-1., 3., 4.}), 0., 0.5, 1.);
    EXPECT_FALSE(open.normal);
    EXPECT_EQ(open.restrict_to(v), Vector());
    EXPECT_EQ(open.settle(v, 1.5), Vector());

    const auto smooth = CoulombFace::predicted_by(Vector({1., 3., 4.}), 0., 0., 1.);
    EXPECT_EQ(smooth.tangential, Tangential::none);
    EXPECT_EQ(smooth.restrict_to(v), Vector({3., 0., 0.}));
    EXPECT_EQ(smooth.settle(v, 0.), Vector({3., 0., 0.}));

    const auto stick = CoulombFace::predicted_by(Vector({11., 3., 4.}), 5.5, 0.5, 1.);
    EXPECT_EQ(stick.tangential, Tangential::disc);
    EXPECT_EQ(stick.restrict_to(v), v);
    EXPECT_EQ(stick.settle(v, 1.5), v);
    EXPECT_EQ(stick.lift(v), v);

    // Slip along (3, 4)/5, with a limit of 2 that 5 exceeds by 1.5 times the limit.
    const auto slip = CoulombFace::predicted_by(Vector({4., 3., 4.}), 2., 0.5, 2.);
    EXPECT_EQ(slip.tangential, Tangential::circle);
    EXPECT_NEAR(slip.curvature, 1.5 / 2., 1e-15);
    EXPECT_LE((slip.along - Vector({0., -0.8, 0.6})).norm(), 1e-15);
    EXPECT_LE((slip.restrict_to(v) - Vector({3., -0.32, 0.24})).norm(), 1e-15);
    EXPECT_LE((slip.settle(v, 1.5) - Vector({3., 0.9, 1.2})).norm(), 1e-15);
    EXPECT_LE((slip.lift(Vector({2., -0.8, 0.6})) - Vector({2., -0.2, 1.4})).norm(), 1e-15);
  }
} // namespace coulomb_faces_test
