#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>

#include "support/run_case.h"

// The two bars of AIAA 2003-1599, n x n cells across one and m x m across the other: the solution
// is one-dimensional, so with the coupled solver the meshes must not matter. Every pair of 2..8
// with both sides slave and master; and the noise of the interface velocity of all three ways to
// compute contact, for the documents (formulation.md section 6).

namespace bars_any_meshes
{
  using namespace akmon::test;

  constexpr double v0 = 202.2, force = 29998.604, mass_of_bar = 7.337e-4 * 10.;


  Table
  run_bars(const unsigned int n,
           const unsigned int m,
           const std::string &solver,
           const std::string &pass)
  {
    const auto cells = [](const unsigned int k) {
      return "20," + std::to_string(k) + "," + std::to_string(k);
    };
    // The paper's step is above the critical one (.9 h/c) of eight cells across.
    const bool fine = std::max(n, m) > 6;
    return run_case(shipped("two_bars"),
                    {"Bodies/left/Box/Cells=" + cells(n),
                     "Bodies/right/Box/Cells=" + cells(m),
                     "Contact solver/Type=" + solver,
                     "Contact/interface/Pass=" + pass,
                     std::string("Time/Step=") + (fine ? "5.5e-7" : "7.274e-7")});
  }


  double
  largest(const std::vector<double> &values, const std::vector<std::size_t> &rows)
  {
    double result = 0.;
    for (const std::size_t i : rows)
      result = std::max(result, std::abs(values[i]));
    return result;
  }


  std::vector<std::size_t>
  rows_in_contact(const Table &history)
  {
    return history.rows_between(6e-5, 1.35e-4);
  }


  class BarsOfAnyMeshes : public testing::TestWithParam<unsigned int>
  {
  };


  TEST_P(BarsOfAnyMeshes, touch_as_if_they_matched)
  {
    const unsigned int n = GetParam();
    double worst_noise = 0., worst_penetration = 0., worst_iterations = 0., worst_energy = 0.;
    for (unsigned int m = 2; m <= 8; ++m)
      {
        SCOPED_TRACE(std::to_string(n) + "/" + std::to_string(m));
        const Table history = run_bars(n, m, "coupled", "symmetric");
        const auto all      = history.rows_between(0., 1.);
        const auto contact  = rows_in_contact(history);

        const double noise = largest(history["left_face.velocity_x"], contact);
        EXPECT_LE(noise, 1e-9 * v0);
        const double penetration = largest(history["max_penetration_rel"], all);
        EXPECT_LE(penetration, 1e-12);
        for (const char *const axis : {"x", "y", "z"})
          EXPECT_LE(largest(history[std::string("momentum_") + axis], all),
                    1e-12 * mass_of_bar * v0);
        const double energy_error = largest(history["energy_error"], all);
        EXPECT_LE(energy_error, 2e-4);

        double iterations = 0., mean_force = 0.;
        for (const std::size_t i : contact)
          {
            iterations += history["contact_iterations"][i] / contact.size();
            mean_force -= history["interface.force_x"][i] / contact.size();
          }
        EXPECT_LE(iterations, 30.);
        EXPECT_NEAR(mean_force, force, 1e-3 * force);

        worst_noise       = std::max(worst_noise, noise);
        worst_penetration = std::max(worst_penetration, penetration);
        worst_iterations  = std::max(worst_iterations, iterations);
        worst_energy      = std::max(worst_energy, energy_error);
      }
    std::cout << "  " << n << " on 2..8: noise " << worst_noise << ", penetration/h "
              << worst_penetration << ", mean iterations " << worst_iterations << ", energy error "
              << worst_energy << std::endl;
  }


  INSTANTIATE_TEST_SUITE_P(Cells, BarsOfAnyMeshes, testing::Range(2u, 9u));


  TEST(BarsOfAnyMeshes, noise_of_all_ways_to_compute_contact)
  {
    std::cout << "  | n/m | decoupled | coupled, single pass | coupled, symmetric |" << std::endl
              << std::setprecision(3);
    const std::pair<unsigned int, unsigned int> meshes[] =
      {{4, 4}, {4, 3}, {3, 4}, {5, 4}, {6, 5}, {4, 2}, {2, 4}, {8, 7}};
    for (const auto &[n, m] : meshes)
      {
        std::cout << "  | " << n << "/" << m << " |";
        for (const auto &[solver, pass] : {std::make_pair("decoupled", "single"),
                                           {"coupled", "single"},
                                           {"coupled", "symmetric"}})
          {
            const Table history = run_bars(n, m, solver, pass);
            std::cout << " " << largest(history["left_face.velocity_x"], rows_in_contact(history))
                      << " |";
          }
        std::cout << std::endl;
      }
  }
} // namespace bars_any_meshes
