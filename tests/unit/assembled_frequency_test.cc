#include <akmon/time/assembled_frequency.h>
#include <akmon/time/mass_scaling.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <string>

#include "support/assembled_system.h"
#include "support/cell_body.h"
#include "support/critical_step.h"

// The bound of the assembled system's largest frequency against known ones, and mass scaling.

namespace assembled_frequency_test
{
  using namespace akmon;
  using namespace akmon::test;

  struct Model
  {
    Model(const std::vector<Body> &bodies, const std::vector<Material> &materials)
      : discretization(bodies, materials, MPI_COMM_SELF)
      , forces(discretization)
      , frequency(discretization, forces)
    {
    }

    Discretization discretization;
    InternalForces forces;
    AssembledFrequency frequency;
  };


  Body
  block(const std::string &material,
        const std::array<double, 3> &size,
        const std::array<unsigned int, 3> &cells,
        const CellIntegration integration)
  {
    BoxShape shape;
    shape.size    = Vector({size[0], size[1], size[2]});
    shape.cells   = cells;
    Body body     = body_of(shape, integration);
    body.name     = material;
    body.material = material;
    return body;
  }


  Material
  material_of(const std::string &name, const double modulus, const double nu)
  {
    Material material;
    material.name    = name;
    material.density = 1.;
    material.law     = Hypoelastic{Elasticity::from_young(modulus, nu)};
    return material;
  }


  double
  step_over(const double frequency_squared, const double unit)
  {
    return 2. / std::sqrt(frequency_squared) / unit;
  }


  TEST(AssembledFrequency, OfFreeMeshesOfCubesIsTheKnownOne)
  {
    for (const auto &known : cube_meshes)
      {
        const Material material = material_of("cubes", 1., .3);
        Model model({block("cubes",
                           {{.1 * known.cells[0], .1 * known.cells[1], .1 * known.cells[2]}},
                           known.cells,
                           CellIntegration::full)},
                    {material});
        const double dt = step_over(model.frequency.estimate(model.discretization.reference),
                                    .1 / material.dilatational_wave_speed());
        report("free cubes, step over the known one", dt / known.dt);
        EXPECT_LE(dt, known.dt + .5e-4);
        EXPECT_GE(dt, .97 * known.dt);
      }
  }


  // nu = 0: the bar's own highest mode, neighbours in opposite directions, has omega = 2 c/h
  // exactly.
  TEST(AssembledFrequency, OfABarIsTwiceTheWaveSpeedOverTheCell)
  {
    const Material material = material_of("bar", 4., 0.);
    Model model({block("bar", {{1., 1., 2.}}, {{1, 1, 20}}, CellIntegration::full)}, {material});
    const double bound = model.frequency.estimate(model.discretization.reference);
    report("bar, omega h/c", std::sqrt(bound) * .1 / 2.);
    EXPECT_GE(std::sqrt(bound) * .1 / 2., 2. * (1. - 1e-12));
    EXPECT_LE(std::sqrt(bound) * .1 / 2., 2. * 1.005);
  }


  // The stiffer body's, whatever the other one has.
  TEST(AssembledFrequency, OfTwoBodiesIsThatOfTheOneThatGoverns)
  {
    Body soft               = block("soft", {{.4, .4, .4}}, {{4, 4, 4}}, CellIntegration::full);
    soft.position           = Vector({5., 0., 0.});
    const Body stiff        = block("stiff", {{.4, .4, .4}}, {{4, 4, 4}}, CellIntegration::full);
    const Material of_stiff = material_of("stiff", 3., .3);
    Model model({soft, stiff}, {material_of("soft", 1., .3), of_stiff});
    const double dt = step_over(model.frequency.estimate(model.discretization.reference),
                                .1 / of_stiff.dilatational_wave_speed());
    EXPECT_LE(dt, .9579 + .5e-4);
    EXPECT_GE(dt, .97 * .9579);
  }


  // Layers of unlike thickness: the mode sits in the thinnest ones.
  TEST(AssembledFrequency, IsCloseOnGradedMeshesAndNeverBelow)
  {
    for (const double grading : {1.2, 3., 10.})
      for (const auto integration : integrations)
        {
          CylinderShape cylinder;
          cylinder.radius        = .4;
          cylinder.length        = 1.;
          cylinder.cells_across  = 4;
          cylinder.cells_radial  = 2;
          cylinder.cells_axial   = 16;
          cylinder.sector        = Sector::full;
          cylinder.axial_grading = grading;
          Body body              = body_of(cylinder, integration);
          Model model({body}, {elastic()});
          const double exact = assembled_frequency_squared(model.discretization,
                                                           model.discretization.reference);
          const double ratio = ratio_of_steps(model.frequency.estimate(
                                                model.discretization.reference),
                                              exact);
          report("graded cylinder, estimated over exact step", ratio);
          report("  of its cells", ratio_of_steps(model.forces.largest_cell_bound(), exact));
          EXPECT_LE(ratio, 1.);
          EXPECT_GE(ratio, .97);
        }
  }


  TEST(MassScaling, TakesFrequenciesToTheLimitAndReportsWhatItAdds)
  {
    // All cells alike: four times the mass for twice the step.
    Model all({block("all", {{.2, .2, .2}}, {{2, 2, 2}}, CellIntegration::full)},
              {material_of("all", 1., .3)});
    const double largest = all.forces.largest_cell_bound();
    EXPECT_NEAR(scale_masses(all.discretization, all.forces, .25 * largest), 3., 1e-9);
    EXPECT_NEAR(all.forces.largest_cell_bound() / (.25 * largest), 1., 1e-6);

    // A stiff block of the size of a soft one: only the stiff one's mass, half of all, grows.
    Body soft     = block("soft", {{.2, .2, .2}}, {{2, 2, 2}}, CellIntegration::full);
    soft.position = Vector({5., 0., 0.});
    Model two({soft, block("stiff", {{.2, .2, .2}}, {{2, 2, 2}}, CellIntegration::full)},
              {material_of("soft", 1., .3), material_of("stiff", 2., .3)});
    EXPECT_NEAR(scale_masses(two.discretization, two.forces, largest), .5, 1e-6);
    EXPECT_EQ(scale_masses(two.discretization, two.forces, 2. * largest), 0.);
  }
} // namespace assembled_frequency_test
