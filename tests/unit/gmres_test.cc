#include <akmon/contact/coupled/gmres.h>

#include <gtest/gtest.h>

// The linear solver of contact systems.

namespace gmres_test
{
  using namespace akmon;
  using Vector = dealii::Tensor<1, 3>;


  // A system that is not symmetric, against Cramer's rule for its two by two block.
  TEST(Gmres, solves_and_keeps_the_image)
  {
    using Field      = Gmres::Vector;
    const auto apply = [](const Field &p, Field &image, Field &y) {
      y[0]  = Vector({2. * p[0][0] + p[1][2], 3. * p[0][1], p[0][2]});
      y[1]  = Vector({p[1][0], 5. * p[1][1], p[1][2] - 4. * p[0][0]});
      image = y;
    };
    const Field r = {Vector({1., 6., 7.}), Vector({2., 10., 4.})};
    Field x(2), image(2);
    Gmres gmres;
    gmres.solve(
      apply, [](const Field &v, Field &z) { z = v; }, r, 1e-13, 6);
    gmres.combine(x, image);
    EXPECT_LE((x[0] - Vector({-0.5, 2., 7.})).norm(), 1e-12);
    EXPECT_LE((x[1] - Vector({2., 2., 2.})).norm(), 1e-12);
    for (unsigned int i = 0; i < 2; ++i)
      EXPECT_LE((image[i] - r[i]).norm(), 1e-12);
    // Of nothing, whatever was there before.
    gmres.solve(
      apply, [](const Field &v, Field &z) { z = v; }, Field(2), 1e-13, 6);
    gmres.combine(x, image);
    EXPECT_EQ(x[0], Vector());
    EXPECT_EQ(image[1], Vector());
  }
} // namespace gmres_test
