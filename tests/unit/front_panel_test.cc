#include <akmon/contact/coupled/front_panel.h>

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "support/report.h"

// Products and small factors of panels against Eigen's.

namespace front_panel_test
{
  using namespace akmon;
  using akmon::test::report;

  // A matrix whose columns have room for whole Lanes, with zeros there.
  struct Stored
  {
    explicit Stored(const Eigen::MatrixXd &matrix)
      : rows(matrix.rows())
      , values(Eigen::MatrixXd::Zero(matrix.rows() + Lanes::size, matrix.cols()))
    {
      values.topRows(rows) = matrix;
    }

    Panel
    panel()
    {
      return {values.data(), static_cast<std::size_t>(values.rows())};
    }

    Eigen::MatrixXd
    matrix() const
    {
      return values.topRows(rows);
    }

    Eigen::Index rows;
    Eigen::MatrixXd values;
  };


  TEST(FrontPanel, subtracts_products)
  {
    double largest = 0.;
    for (const int n_rows : {1, 7, 8, 9, 24, 25, 61})
      for (const int depth : {1, 3, 24})
        for (const int n_columns : {1, 2, 3, 6, 7, 17})
          {
            const Eigen::MatrixXd A = Eigen::MatrixXd::Random(n_rows, depth),
                                  B = Eigen::MatrixXd::Random(depth, n_columns),
                                  C = Eigen::MatrixXd::Random(n_rows, n_columns);
            Stored of_A(A), of_B(B), of_C(C), of_column(C.col(0));
            subtract_product(of_A.panel(), of_B.panel(), of_C.panel(), n_rows, depth, n_columns);
            subtract_product(of_A.panel(),
                             &of_B.panel()(0, 0),
                             &of_column.panel()(0, 0),
                             n_rows,
                             depth);
            largest = std::max(largest, (of_C.matrix() - (C - A * B)).cwiseAbs().maxCoeff());
            largest = std::max(largest,
                               (of_column.matrix() - (C - A * B).col(0)).cwiseAbs().maxCoeff());
            EXPECT_EQ(of_C.values.bottomRows(Lanes::size).norm(), 0.);
          }
    report("largest error", largest);
    EXPECT_LT(largest, 1e-14);
  }


  TEST(FrontPanel, inverts_factors)
  {
    double largest = 0.;
    for (std::size_t n = 1; n <= max_panel; ++n)
      {
        const Eigen::MatrixXd A = Eigen::MatrixXd::Random(n, n) +
                                  4. * Eigen::MatrixXd::Identity(n, n);
        Stored of_A(A), of_L(A), of_U(A);
        ASSERT_TRUE(invert_factors(of_A.panel(), n, of_L.panel(), of_U.panel()));
        const Eigen::MatrixXd L = of_L.matrix(), U = of_U.matrix();
        EXPECT_TRUE(L.isLowerTriangular(0.));
        EXPECT_TRUE(U.isUpperTriangular(0.));
        largest = std::max(largest, (U * L - A.inverse()).cwiseAbs().maxCoeff());
      }
    report("largest error", largest);
    EXPECT_LT(largest, 1e-14);
  }


  TEST(FrontPanel, tells_of_pivots_that_are_none)
  {
    Eigen::MatrixXd A = Eigen::MatrixXd::Identity(5, 5);
    A.row(3)          = A.row(1);
    Stored of_A(A), of_L(A), of_U(A);
    EXPECT_FALSE(invert_factors(of_A.panel(), 5, of_L.panel(), of_U.panel()));
    A(0, 0) = std::nan("");
    Stored undefined(A);
    EXPECT_FALSE(invert_factors(undefined.panel(), 5, of_L.panel(), of_U.panel()));
  }
} // namespace front_panel_test
