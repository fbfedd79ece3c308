#pragma once

#include <akmon/output/history.h>

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "support/run_case.h"

namespace akmon::test::bar_impacts
{
  // Impacts of two elastic bars of 100 cells per length 10.

  inline constexpr double density = 7.337e-4, modulus = 3e7, v0 = 202.2, length = 10., n = 100.;
  inline const double c = std::sqrt(modulus / density), h = length / n;

  struct Bar
  {
    const char *name;
    double length, impedance_factor, velocity, velocity_after;

    double
    mass() const
    {
      return density * impedance_factor * length; // E and rho share the factor, c stays
    }
  };


  struct Impact
  {
    const char *name, *file;
    std::vector<std::string> overrides;
    Bar bars[2];
    double gap, force, interface_velocity;
    double after; ///< a time after the release, for runs at Courant number 1
  };


  inline void
  PrintTo(const Impact &impact, std::ostream *out)
  {
    *out << impact.name;
  }


  // Numbers of doc/verification.md, section 2; one-dimensional wave theory.
  inline const Impact impacts[] =
    {{"equal",
      "two_bars",
      {"Bodies/left/Box/Cells=100,1,1", "Bodies/right/Box/Cells=100,1,1"},
      {{"left", 10., 1., v0, -v0}, {"right", 10., 1., -v0, v0}},
      0.02,
      29998.604,
      0.,
      1.58e-4},
     {"short_hits_long",
      "bars_unequal_length",
      {},
      {{"short", 10., 1., v0, -v0}, {"long", 20., 1., -v0, 0.}},
      0.02,
      29998.604,
      0.,
      1.58e-4},
     {"short_hits_long_at_rest",
      "bars_unequal_length",
      {"Bodies/long/Velocity=0,0,0"},
      {{"short", 10., 1., v0, 0.}, {"long", 20., 1., 0., v0 / 2}},
      0.02,
      14999.302,
      v0 / 2,
      2.08e-4},
     {"light_hits_heavy_at_rest",
      "bars_impedance",
      {},
      {{"light", 10., 1., v0, -121.32}, {"heavy", 10., 4., 0., 80.88}},
      0.02,
      23998.883,
      40.44,
      2.08e-4},
     {"light_and_heavy_meet",
      "bars_impedance",
      {"Bodies/heavy/Velocity=-202.2,0,0"},
      {{"light", 10., 1., v0, -444.84}, {"heavy", 10., 4., -v0, -40.44}},
      0.02,
      47997.766,
      -121.32,
      1.58e-4}};


  struct Outcome
  {
    Table history;
    double velocity[2]; ///< of the bodies' centres of mass at the end, along x
  };


  inline Outcome
  run(const Impact &impact, std::vector<std::string> overrides)
  {
    const ScratchDirectory scratch;
    overrides.insert(overrides.begin(), impact.overrides.begin(), impact.overrides.end());
    overrides.insert(overrides.begin(),
                     {"Output directory=" + scratch.path, "Output/Fields interval=0"});
    akmon::Simulation simulation(akmon::Case::read(shipped(impact.file), overrides),
                                 MPI_COMM_SELF,
                                 true);
    simulation.run();

    const auto &model = simulation.model();
    const auto &state = simulation.current_state();
    double mass[2] = {0., 0.}, momentum[2] = {0., 0.};
    for (unsigned int node = 0; node < model.n_owned_nodes; ++node)
      {
        const unsigned int body = model.body_of_node[node];
        const auto v            = 0.5 * (akmon::at_node(state.dx, node) / state.dt +
                              akmon::at_node(state.dx_next, node) / state.dt_next);
        mass[body] += model.mass[node];
        momentum[body] += model.mass[node] * v[0];
      }
    for (unsigned int b = 0; b < 2; ++b)
      EXPECT_NEAR(mass[b], impact.bars[b].mass(), 1e-12 * mass[b]);
    return {Table(scratch.path + "/history.csv"), {momentum[0] / mass[0], momentum[1] / mass[1]}};
  }


  enum class Courant
  {
    nine_tenths,
    one
  };


  // Ends at a whole number of steps: a shorter last step would be no part of the question.
  inline Outcome
  run(const Impact &impact, const Courant courant)
  {
    const double dt      = courant == Courant::one ? h / c : 4.45e-7;
    const double end     = courant == Courant::one ? impact.after : impact.after + 0.42e-4;
    const double n_steps = std::floor(end / dt);
    // A Courant number of one is exact in one dimension, and just above the bound for cells.
    return run(impact,
               {"Time/Step=" + akmon::shortest_text(dt),
                "Time/End=" + akmon::shortest_text(n_steps * dt),
                "Time/Allow unstable step=true"});
  }
} // namespace akmon::test::bar_impacts
