#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/report.h"
#include "support/run_case.h"

// Friction with the coupled solver: on a rigid plane it must move a block as the decoupled solution
// does (no pair shares a node with another one); an oblique landing; an elastic layer that hits a
// plane obliquely, where one-dimensional waves are exact; and bars of
// non-matching meshes that rub each other.

namespace coupled_friction
{
  using namespace akmon::test;

  const std::string decoupled = "Contact solver/Type=decoupled";


  double
  largest(const std::vector<double> &values)
  {
    double result = 0.;
    for (const double value : values)
      result = std::max(result, std::abs(value));
    return result;
  }


  double
  largest(const std::vector<double> &values, const std::vector<std::size_t> &rows)
  {
    double result = 0.;
    for (const std::size_t i : rows)
      result = std::max(result, std::abs(values[i]));
    return result;
  }


  double
  mean(const std::vector<double> &values, const std::vector<std::size_t> &rows)
  {
    double sum = 0.;
    for (const std::size_t i : rows)
      sum += values[i] / rows.size();
    return sum;
  }


  // Friction never gives.
  void
  expect_dissipation(const Table &history)
  {
    const auto &work    = history["friction_dissipation"];
    const double energy = *std::max_element(history["kinetic_energy"].begin(),
                                            history["kinetic_energy"].end());
    for (std::size_t i = 1; i < work.size(); ++i)
      EXPECT_GE(work[i] - work[i - 1], -1e-12 * energy) << "row " << i;
  }


  struct Motion
  {
    const char *name, *file;
    std::vector<std::string> overrides;
  };


  void
  PrintTo(const Motion &motion, std::ostream *out)
  {
    *out << motion.name;
  }


  class OnAPlane : public testing::TestWithParam<Motion>
  {
  };


  TEST_P(OnAPlane, coupled_and_decoupled_move_alike)
  {
    const auto [name, file, overrides] = GetParam();
    auto with_decoupled                = overrides;
    with_decoupled.push_back(decoupled);
    const Table one = run_case(shipped(file), overrides);
    const Table two = run_case(shipped(file), with_decoupled);
    ASSERT_EQ(one.n_rows(), two.n_rows());
    const double speed    = largest(two["momentum_x"]) / 500.;
    const double distance = largest(two["corner.displacement_x"]);
    double momentum = 0., way = 0.;
    for (std::size_t i = 0; i < one.n_rows(); ++i)
      {
        momentum = std::max(momentum, std::abs(one["momentum_x"][i] - two["momentum_x"][i]));
        way      = std::max(way,
                       std::abs(one["corner.displacement_x"][i] - two["corner.displacement_x"][i]));
      }
    report("difference of velocity, relative", momentum / 500. / speed);
    report("difference of position, relative", way / distance);
    EXPECT_LE(momentum / 500., 1e-9 * speed);
    EXPECT_LE(way, 1e-9 * distance);
    EXPECT_LE(largest(one["max_penetration_rel"]), 1e-12);
    expect_dissipation(one);
    expect_dissipation(two);
  }


  // The bouncing block is compared over its first impact: later ones are chaotic (2e-16 of height
  // more is 0.05 of velocity at 0.5).
  const std::string gentle = "Body force/Acceleration=9.81*sin(20*pi/180); 0; -9.81*cos(20*pi/180)";

  INSTANTIATE_TEST_SUITE_P(Blocks,
                           OnAPlane,
                           testing::Values(Motion{"flat", "sliding_block", {}},
                                           Motion{"steep", "slope_block", {}},
                                           Motion{"gentle",
                                                  "slope_block",
                                                  {gentle,
                                                   "Obstacles/ground/Friction coefficient=0.5",
                                                   "Bodies/block/Velocity=3, 0, 0",
                                                   "Time/End=3"}},
                                           Motion{"bouncing",
                                                  "sliding_block",
                                                  {"Bodies/block/Position=0, 0, 0.3",
                                                   "Time/End=0.2"}}));


  TEST(ObliqueLanding, of_a_block_slides_by_coulomb_and_then_rests)
  {
    // No weight: it lands at (5, 0, -1), slides as long as its nodes touch, mu = 0.3.
    const double mu = 0.3, mass = 500.;
    const Table history = run_case(shipped("sliding_block"),
                                   {"Bodies/block/Box/Cells=4, 1, 3",
                                    "Bodies/block/Position=0, 0, 0.251",
                                    "Bodies/block/Velocity=5, 0, -1",
                                    "Body force/Acceleration=0; 0; 0",
                                    "Output/History steps=1",
                                    "Time/Step=5e-5",
                                    "Time/End=0.01"});
    double identity     = 0.;
    for (std::size_t i = 0; i < history.n_rows(); ++i)
      identity = std::max(identity,
                          std::abs((history["momentum_x"][i] + mu * history["momentum_z"][i]) /
                                     mass -
                                   (5. - mu)));
    report("deviation of v_x + mu v_z", identity);
    report("v_z after over before", -history["momentum_z"].back() / mass);
    EXPECT_LE(identity, 1e-12);
    EXPECT_GT(history["momentum_z"].back(), 0.);
    EXPECT_LE(largest(history["max_penetration_rel"]), 1e-12);
    EXPECT_LE(largest(history["energy_error"]), 1e-3);
    expect_dissipation(history);
  }


