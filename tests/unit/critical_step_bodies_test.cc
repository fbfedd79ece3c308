#include <akmon/forces/internal_forces.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "support/critical_step.h"

// The critical step 2/omega_max of assembled bodies against known ones of meshes of cubes and
// against Lanczos' iteration with the internal forces; and how it follows a cell that deforms.

namespace critical_step_bodies_test
{
  using namespace akmon;
  using namespace akmon::test;

  // ---------------------------------------------------------------------------------------------
  // Assembled bodies
  // ---------------------------------------------------------------------------------------------

  Body
  body_with(const MeshParameters::Shape &shape, const CellIntegration integration)
  {
    Body body;
    body.name        = "body";
    body.mesh.shape  = shape;
    body.rotation    = dealii::unit_symmetric_tensor<3>();
    body.material    = "elastic";
    body.integration = integration;
    return body;
  }


  BoxShape
  box(const Tensor<1, 3> &size, const std::array<unsigned int, 3> &cells)
  {
    BoxShape shape;
    shape.size  = size;
    shape.cells = cells;
    return shape;
  }


  Material
  elastic(const double nu)
  {
    Material material;
    material.name    = "elastic";
    material.density = 1.;
    material.law     = Hypoelastic{Elasticity::from_young(1., nu)};
    return material;
  }


  // Largest eigenvalue of M^{-1} K of a whole body by Lanczos' iteration (a power iteration that
  // remembers). K u is the internal force operator itself from the unstressed state, for a
  // displacement so small that it is linear.
  double
  assembled_eigenvalue(const Discretization &discretization, const InternalForces &unstressed)
  {
    constexpr unsigned int max_vectors = 250;
    constexpr double displacement      = 1e-6;
    const unsigned int n               = 3 * discretization.n_nodes;
    std::mt19937 generator(7);
    std::uniform_real_distribution<double> uniform(-1., 1.);

    // y = M^{-1/2} K M^{-1/2} q, the mean of what +q and -q do: without the quadratic term.
    const auto apply = [&](const std::vector<double> &q) {
      double largest = 0.;
      for (unsigned int i = 0; i < n; ++i)
        largest = std::max(largest, std::abs(q[i]) / std::sqrt(discretization.mass[i / 3]));
      std::vector<double> y(n, 0.);
      for (const double scale : {displacement / largest, -displacement / largest})
        {
          NodalVector x(discretization.reference), dx = discretization.make_vector(),
                                                   force = discretization.make_vector();
          for (unsigned int i = 0; i < n; ++i)
            dx.local_element(i) = scale * q[i] / std::sqrt(discretization.mass[i / 3]);
          for (unsigned int i = 0; i < n; ++i)
            x.local_element(i) += dx.local_element(i);
          InternalForces operation(unstressed);
          operation.update(x, dx, force);
          for (unsigned int i = 0; i < n; ++i)
            y[i] -= 0.5 * force.local_element(i) / (scale * std::sqrt(discretization.mass[i / 3]));
        }
      return y;
    };
    const auto dot = [&](const std::vector<double> &a, const std::vector<double> &b) {
      double sum = 0.;
      for (unsigned int i = 0; i < n; ++i)
        sum += a[i] * b[i];
      return sum;
    };

    std::vector<std::vector<double>> basis;
    std::vector<double> diagonal, off_diagonal, q(n);
    for (auto &value : q)
      value = uniform(generator);
    double eigenvalue = 0.;
    while (basis.size() < std::min(max_vectors, n))
      {
        const double norm = std::sqrt(dot(q, q));
        if (!basis.empty())
          {
            if (norm < 1e-9 * eigenvalue)
              break;
            off_diagonal.push_back(norm);
          }
        for (auto &value : q)
          value /= norm;
        basis.push_back(q);
        q = apply(q);
        diagonal.push_back(dot(q, basis.back()));
        for (unsigned int pass = 0; pass < 2; ++pass)
          for (const auto &b : basis)
            {
              const double overlap = dot(q, b);
              for (unsigned int i = 0; i < n; ++i)
                q[i] -= overlap * b[i];
            }

        // Largest Ritz value: Newton's iteration from above on the last pivot would do; bisection
        // by Sturm's count is plainer.
        double low = *std::max_element(diagonal.begin(), diagonal.end()), high = low;
        for (unsigned int i = 0; i < diagonal.size(); ++i)
          high = std::max(high,
                          diagonal[i] + (i > 0 ? off_diagonal[i - 1] : 0.) +
                            (i < off_diagonal.size() ? off_diagonal[i] : 0.));
        const auto all_below = [&](const double bound) {
          double pivot = bound - diagonal[0];
          for (unsigned int i = 1; pivot > 0. && i < diagonal.size(); ++i)
            pivot = bound - diagonal[i] - off_diagonal[i - 1] * off_diagonal[i - 1] / pivot;
          return pivot > 0.;
        };
        while (high - low > 1e-12 * high)
          {
            const double middle              = 0.5 * (low + high);
            (all_below(middle) ? high : low) = middle;
          }
        const double change = std::abs(high - eigenvalue);
        eigenvalue          = high;
        if (basis.size() > 60 && change < 1e-10 * eigenvalue)
          break;
      }
    return eigenvalue;
  }


