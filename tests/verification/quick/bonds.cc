#include <akmon/contact/bonds/bonds.h>
#include <akmon/output/history.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

#include "support/kept_run.h"
#include "support/report.h"
#include "support/run_directory.h"
#include "support/vtu.h"

// Tied contact on meshes that do not match.

namespace bonds
{
  using akmon::shortest_text;
  using namespace akmon::test;

  constexpr double E = 3.0e7, rho = 7.337e-4, h = 0.5, length = 20., area = 64.;
  const double c = std::sqrt(E / rho), dt = h / c;


  // Two bars of length 10 that lie against each other, 3 x 3 and 4 x 4 cells across.
  std::vector<std::string>
  tied_bars(const unsigned int n_steps, const std::string &solver = "coupled")
  {
    return {"Bodies/left/Position=-5, 0, 0",
            "Bodies/right/Position=5, 0, 0",
            "Bodies/left/Velocity=0, 0, 0",
            "Bodies/right/Velocity=0, 0, 0",
            "Bodies/left/Box/Size=10, 8, 8",
            "Bodies/right/Box/Size=10, 8, 8",
            "Bodies/left/Box/Cells=20, 3, 3",
            "Bodies/right/Box/Cells=20, 4, 4",
            "Contact/interface/Type=tied",
            "Contact solver/Type=" + solver,
            "Time/Step=" + shortest_text(dt),
            "Time/Allow unstable step=true",
            "Time/End=" + shortest_text(n_steps * dt)};
  }


  // A pressure p that acts from the beginning: u = p/(rho c) (t - x/c)+ and its reflection at the
  // free end, at nodes exactly what central differences give at a Courant number of one.
  TEST(TiedBars, pass_a_wave_as_one_bar)
  {
    constexpr double p = 1e3;
    auto overrides     = tied_bars(70);
    for (const char *const entry :
         {"Loads/Names=push",
          "Loads/push/Type=pressure",
          "Loads/push/Surfaces=left:x-",
          "Loads/push/Function=1e3",
          "Probes/Names=left_face, left_middle, left_end, right_face, right_middle, right_end",
          "Probes/left_face/Point=0, 4, 4",
          "Probes/right_face/Body=right",
          "Probes/right_face/Point=0, 0, 0",
          "Probes/right_middle/Body=right",
          "Probes/right_middle/Point=5, 4, 0",
          "Probes/right_end/Body=right",
          "Probes/right_end/Point=10, -4, 2"})
      overrides.push_back(entry);
    const Table history = run_case(shipped("two_bars"), overrides);
    const double v      = p / (rho * c);
    double worst = 0., aside = 0., momentum = 0.;
    for (std::size_t i = 0; i < history.n_rows(); ++i)
      {
        const double t = history["time"][i];
        for (const auto &[name, x] : {std::pair<std::string, double>{"left_face", 10.},
                                      {"right_face", 10.},
                                      {"right_middle", 15.},
                                      {"right_end", 20.}})
          {
            const double u = v *
                             (std::max(0., t - x / c) + std::max(0., t - (2. * length - x) / c));
            worst = std::max(worst,
                             std::abs(history[name + ".displacement_x"][i] - u) / (v * 70. * dt));
            for (const char *const axis : {"y", "z"})
              aside = std::max(aside,
                               std::abs(history[name + ".displacement_" + axis][i]) /
                                 (v * 70. * dt));
          }
        momentum = std::max(momentum,
                            std::abs(history["momentum_x"][i] - p * area * t) /
                              (p * area * 70. * dt));
      }
    report("displacement, error", worst);
    report("displacement aside", aside);
    report("momentum, error", momentum);
    report("bond energy", history["bond_energy"].back());
    EXPECT_LE(worst, 1e-9);
    EXPECT_LE(aside, 1e-9);
    EXPECT_LE(momentum, 1e-12);
    EXPECT_EQ(history["bond_energy"].back(), 0.);
    EXPECT_EQ(history["active_pairs"].back(), 0.);
  }


  // Thrown askew: momenta.
  class TiedBarsThrown : public testing::TestWithParam<const char *>
  {
  };


  TEST_P(TiedBarsThrown, keep_momenta)
  {
    auto overrides = tied_bars(120, GetParam());
    overrides.push_back("Time/Step=automatic");
    overrides.push_back("Bodies/left/Velocity=100, 20, -50");
    overrides.push_back("Bodies/right/Spin=300, 100, 0");
    const auto run       = run_and_keep(shipped("two_bars"), overrides);
    const double scale   = rho * 640. * 100.;
    const double linear  = change_of_momentum(run.history) / scale,
                 angular = change_of_momentum(run.history, "angular_momentum_") / (scale * length);
    report("change of momentum", linear);
    report("change of angular momentum", angular);
    EXPECT_LE(linear, 1e-12);
    EXPECT_LE(angular, 1e-12);
    for (const double error : run.history["energy_error"])
      EXPECT_LE(std::abs(error), 1e-3);
  }


  INSTANTIATE_TEST_SUITE_P(Solvers,
                           TiedBarsThrown,
                           testing::Values("coupled", "decoupled", "penalty"));