  TEST(ObliqueLanding, that_sticks_rests_in_the_touching_nodes)
  {
    // Lands and is held by its damped weight; then no node of the face moves.
    const ScratchDirectory scratch;
    akmon::Simulation simulation(akmon::Case::read(shipped("sliding_block"),
                                                   {"Output directory=" + scratch.path,
                                                    "Output/Fields interval=0",
                                                    "Bodies/block/Box/Cells=4, 1, 2",
                                                    "Bodies/block/Position=0, 0, 0.251",
                                                    "Bodies/block/Velocity=0.2, 0, -0.1",
                                                    "Obstacles/ground/Friction coefficient=0.5",
                                                    "Body force/Damping=100",
                                                    "Time/End=0.5"}),
                                 MPI_COMM_SELF,
                                 true);
    simulation.run();
    const auto &state = simulation.current_state();
    const auto &model = simulation.model();
    double worst      = 0.;
    for (unsigned int node = 0; node < model.n_owned_nodes; ++node)
      if (std::abs(akmon::at_node(model.reference, node)[2] - 0.001) < 1e-9)
        worst = std::max(worst, std::abs(akmon::at_node(state.dx_next, node)[0]) / state.dt_next);
    report("jitter over v0", worst / 0.2);
    EXPECT_LE(worst, 1e-10 * 0.2);
    expect_dissipation(Table(scratch.path + "/history.csv"));
  }


  // ---------------------------------------------------------------------------------------------
  // The layer
  // ---------------------------------------------------------------------------------------------

  struct Layer
  {
    Table history;
    double velocity_x, velocity_z; ///< means over the middle tenth's nodes at the end
  };


  Layer
  run_layer(std::vector<std::string> overrides)
  {
    const ScratchDirectory scratch;
    overrides.insert(overrides.begin(),
                     {"Output directory=" + scratch.path,
                      "Output/Fields interval=0",
                      "Time/End=1.78"});
    akmon::Simulation simulation(akmon::Case::read(shipped("oblique_layer"), overrides),
                                 MPI_COMM_SELF,
                                 true);
    simulation.run();
    const auto &state = simulation.current_state();
    const auto &model = simulation.model();
    double mass = 0., momentum_x = 0., momentum_z = 0.;
    for (unsigned int node = 0; node < model.n_owned_nodes; ++node)
      if (std::abs(akmon::at_node(model.reference, node)[0]) < 0.3)
        {
          const auto v = 0.5 * (akmon::at_node(state.dx, node) / state.dt +
                                akmon::at_node(state.dx_next, node) / state.dt_next);
          mass += model.mass[node];
          momentum_x += model.mass[node] * v[0];
          momentum_z += model.mass[node] * v[2];
        }
    return {Table(scratch.path + "/history.csv"), momentum_x / mass, momentum_z / mass};
  }


  constexpr double pressure = .01160239, shear = .003100868, v_n = 0.01, v_t = 0.005,
                   v_t_after = -.000345225;


  TEST(ObliqueLayer, sticks_and_leaves_as_one_dimensional_waves_say)
  {
    const auto [history, v_x, v_z] = run_layer({});
    const auto rows                = history.rows_between(0.2, 1.5);
    const double p                 = -mean(history["base.stress_zz"], rows),
                 tau               = mean(history["base.stress_xz"], rows);
    report("pressure, relative error", p / pressure - 1.);
    report("shear, relative error", tau / shear - 1.);
    report("v_t' - exact over v_t", (v_x - v_t_after) / v_t);
    report("v_n' over v_n", v_z / v_n);
    // Cells resolve a front within 1/n, n = 50; strains of v/c are not small to 1 %.
    EXPECT_NEAR(p, pressure, 0.01 * pressure);
    EXPECT_NEAR(tau, shear, 0.02 * shear);
    EXPECT_NEAR(v_x, v_t_after, 1.5 / 50. * v_t);
    EXPECT_NEAR(v_z, v_n, 1.5 / 50. * v_n);

    const double jitter = largest(history["base.velocity_x"], rows);
    report("velocity of a stuck node over v_t", jitter / v_t);
    EXPECT_LE(jitter, 1e-10 * v_t);
    EXPECT_EQ(history["sticking_pairs"][rows[0]], history["active_pairs"][rows[0]]);
    EXPECT_LE(largest(history["max_penetration_rel"]), 1e-12);
    EXPECT_LE(largest(history["energy_error"]), 1e-3);
    expect_dissipation(history);
  }


