#pragma once

#include <cmath>
#include <iostream>

#include "support/kept_run.h"
#include "support/report.h"
#include "support/run_directory.h"

// An elastic sphere, R = E = rho = 1, nu = 0.3, on a rigid plane: Hertz (doc/verification.md,
// section 6b). Cases hertz_impact and hertz_press, which mesh a quarter.

namespace akmon::test
{
  inline constexpr double modulus = 1. / (1. - 0.3 * 0.3); ///< E* = E/(1 - nu^2)


  /// a = (3 F R/(4 E*))^(1/3) under the force F.
  inline double
  hertz_radius(const double force)
  {
    return std::cbrt(0.75 * force / modulus);
  }


  /// p0 = 3 F/(2 pi a^2)
  inline double
  hertz_pressure(const double force)
  {
    const double a = hertz_radius(force);
    return 1.5 * force / (dealii::numbers::PI * a * a);
  }


  /// The radius of Hertz' pressure from its moment about the origin, on a quarter:
  /// M = (3/8) a F. The area of nodes in contact has h/a too much in its radius.
  inline double
  radius_of(const double moment, const double force)
  {
    return 8. / 3. * std::abs(moment) / force;
  }


  inline std::vector<std::string>
  graded_sphere(const unsigned int n_across, const double pole_size)
  {
    const std::string sphere = "Bodies/ball/Sphere/";
    return {sphere + "Cells across=" + std::to_string(n_across),
            sphere + "Cells radial=" + std::to_string(n_across / 2),
            sphere + "Pole size=" + std::to_string(pole_size)};
  }


  /// What was measured over what Hertz says.
  struct HertzRatios
  {
    double force, radius, radius_of_nodes, pressure, time, restitution;
  };


  /// contact.csv of a case.
  inline Table
  contact_history(const std::string &name, const std::vector<std::string> &overrides)
  {
    const ScratchDirectory scratch;
    const auto result = run_program(arguments_for(shipped(name), scratch.path, overrides));
    if (result.status != 0)
      throw std::runtime_error(result.output);
    return Table(scratch.path + "/contact.csv");
  }


  /// Mean of a column over rows with times around t, the whole width w.
  inline double
  mean_around(const Table &rows, const std::string &column, const double t, const double w)
  {
    double sum = 0., n = 0.;
    for (const std::size_t i : rows.rows_between(t - 0.5 * w, t + 0.5 * w))
      {
        sum += rows[column][i];
        n += 1.;
      }
    return sum / n;
  }


  /// Radius and pressure are compared with what Hertz says for the force there is.
  inline HertzRatios
  press(const unsigned int n_across, const double pole_size, const double depth = 0.01)
  {
    auto overrides = graded_sphere(n_across, pole_size);
    overrides.push_back("Prescribed motion/press/Function=0; 0; -" + std::to_string(0.5 * depth) +
                        "*(1 - cos(pi*min(t, 10)/10))");
    overrides.emplace_back("Output/Fields interval=0");
    const Table rows     = contact_history("hertz_press", overrides);
    const double quarter = rows["plane.normal_force_z"].back(), force = 4. * quarter;
    HertzRatios ratios{force / (4. / 3. * modulus * std::pow(depth, 1.5)),
                       radius_of(rows["plane.moment_y"].back(), quarter) / hertz_radius(force),
                       std::sqrt(4. * rows["plane.area"].back() / dealii::numbers::PI) /
                         hertz_radius(force),
                       rows["plane.max_pressure"].back() / hertz_pressure(force),
                       0.,
                       0.};
    std::cout << "  -- " << n_across << " cells across, pole size " << pole_size << std::endl;
    report("press: force over that of a half space at this approach", ratios.force);
    report("press: contact radius over Hertz at this force", ratios.radius);
    report("press: radius of the nodes in contact over Hertz", ratios.radius_of_nodes);
    report("press: largest pressure over Hertz at this force", ratios.pressure);
    return ratios;
  }


  inline HertzRatios
  impact(const unsigned int n_across, const double pole_size)
  {
    constexpr double v = 0.01, hertz_force = .0125244, hertz_time = 12.3047;
    auto overrides = graded_sphere(n_across, pole_size);
    overrides.emplace_back("Output/Fields interval=0");
    const ScratchDirectory scratch;
    const auto result = run_program(
      arguments_for(shipped("hertz_impact"), scratch.path, overrides));
    if (result.status != 0)
      throw std::runtime_error(result.output);
    const Table rows(scratch.path + "/contact.csv"), history(scratch.path + "/history.csv");
    const auto &F = rows["plane.normal_force_z"], &time = rows["time"];
    std::size_t peak = 0;
    double first = -1., last = 0.;
    for (std::size_t i = 0; i < F.size(); ++i)
      {
        if (F[i] > F[peak])
          peak = i;
        if (F[i] > 0.)
          {
            first = first < 0. ? time[i] : first;
            last  = time[i];
          }
      }
    // Around the middle, where the force is level but for its ringing.
    const double middle = 0.5 * (first + last), width = 0.1 * (last - first);
    const double quarter = mean_around(rows, "plane.normal_force_z", middle, width);
    const double force   = 4. * quarter;
    const double area    = 4. * mean_around(rows, "plane.area", middle, width);
    const double mass    = history["momentum_z"].front() / -v;
    HertzRatios ratios{4. * F[peak] / hertz_force,
                       radius_of(mean_around(rows, "plane.moment_y", middle, width), quarter) /
                         hertz_radius(force),
                       std::sqrt(area / dealii::numbers::PI) / hertz_radius(force),
                       mean_around(rows, "plane.max_pressure", middle, width) /
                         hertz_pressure(force),
                       (last - first) / hertz_time,
                       history["momentum_z"].back() / (mass * v)};
    std::cout << "  -- " << n_across << " cells across, pole size " << pole_size << std::endl;
    report("impact: largest force over Hertz (continuum: 1.073)", ratios.force);
    report("impact: mean force in the middle over Hertz", force / hertz_force);
    report("impact: contact radius over Hertz at this force", ratios.radius);
    report("impact: radius of the nodes in contact over Hertz", ratios.radius_of_nodes);
    report("impact: largest pressure over Hertz at this force", ratios.pressure);
    report("impact: contact time over Hertz (continuum: .953)", ratios.time);
    report("impact: restitution (continuum: .9984)", ratios.restitution);
    report("impact: penetration over h", largest_of(history["max_penetration_rel"]));
    report("impact: energy error", largest_of(history["energy_error"]));
    report("impact: iterations, mean", mean_iterations(history));
    return ratios;
  }
} // namespace akmon::test