  struct Steps
  {
    double estimated, exact;
  };


  // Critical steps of a body over h/c_d, both the estimate and the true one of the assembled
  // system.
  Steps
  critical_steps(const MeshParameters::Shape &shape,
                 const double nu,
                 const CellIntegration integration,
                 const double h)
  {
    const Material material = elastic(nu);
    const Discretization discretization({body_with(shape, integration)}, {material}, MPI_COMM_SELF);
    const InternalForces forces(discretization);
    const double unit = h / material.dilatational_wave_speed();
    return {2. / std::sqrt(forces.largest_frequency_squared()) / unit,
            2. / std::sqrt(assembled_eigenvalue(discretization, forces)) / unit};
  }


  TEST(BodyEigenvalue, OfFreeMeshesOfCubesIsTheKnownOne)
  {
    for (const auto &known : cube_meshes)
      {
        const Tensor<1, 3> size({.1 * known.cells[0], .1 * known.cells[1], .1 * known.cells[2]});
        const auto shape       = box(size, known.cells);
        const Steps full       = critical_steps(shape, .3, CellIntegration::full, .1);
        const Steps mean       = critical_steps(shape, .3, CellIntegration::mean_dilatation, .1);
        const std::string name = std::to_string(known.cells[0]) + " x " +
                                 std::to_string(known.cells[2]);
        report("free cubes " + name + " full", full.exact);
        report("free cubes " + name + " mean dilatation", mean.exact);
        EXPECT_LE(full.estimated, full.exact * (1. + 1e-8)) << name;
        EXPECT_LE(mean.estimated, mean.exact * (1. + 1e-8)) << name;
        EXPECT_NEAR(full.exact, known.dt, 0.5e-4) << name;
        // Averaging the dilatation only takes energy away.
        EXPECT_GE(mean.exact, full.exact * (1. - 1e-8)) << name;
      }
  }


  TEST(BodyEigenvalue, IsNeverAboveTheEstimate)
  {
    CylinderShape cylinder;
    cylinder.radius        = .2;
    cylinder.length        = .4;
    cylinder.cells_across  = 2;
    cylinder.cells_radial  = 2;
    cylinder.cells_axial   = 3;
    cylinder.sector        = Sector::full;
    cylinder.axial_grading = 2.;
    SphereShape sphere;
    sphere.radius       = 1.;
    sphere.cells_across = 2;
    sphere.cells_radial = 2;
    const std::vector<std::pair<std::string, MeshParameters::Shape>> shapes =
      {{"box", box(Tensor<1, 3>({1., .5, 2.}), {{3, 4, 2}})},
       {"plate", box(Tensor<1, 3>({1., 1., .05}), {{4, 4, 1}})},
       {"cylinder", cylinder},
       {"sphere", sphere}};
    for (const auto &[name, shape] : shapes)
      for (const auto integration : integrations)
        for (const double nu : {0., .3, .45})
          {
            const Steps steps = critical_steps(shape, nu, integration, 1.);
            report(name + " nu " + std::to_string(nu) + " estimated over exact step",
                   steps.estimated / steps.exact);
            EXPECT_LE(steps.estimated, steps.exact * (1. + 1e-8)) << name << " nu " << nu;
          }
  }


  // ---------------------------------------------------------------------------------------------
  // The tracker: a cell that deforms gradually
  // ---------------------------------------------------------------------------------------------

