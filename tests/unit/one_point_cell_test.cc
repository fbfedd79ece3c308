#include <akmon/forces/one_point_cell.h>
#include <akmon/material/hypoelastic.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

// The one-point cell with hourglass control: exact for uniform strains on any mesh, controls
// exactly the twelve patterns, turns with the cell.

namespace one_point_cell_test
{
  using namespace akmon;

  constexpr double density = 8930., dt = 1e-7;
  const Hypoelastic elastic{Elasticity::from_young(117e9, .35)};
  const double modulus = elastic.elasticity.lambda + 2. * elastic.elasticity.mu;

  // Signs of the patterns eta zeta, xi zeta, xi eta, xi eta zeta at a corner.
  double
  pattern(const unsigned int a, const unsigned int v)
  {
    const double xi = v & 1 ? 1. : -1., eta = v & 2 ? 1. : -1., zeta = v & 4 ? 1. : -1.;
    return a == 0 ? eta * zeta : a == 1 ? xi * zeta : a == 2 ? xi * eta : xi * eta * zeta;
  }


  struct Cell
  {
    double x[8][3], dx[8][3] = {}, force[8][3] = {};
    double state[6] = {}, hourglass[12] = {};
    CellPassSums<double> sums;

    /// A brick of edge h, its corners moved by up to `distortion` of it.
    Cell(const double h, const double distortion)
    {
      std::mt19937 generator(11);
      std::uniform_real_distribution<double> uniform(-distortion, distortion);
      for (unsigned int v = 0; v < 8; ++v)
        for (unsigned int d = 0; d < 3; ++d)
          x[v][d] = h * (((v >> d) & 1) + uniform(generator));
    }

    /// Go on by dx.
    void
    step(const HourglassControl control, const double coefficient)
    {
      for (unsigned int v = 0; v < 8; ++v)
        for (unsigned int d = 0; d < 3; ++d)
          x[v][d] += dx[v][d];
      const HourglassConstants constants(control, coefficient, elastic.elasticity, density, dt);
      update_one_point_cell(elastic, constants, x, dx, 1., state, hourglass, sums, force);
    }
  };


  TEST(OnePointCell, PassesThePatchTest)
  {
    // Uniform strain on a distorted cell: stress, nodal forces and work of full integration, no
    // hourglass force.
    const double H[3][3] = {{.002, .003, -.001}, {-.004, .001, .002}, {.001, -.002, -.003}};
    for (const auto control : {HourglassControl::stiffness, HourglassControl::viscous})
      {
        Cell cell(1e-3, .2);
        for (unsigned int v = 0; v < 8; ++v)
          for (unsigned int i = 0; i < 3; ++i)
            cell.dx[v][i] = H[i][0] * cell.x[v][0] + H[i][1] * cell.x[v][1] +
                            H[i][2] * cell.x[v][2];
        cell.step(control, .1);

        double state[48] = {}, force[8][3];
        CellPassSums<double> sums;
        update_stress_and_force<false>(elastic, cell.x, cell.dx, 1., state, state, sums, force);
        for (unsigned int c = 0; c < 6; ++c)
          EXPECT_NEAR(cell.state[c], state[c], 1e-12 * modulus);
        for (unsigned int v = 0; v < 8; ++v)
          for (unsigned int i = 0; i < 3; ++i)
            EXPECT_NEAR(cell.force[v][i], force[v][i], 1e-12 * modulus * 1e-6);
        EXPECT_NEAR(cell.sums.internal_work, sums.internal_work, 1e-12 * sums.internal_work);
        EXPECT_NEAR(cell.sums.hourglass_work, 0., 1e-12 * sums.internal_work);
      }
  }


