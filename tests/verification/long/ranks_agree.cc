#include <akmon/output/history.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/run_case.h"

// Histories of the short shipped cases on 1, 2 and 3 ranks: the motion and the contact force of
// every node come out with the same bits; sums over ranks (energies, momenta) agree to round-off.

namespace ranks_agree
{
  using namespace akmon::test;

  constexpr double accuracy = 1e-10;


  struct ShippedCase
  {
    const char *name;
    double momentum; ///< sum m |v_0|
    double length;   ///< of the longest bar
    double cell_size;
    const char *force;                  ///< column of a contact force, empty without contact
    std::vector<std::string> overrides; ///< shorter runs where a part of the run tells
  };


  void
  PrintTo(const ShippedCase &shipped_case, std::ostream *out)
  {
    *out << shipped_case.name;
  }


  bool
  starts_with(const std::string &text, const std::string &start)
  {
    return text.compare(0, start.size(), start) == 0;
  }


  bool
  ends_with(const std::string &text, const std::string &end)
  {
    return text.size() >= end.size() &&
           text.compare(text.size() - end.size(), end.size(), end) == 0;
  }


  double
  largest(const std::vector<double> &values)
  {
    double result = 0.;
    for (const double value : values)
      result = std::max(result, std::abs(value));
    return result;
  }


  // What a column's differences are compared with: the largest magnitude of the vector or tensor
  // that it is a component of, or the physical scale of sums that vanish.
  double
  scale(const Table &history, const std::string &column, const ShippedCase &shipped_case)
  {
    if (ends_with(column, "_energy") || ends_with(column, "_dissipation") ||
        column == "external_work")
      return history["kinetic_energy"][0];
    if (column == "energy_error" || column == "max_penetration_rel")
      return 1.;
    if (starts_with(column, "momentum_"))
      return shipped_case.momentum;
    if (starts_with(column, "angular_momentum_"))
      return shipped_case.momentum * shipped_case.length;
    if (column == "max_penetration")
      return shipped_case.cell_size;
    if (column.find('.') == std::string::npos)
      return largest(history[column]);
    const std::string quantity = column.substr(0, column.rfind('_') + 1);
    double result              = 0.;
    for (const auto &other : history.columns())
      if (starts_with(other, quantity))
        result = std::max(result, largest(history[other]));
    return result;
  }


  // All columns but the sums over cells, nodes and pairs of all ranks: energies, momenta and
  // forces.
  bool
  of_motion(const std::string &column)
  {
    if (column.find(".force_") != std::string::npos)
      return false;
    return column == "time" || column == "dt" || starts_with(column, "max_penetration") ||
           ends_with(column, "_pairs") || column.find('.') != std::string::npos;
  }


  class RanksAgree : public testing::TestWithParam<ShippedCase>
  {
  };


  TEST_P(RanksAgree, to_the_bit_in_motion_and_to_round_off_in_sums)
  {
    const auto &overrides   = GetParam().overrides;
    const std::string force = GetParam().force;
    const Table one         = run_case_on_ranks(shipped(GetParam().name), 1, overrides);
    ASSERT_TRUE(force.empty() || largest(one[force]) > 0.);
    for (const unsigned int n_ranks : {2u, 3u})
      {
        const Table several = run_case_on_ranks(shipped(GetParam().name), n_ranks, overrides);
        ASSERT_EQ(several.columns(), one.columns());
        ASSERT_EQ(several.n_rows(), one.n_rows());

        unsigned int identical = 0;
        double worst           = 0.;
        for (const auto &column : one.columns())
          {
            const auto &a = one[column], &b = several[column];
            identical += a == b;
            double difference     = 0.;
            std::size_t first_row = a.size();
            for (std::size_t i = 0; i < a.size(); ++i)
              if (a[i] != b[i])
                {
                  first_row  = std::min(first_row, i);
                  difference = std::max(difference, std::abs(a[i] - b[i]));
                }
            if (first_row == a.size())
              continue;
            const double relative = difference / scale(one, column, GetParam());
            EXPECT_LE(relative, accuracy) << column << " on " << n_ranks << " ranks";
            worst = std::max(worst, relative);

            // History has the shortest text that reads back as the same number.
            if (of_motion(column))
              {
                ADD_FAILURE() << column << " on " << n_ranks << " ranks has other bits from row "
                              << first_row << " on, by " << relative;
              }
          }
        const std::string ranks = std::to_string(n_ranks) + "_ranks_";
        RecordProperty(ranks + "identical_columns", int(identical));
        RecordProperty(ranks + "columns", int(one.columns().size()));
        RecordProperty(ranks + "worst", akmon::shortest_text(worst));
      }
  }


  INSTANTIATE_TEST_SUITE_P(
    Shipped,
    RanksAgree,
    testing::Values(
      ShippedCase{"two_bars", 2 * 7.337e-3 * 202.2, 10., 0.25, "interface.force_x", {}},
      ShippedCase{"two_bars_rotated", 2 * 7.337e-3 * 202.2, 10., 0.25, "interface.force_x", {}},
      ShippedCase{"bars_unequal_length", 3 * 7.337e-3 * 202.2, 20., 0.1, "interface.force_x", {}},
      ShippedCase{"bars_impedance", 7.337e-3 * 202.2, 10., 0.1, "interface.force_x", {}},
      ShippedCase{"rigid_base_bar", 7.84e5, 0.8, 0.05, "base.force_z", {}},
      ShippedCase{"taylor_bar_quarter", 0.53, 0.0324, 8e-4, "wall.force_z", {"Time/End=1e-5"}},
      ShippedCase{"sliding_block", 2500., 1., 0.25, "ground.force_z", {"Time/End=0.1"}},
      // More ranks than cells, and no contact.
      ShippedCase{"one_cell", 1., 1., 1., "", {}}),
    [](const auto &info) { return std::string(info.param.name); });
} // namespace ranks_agree
