#include <gtest/gtest.h>

#include <cmath>

#include "support/kept_run.h"
#include "support/report.h"
#include "support/run_directory.h"

// contact.csv: forces, moments, areas, pressures and dissipation of every interface, against exact
// answers.

namespace interface_history
{
  using namespace akmon::test;

  // The contact.csv of a case, run on ranks.
  Table
  contact_rows(const std::string &name,
               const std::vector<std::string> &overrides,
               const unsigned int n_ranks = 1)
  {
    const ScratchDirectory scratch;
    const auto result = run_program(arguments_for(shipped(name), scratch.path, overrides), n_ranks);
    EXPECT_EQ(result.status, 0) << result.output;
    return Table(scratch.path + "/contact.csv");
  }


  // The contact patch test beside the origin: two unit blocks of unlike meshes, upright, between
  // their centres (3, 2, 0) a pressure of 1e-5 on an area of 1.
  const std::vector<std::string> patch_aside = {"Bodies/lower/Position=3, 2, -0.5",
                                                "Bodies/upper/Position=3, 2, 0.5",
                                                "Output/History steps=50"};


  TEST(InterfaceHistory, patch_force_is_pressure_times_area)
  {
    const double p = 1e-5;
    for (const std::string pass : {"symmetric", "single"})
      {
        std::cout << "  -- " << pass << std::endl;
        auto overrides = patch_aside;
        overrides.push_back("Contact/interface/Pass=" + pass);
        const Table rows = contact_rows("contact_patch", overrides);
        const double F   = rows["interface.normal_force_z"].back(); // on the lower block
        report("force over pressure times area, less 1", -F / p - 1.);
        report("area, less 1", rows["interface.area"].back() - 1.);
        report("largest pressure over p, less 1", rows["interface.max_pressure"].back() / p - 1.);
        EXPECT_NEAR(F, -p * rows["interface.area"].back(), 1e-6 * p);
        // Poisson's expansion of both sides of the face, nu p/E.
        EXPECT_NEAR(rows["interface.area"].back(),
                    1. + 2. * 0.3 * p,
                    pass == "symmetric" ? 1e-8 : 2e-6);
        for (const char *const axis : {"x", "y"})
          EXPECT_NEAR(rows[std::string("interface.normal_force_") + axis].back(), 0., 1e-6 * p);
        // M = x (arm) F: (y F_z, -x F_z, 0).
        // Not uniform in a single pass, with an arm that is off.
        const double off = pass == "symmetric" ? 1e-5 : 1e-3;
        EXPECT_NEAR(rows["interface.moment_x"].back(), 2. * F, off * p);
        EXPECT_NEAR(rows["interface.moment_y"].back(), -3. * F, off * p);
        EXPECT_NEAR(rows["interface.moment_z"].back(), 0., 1e-6 * p);
        EXPECT_EQ(rows["interface.sticking_pairs"].back(), 0.);
        EXPECT_EQ(rows["interface.slipping_pairs"].back(), pass == "single" ? 16. : 16. + 25.);
        if (pass == "symmetric")
          EXPECT_NEAR(rows["interface.max_pressure"].back(), p, 1e-4 * p);
        else
          EXPECT_GT(rows["interface.max_pressure"].back(), 1.05 * p);
      }
  }