  // Motion of a node from its reference position, 0 <= t <= 1.
  using Motion = std::array<double, 3> (*)(const std::array<double, 3> &, double);


  std::array<double, 3>
  stretch_to_two(const std::array<double, 3> &X, const double t)
  {
    return {{X[0] * (1. + t), X[1], X[2]}};
  }


  std::array<double, 3>
  stretch_to_half(const std::array<double, 3> &X, const double t)
  {
    return {{X[0], X[1] * (1. - .5 * t), X[2]}};
  }


  std::array<double, 3>
  flatten_at_constant_volume(const std::array<double, 3> &X, const double t)
  {
    const double s = 1. - .75 * t;
    return {{X[0] / std::sqrt(s), X[1] / std::sqrt(s), X[2] * s}};
  }


  std::array<double, 3>
  shear_to_one(const std::array<double, 3> &X, const double t)
  {
    return {{X[0] + t * X[1], X[1], X[2]}};
  }


  std::array<double, 3>
  twist(const std::array<double, 3> &X, const double t)
  {
    const double angle = t * X[2];
    return {{std::cos(angle) * X[0] - std::sin(angle) * X[1],
             std::sin(angle) * X[0] + std::cos(angle) * X[1],
             X[2]}};
  }


  std::array<double, 3>
  taper(const std::array<double, 3> &X, const double t)
  {
    const double s = 1. - .7 * t * (X[2] + .5);
    return {{s * X[0], s * X[1], X[2]}};
  }


  TEST(Tracker, FollowsACellThatDeforms)
  {
    constexpr unsigned int n_steps                            = 400;
    const std::vector<std::pair<std::string, Motion>> motions = {{"stretch to 2", stretch_to_two},
                                                                 {"stretch to 1/2",
                                                                  stretch_to_half},
                                                                 {"flatten to 1/4",
                                                                  flatten_at_constant_volume},
                                                                 {"shear to 1", shear_to_one},
                                                                 {"twist by 1 rad", twist},
                                                                 {"taper to .3", taper}};
    for (const auto &[name, motion] : motions)
      for (const auto integration : integrations)
        for (const auto &size : {Tensor<1, 3>({1., 1., 1.}), Tensor<1, 3>({1., .5, 1.})})
          for (const double nu : {0., .3, .45})
            {
              const Material material = elastic(nu);
              const Discretization discretization({body_with(box(size, {{1, 1, 1}}), integration)},
                                                  {material},
                                                  MPI_COMM_SELF);
              InternalForces forces(discretization);
              NodalVector x(discretization.reference), dx = discretization.make_vector(),
                                                       force = discretization.make_vector();
              Nodes reference, current;
              const auto &nodes = discretization.cells[0].nodes;
              for (unsigned int v = 0; v < 8; ++v)
                for (unsigned int d = 0; d < 3; ++d)
                  reference[v][d] = at_node(discretization.reference, nodes[v])[d];
              const Masses mass = lumped_masses(reference, 1.);

              Range range;
              for (unsigned int step = 1; step <= n_steps; ++step)
                {
                  for (unsigned int v = 0; v < 8; ++v)
                    {
                      current[v] = motion(reference[v], double(step) / n_steps);
                      for (unsigned int d = 0; d < 3; ++d)
                        {
                          const unsigned int i = 3 * nodes[v] + d;
                          dx.local_element(i)  = current[v][d] - x.local_element(i);
                          x.local_element(i)   = current[v][d];
                        }
                    }
                  forces.update(x, dx, force);
                  range.add(ratio_of_steps(forces.largest_frequency_squared(),
                                           exact_eigenvalue(current,
                                                            mass,
                                                            material.elasticity(),
                                                            integration)));
                }
              EXPECT_FALSE(forces.fault().occurred());
              EXPECT_GE(range.low, 1. - allowed_loss) << name << " nu " << nu << " " << size[1];
              EXPECT_LE(range.high, 1. + allowed_loss) << name << " nu " << nu << " " << size[1];
              if (size[1] == 1. && integration == CellIntegration::mean_dilatation)
                report(name + " nu " + std::to_string(nu) + ", ratio of steps " +
                         std::to_string(range.low) + " to",
                       range.high);
            }
  }
} // namespace critical_step_bodies_test