  // Bars that turn as one by 57 degrees, a thirtieth of a cell apart: the gap turns with them, and
  // forces across it have no moment.
  TEST(TiedBars, keep_angular_momentum_across_a_gap)
  {
    constexpr double gap = 0.09, spin = 1e3;
    auto overrides     = tied_bars(0);
    const auto speed   = shortest_text(spin * (5. + 0.5 * gap)),
               of_body = "/Spin=100, 0, " + shortest_text(spin);
    overrides.push_back("Bodies/left/Velocity=0, -" + speed + ", 0");
    overrides.push_back("Bodies/right/Velocity=0, " + speed + ", 0");
    overrides.push_back("Bodies/left" + of_body);
    overrides.push_back("Bodies/right" + of_body);
    overrides.push_back("Bodies/right/Position=" + shortest_text(5. + gap) + ", 0, 0");
    overrides.push_back("Time/Step=automatic");
    overrides.push_back("Time/End=" + shortest_text(1. / spin));
    overrides.push_back("Probes/Names=left_face, left_middle, left_end, right_face");
    overrides.push_back("Probes/left_face/Point=0, 4, 4"); // a corner
    overrides.push_back("Probes/right_face/Body=right");
    overrides.push_back("Probes/right_face/Point=" + shortest_text(gap) + ", 4, 4");
    const auto run       = run_and_keep(shipped("two_bars"), overrides);
    const double scale   = rho * 2. * 640. * spin * length * length / 12.,
                 angular = change_of_momentum(run.history, "angular_momentum_") / scale;
    double widest = 0., narrowest = gap;
    for (std::size_t i = 0; i < run.history.n_rows(); ++i)
      {
        double square = 0.;
        for (const char *const axis : {"x", "y", "z"})
          {
            const auto column  = std::string("_face.displacement_") + axis;
            const double apart = (*axis == 'x' ? gap : 0.) + run.history["right" + column][i] -
                                 run.history["left" + column][i];
            square += apart * apart;
          }
        widest    = std::max(widest, std::sqrt(square));
        narrowest = std::min(narrowest, std::sqrt(square));
      }
    report("change of angular momentum", angular);
    report("widest gap over the first", widest / gap);
    report("narrowest", narrowest / gap);
    EXPECT_LE(angular, 1e-12);
    EXPECT_LE(widest, 1.05 * gap);
    EXPECT_GE(narrowest, 0.95 * gap);
  }


  // Glue that gives way keeps them too: it opens and slides, and what is left of it turns.
  TEST(TiedBars, keep_momenta_while_glue_gives_way)
  {
    auto overrides = tied_bars(120);
    for (const char *const entry : {"Time/Step=automatic",
                                    "Bodies/left/Velocity=-100, 20, -50",
                                    "Bodies/right/Spin=300, 100, 0",
                                    "Contact/interface/Normal strength=1e3",
                                    "Contact/interface/Shear strength=1e3",
                                    "Contact/interface/Fracture energy=20"})
      overrides.push_back(entry);
    const auto run     = run_and_keep(shipped("two_bars"), overrides);
    const double scale = rho * 640. * 100., linear = change_of_momentum(run.history) / scale,
                 angular = change_of_momentum(run.history, "angular_momentum_") / (scale * length),
                 energy  = run.history["bond_energy"].back() / (20. * area);
    report("change of momentum", linear);
    report("change of angular momentum", angular);
    report("bond energy over G A", energy);
    EXPECT_LE(linear, 1e-12);
    EXPECT_LE(angular, 1e-12);
    EXPECT_GT(energy, 0.1);
    for (const double error : run.history["energy_error"])
      EXPECT_LE(std::abs(error), 1e-3);
  }


  // Bars that slide and press on each other when their bond gives way at once: in the same step
  // contact keeps them apart.
  TEST(TiedBars, do_not_enter_each_other_as_their_bond_breaks)
  {
    auto overrides = tied_bars(40);
    for (const char *const entry : {"Bodies/right/Box/Cells=20, 3, 3",
                                    "Time/Step=automatic",
                                    "Bodies/left/Velocity=100, 100, 0",
                                    "Contact/interface/Shear strength=10"})
      overrides.push_back(entry);
    const auto run           = run_and_keep(shipped("two_bars"), overrides);
    const double penetration = largest_of(run.history["max_penetration_rel"]);
    report("penetration over h", penetration);
    EXPECT_LE(penetration, 1e-9);
    EXPECT_EQ(run.history["bond_energy"].back(), 0.);
    EXPECT_GT(run.history["active_pairs"][1], 0.);
  }