  TEST(OnePointCell, ControlsExactlyTheTwelvePatterns)
  {
    // In the cube of edge h, B = 3/2 h^4: f = (3/2) kappa (lambda + 2 mu) h u, or 2 kappa rho c h^2
    // u/dt, against a pattern of amplitude u; its work is 8 nodes times f u, half of it for the
    // spring.
    constexpr double h = 1e-3, u = 1e-10, kappa = .05;
    for (const auto control : {HourglassControl::stiffness, HourglassControl::viscous})
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int i = 0; i < 3; ++i)
          {
            Cell cell(h, 0.);
            for (unsigned int v = 0; v < 8; ++v)
              cell.dx[v][i] = u * pattern(a, v);
            cell.step(control, kappa);
            const bool spring = control == HourglassControl::stiffness;
            const double f    = spring ? 1.5 * kappa * modulus * h * u :
                                         2. * kappa * std::sqrt(density * modulus) * h * h * u / dt;
            for (unsigned int v = 0; v < 8; ++v)
              for (unsigned int d = 0; d < 3; ++d)
                EXPECT_NEAR(cell.force[v][d], d == i ? f * pattern(a, v) : 0., 1e-6 * f);
            EXPECT_NEAR(cell.sums.hourglass_work,
                        (spring ? .5 : 1.) * 8. * f * u,
                        1e-6 * 8. * f * u);
            for (const double stress : cell.state)
              EXPECT_NEAR(stress, 0., 1e-6 * modulus * u / h);

            Cell free(h, 0.);
            std::copy(&cell.dx[0][0], &cell.dx[0][0] + 24, &free.dx[0][0]);
            free.step(control, 0.);
            for (unsigned int v = 0; v < 8; ++v)
              for (unsigned int d = 0; d < 3; ++d)
                EXPECT_NEAR(free.force[v][d], 0., 1e-6 * f);
          }
  }


  TEST(OnePointCell, HourglassForcesTurnWithTheCell)
  {
    Cell cell(1e-3, .1);
    for (unsigned int v = 0; v < 8; ++v)
      for (unsigned int i = 0; i < 3; ++i)
        cell.dx[v][i] = 2e-5 * pattern((v + i) % 4, v) * (1. + i);
    cell.step(HourglassControl::stiffness, .05);
    double before[8][3], largest = 0.;
    for (unsigned int v = 0; v < 8; ++v)
      for (unsigned int i = 0; i < 3; ++i)
        {
          before[v][i] = cell.force[v][i];
          largest      = std::max(largest, std::abs(before[v][i]));
        }

    // 40 degrees about the axis (1, 2, 2)/3 in one step
    const double n[3] = {1. / 3., 2. / 3., 2. / 3.}, c = std::cos(.7), s = std::sin(.7);
    double R[3][3];
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        R[i][j] = (i == j ? c : 0.) + (1. - c) * n[i] * n[j];
    for (unsigned int i = 0; i < 3; ++i)
      {
        R[i][(i + 1) % 3] -= s * n[(i + 2) % 3];
        R[i][(i + 2) % 3] += s * n[(i + 1) % 3];
      }
    for (unsigned int v = 0; v < 8; ++v)
      for (unsigned int i = 0; i < 3; ++i)
        cell.dx[v][i] = R[i][0] * cell.x[v][0] + R[i][1] * cell.x[v][1] + R[i][2] * cell.x[v][2] -
                        cell.x[v][i];
    cell.step(HourglassControl::stiffness, .05);
    for (unsigned int v = 0; v < 8; ++v)
      for (unsigned int i = 0; i < 3; ++i)
        EXPECT_NEAR(cell.force[v][i],
                    R[i][0] * before[v][0] + R[i][1] * before[v][1] + R[i][2] * before[v][2],
                    1e-11 * largest);
  }


  TEST(OnePointCell, VolumeGradientIsThatOfTheVolume)
  {
    const Cell cell(1., .25);
    const VolumeGradient<double> gradient(cell.x);
    EXPECT_NEAR(gradient.volume, hexahedron_volume(cell.x), 1e-14);
    const auto gradients = TrilinearGradients<double>::evaluate(cell.x);
    double by_points     = 0.;
    for (unsigned int q = 0; q < 8; ++q)
      by_points += determinant(gradients.at(q));
    EXPECT_NEAR(gradient.volume, by_points, 1e-14);
    // The volume is linear in one coordinate of one node.
    for (unsigned int v = 0; v < 8; ++v)
      for (unsigned int d = 0; d < 3; ++d)
        {
          Cell moved = cell;
          moved.x[v][d] += 1.;
          EXPECT_NEAR(gradient.b[v][d],
                      hexahedron_volume(moved.x) - hexahedron_volume(cell.x),
                      1e-14);
        }
  }
} // namespace one_point_cell_test