  TEST(InterfaceHistory, sliding_block_loses_its_energy_to_friction)
  {
    const double mu = 0.3, mass = 500., g = 9.81;
    const Table rows  = contact_rows("sliding_block", {});
    const auto &time  = rows["time"];
    const auto energy = 0.5 * mass * 25.;
    report("friction dissipation over the energy",
           rows["ground.friction_dissipation"].back() / energy);
    EXPECT_NEAR(rows["ground.friction_dissipation"].back(), energy, 1e-3 * energy);
    double of_area = 0., of_cone = 0., impulse = 0., work = 0.;
    for (std::size_t i = 1; i < rows.n_rows() && time[i] < 1.69; ++i)
      {
        const double N = rows["ground.normal_force_z"][i], F = rows["ground.friction_force_x"][i];
        of_cone = std::max(of_cone, std::abs(F + mu * N) / (mass * g));
        EXPECT_EQ(rows["ground.sticking_pairs"][i], 0.);
        if (rows["ground.slipping_pairs"][i] == 10.)
          of_area = std::max(of_area, std::abs(rows["ground.area"][i] - 1.));
        impulse += N * (time[i] - time[i - 1]);
        // mu N s until then, with s = v0 t - mu g t^2/2
        const double s = 5. * time[i] - 0.5 * mu * g * time[i] * time[i];
        work           = std::max(work,
                        std::abs(rows["ground.friction_dissipation"][i] - mu * mass * g * s) /
                          energy);
      }
    report("F - mu N over the weight", of_cone);
    report("area with all nodes down, less 1", of_area);
    report("dissipation off mu N s, over the energy", work);
    EXPECT_LE(of_cone, 1e-12);
    EXPECT_LE(of_area, 1e-4);
    EXPECT_LE(work, 1e-3);
    EXPECT_NEAR(impulse, mass * g * 1.69, 0.01 * mass * g * 1.69);
  }


  TEST(InterfaceHistory, interfaces_add_up_to_the_history)
  {
    const auto run = run_and_keep(shipped("newtons_cradle"), {"Time/End=1.5e-4"});
    EXPECT_GT(run.history["impact_dissipation"].back(), 0.);
    const ScratchDirectory scratch;
    const auto result = run_program(
      arguments_for(shipped("newtons_cradle"), scratch.path, {"Time/End=1.5e-4"}));
    ASSERT_EQ(result.status, 0) << result.output;
    const Table history(scratch.path + "/history.csv"), rows(scratch.path + "/contact.csv");
    ASSERT_EQ(rows["time"], history["time"]);
    unsigned int n = 0;
    for (std::size_t i = 0; i < rows.n_rows(); ++i)
      {
        double impact = 0., pairs = 0., penetration = 0.;
        for (const auto &column : rows.columns())
          {
            const std::string name = column.substr(0, column.find('.'));
            if (column == name + ".impact_dissipation")
              impact += rows[column][i];
            if (column == name + ".slipping_pairs")
              pairs += rows[column][i];
            if (column == name + ".max_penetration")
              penetration = std::max(penetration, rows[column][i]);
            if (column == name + ".normal_force_x")
              {
                EXPECT_EQ(rows[column][i], history[name + ".force_x"][i]);
                ++n;
              }
          }
        EXPECT_NEAR(impact, history["impact_dissipation"][i], 1e-12 * history["kinetic_energy"][0]);
        EXPECT_EQ(pairs, history["active_pairs"][i]);
        EXPECT_EQ(penetration, history["max_penetration"][i]);
      }
    EXPECT_EQ(n, 4 * rows.n_rows());
  }


  TEST(InterfaceHistory, is_the_same_on_two_ranks)
  {
    const std::vector<std::string> overrides = {"Time/End=6e-5",
                                                "Contact/interface/Friction coefficient=0.3",
                                                "Bodies/left/Box/Cells=10, 3, 3",
                                                "Bodies/right/Box/Cells=10, 4, 4"};
    const Table one                          = contact_rows("two_bars", overrides),
                two                          = contact_rows("two_bars", overrides, 2);
    ASSERT_EQ(one.columns(), two.columns());
    ASSERT_EQ(one.n_rows(), two.n_rows());
    for (const auto &column : one.columns())
      {
        const double scale = std::max(largest_of(one[column]), 1e-9 * 29998.604);
        for (std::size_t i = 0; i < one.n_rows(); ++i)
          EXPECT_NEAR(one[column][i], two[column][i], 1e-8 * scale) << column << " in row " << i;
      }
    EXPECT_NEAR(one["interface.area"].back(), 1., 1e-3);
  }
} // namespace interface_history