  // The glue takes its fracture energy times its area, whatever the meshes and the waves do.
  TEST(LapJoint, takes_area_times_fracture_energy)
  {
    const auto run      = run_and_keep(shipped("lap_joint"));
    const auto &history = run.history;
    const double energy = history["bond_energy"].back();
    report("bond energy over G A", energy / 0.1);
    report("largest force", largest_of(history["glue.force_x"]));
    report("energy error", largest_of(history["energy_error"]));
    report("penetration over h", largest_of(history["max_penetration_rel"]));
    EXPECT_NEAR(energy, 0.1, 0.02 * 0.1);
    const auto bond = run.simulation->watch_contact().get_bonds().report(0);
    report("broken part", bond.broken_area / bond.area);
    EXPECT_NEAR(bond.area, 1e-4, 1e-12);
    EXPECT_NEAR(bond.energy, energy, 1e-9 * energy);
    EXPECT_EQ(bond.broken_area, bond.area);
    EXPECT_EQ(history["glue.force_x"].back(), 0.);
    EXPECT_LE(std::abs(largest_of(history["energy_error"])), 5e-3);
  }


  TEST(LapJoint, on_three_ranks_is_that_on_one)
  {
    const std::vector<std::string> overrides = {"Time/End=6e-5", "Output/History steps=20"};
    const Table one                          = run_case(shipped("lap_joint"), overrides),
                three = run_case_on_ranks(shipped("lap_joint"), 3, overrides);
    ASSERT_EQ(one.n_rows(), three.n_rows());
    EXPECT_GT(one["bond_energy"].back(), 1e-3);
    for (const char *const column : {"time", "bond_energy", "glue.force_x", "glue.force_z"})
      for (std::size_t i = 0; i < one.n_rows(); ++i)
        EXPECT_NEAR(one[column][i], three[column][i], 1e-9 * largest_of(one[column])) << column;
  }


  // The field `bond` of the files of a run, by initial place and body.
  using BondField = std::map<std::array<float, 4>, float>;

  std::vector<BondField>
  bond_fields(const unsigned int n_ranks)
  {
    const ScratchDirectory scratch;
    const auto result = run_program(arguments_for(shipped("lap_joint"),
                                                  scratch.path,
                                                  {"Output/Fields interval=1.25e-5",
                                                   "Output/Configuration=reference"}),
                                    n_ranks);
    EXPECT_EQ(result.status, 0) << result.output;
    std::vector<BondField> fields;
    for (const auto &file : field_files_in(scratch.path))
      {
        const std::string path = scratch.path + "/" + file;
        const auto places = field_of_vtu(path, "Points"), bond = field_of_vtu(path, "bond"),
                   body = field_of_vtu(path, "body");
        EXPECT_EQ(places.size(), 3 * bond.size());
        fields.emplace_back();
        for (std::size_t i = 0; i < bond.size(); ++i)
          fields.back()[{{places[3 * i], places[3 * i + 1], places[3 * i + 2], body[i]}}] = bond[i];
      }
    return fields;
  }


  // What is shown of the bonds: all of their strength on both glued surfaces at first, ends that
  // have parted before the middle, nothing at the end; the same whatever ranks wrote it.
  TEST(LapJoint, shows_what_is_left_of_its_bonds)
  {
    const auto fields   = bond_fields(1);
    const auto is_glued = [](const std::array<float, 4> &at) {
      return std::abs(at[2]) < 1e-7f && std::abs(at[0]) < 5.001e-3f;
    };
    const auto is_beside = [](const std::array<float, 4> &at) { // a face away
      return std::abs(at[2]) < 1e-7f && std::abs(at[0]) < 6.2e-3f;
    };
    ASSERT_EQ(fields.size(), 9u);
    std::array<unsigned int, 2> n_glued{};
    for (const auto &[at, bond] : fields.front())
      {
        const bool may_be_either = is_beside(at) && !is_glued(at);
        EXPECT_TRUE(may_be_either || bond == (is_glued(at) ? 1.f : 0.f))
          << at[0] << " " << at[1] << " " << at[2];
        n_glued[unsigned(at[3])] += is_glued(at);
      }
    EXPECT_EQ(n_glued[0], 9u * 7);
    EXPECT_EQ(n_glued[1], 11u * 9);
    for (const auto &[at, bond] : fields.back())
      EXPECT_EQ(bond, 0.f);
    float least = 1.f, most = 0.f;
    for (const auto &[at, bond] : fields[4])
      if (is_glued(at))
        {
          least = std::min(least, bond);
          most  = std::max(most, bond);
        }
    report("strength left at 50 microseconds, least", least);
    report("most", most);
    EXPECT_GT(least, 0.f);
    EXPECT_LT(least, 0.5f);
    EXPECT_GT(most, least + 0.1f);
    EXPECT_TRUE(bond_fields(3) == fields);
  }


  // Without fracture energy the bond is gone at once, and takes nothing.
  TEST(TiedBars, part_at_once_without_fracture_energy)
  {
    auto overrides = tied_bars(70);
    overrides.push_back("Bodies/left/Velocity=-10, 0, 0");
    overrides.push_back("Bodies/right/Velocity=10, 0, 0");
    overrides.push_back("Contact/interface/Normal strength=" + shortest_text(0.5 * rho * c * 10.));
    const Table history = run_case(shipped("two_bars"), overrides);
    EXPECT_EQ(history["bond_energy"].back(), 0.);
    EXPECT_EQ(history["interface.force_x"].back(), 0.);
    EXPECT_NEAR(history["left_face.velocity_x"].back(), -10., 1e-6);
  }
} // namespace bonds