  TEST(ObliqueLayer, is_exact_for_small_strain)
  {
    const auto [history, v_x, v_z] = run_layer({"Bodies/layer/Velocity=5e-5, 0, -1e-4"});
    const auto rows                = history.rows_between(0.2, 1.5);
    const double p                 = -mean(history["base.stress_zz"], rows),
                 tau               = mean(history["base.stress_xz"], rows);
    report("pressure, relative error", p / (0.01 * pressure) - 1.);
    report("shear, relative error", tau / (0.01 * shear) - 1.);
    report("v_t' - exact over v_t", (v_x - 0.01 * v_t_after) / (0.01 * v_t));
    report("v_n' over v_n", v_z / (0.01 * v_n));
    EXPECT_NEAR(p, 0.01 * pressure, 0.001 * 0.01 * pressure);
    EXPECT_NEAR(tau, 0.01 * shear, 0.002 * 0.01 * shear);
    EXPECT_NEAR(v_x, 0.01 * v_t_after, 1.5 / 50. * 0.01 * v_t);
    expect_dissipation(history);
  }


  TEST(ObliqueLayer, slides_when_friction_cannot_hold)
  {
    // rho c_s v_t > mu p for mu = 0.2: v_t' = v_t - 2 mu v_n.
    const auto [history, v_x, v_z] = run_layer({"Obstacles/ground/Friction coefficient=0.2"});
    const auto rows                = history.rows_between(0.2, 1.5);
    const double tau               = mean(history["base.stress_xz"], rows);
    report("shear over mu p", tau / (0.2 * pressure));
    report("v_t' - exact over v_t", (v_x - (v_t - 2. * 0.2 * v_n)) / v_t);
    EXPECT_NEAR(tau, 0.2 * pressure, 0.02 * 0.2 * pressure);
    EXPECT_NEAR(v_x, v_t - 2. * 0.2 * v_n, 1.5 / 50. * v_t);
    // The face slides at v_t - mu p/(rho c_s); only pairs near the free ends may stick.
    const double sliding = v_t * (1. - 0.2 * pressure / shear);
    report("sliding speed over exact", mean(history["base.velocity_x"], rows) / sliding);
    EXPECT_NEAR(mean(history["base.velocity_x"], rows), sliding, 0.02 * v_t);
    EXPECT_LE(history["sticking_pairs"][rows[0]], 0.05 * history["active_pairs"][rows[0]]);
    expect_dissipation(history);
  }


  // ---------------------------------------------------------------------------------------------
  // Bars
  // ---------------------------------------------------------------------------------------------

  TEST(RubbingBars, keep_momentum_and_coulombs_law)
  {
    // Non-matching faces that slide over each other while they collide.
    const double mu = 0.1, m_v0 = 7.337e-4 * 10. * 202.2;
    const Table history = run_case(shipped("two_bars"),
                                   {"Contact solver/Type=coupled",
                                    "Contact/interface/Pass=symmetric",
                                    "Contact/interface/Friction coefficient=0.1",
                                    "Bodies/left/Box/Cells=20,4,4",
                                    "Bodies/right/Box/Cells=20,3,3",
                                    "Bodies/left/Velocity=202.2, 60, 20",
                                    "Bodies/right/Velocity=-202.2, -60, -20"});
    double above = 0., slid = 0., most = 0., sum = 0., n_in_contact = 0.;
    for (std::size_t i = 0; i < history.n_rows(); ++i)
      {
        const double normal     = std::abs(history["interface.force_x"][i]);
        const double tangential = std::hypot(history["interface.force_y"][i],
                                             history["interface.force_z"][i]);
        if (history["active_pairs"][i] > 0.)
          {
            above = std::max(above, tangential - 1.05 * mu * normal);
            sum += history["contact_iterations"][i];
            n_in_contact += 1.;
          }
        slid = std::max(slid, tangential / 29998.604);
        most = std::max(most, history["contact_iterations"][i]);
        for (const char *const axis : {"x", "y", "z"})
          EXPECT_LE(std::abs(history[std::string("momentum_") + axis][i]), 1e-12 * m_v0);
      }
    report("friction over normal force of exact 1D", slid);
    report("iterations, most", most);
    report("iterations, mean in contact", sum / n_in_contact);
    EXPECT_GT(slid, 0.05);
    // Normals of turning faces are not the x axis: hence 5 %.
    EXPECT_LE(above, 1e-6 * 29998.604);
    EXPECT_LE(largest(history["max_penetration_rel"]), 1e-3);
    report("penetration over h", largest(history["max_penetration_rel"]));
    report("energy error", largest(history["energy_error"]));
    EXPECT_LE(largest(history["energy_error"]), 1e-3);
    expect_dissipation(history);
    // Nothing touches in the end: no force is reported.
    ASSERT_EQ(history["active_pairs"].back(), 0.);
    for (const char *const axis : {"x", "y", "z"})
      EXPECT_EQ(history[std::string("interface.force_") + axis].back(), 0.);
  }
} // namespace coupled_friction
