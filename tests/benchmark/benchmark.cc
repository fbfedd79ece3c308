// Throughput of the cell pass (stress update and internal forces) per core, for both laws and both
// cell integrations. A block is squeezed and sheared a little every pass so that every Gauss point
// works and J2 flows; each figure is the best of several repetitions. Usage: akmon_benchmark [cells
// per edge]

#include <akmon/forces/internal_forces.h>

#include <deal.II/base/mpi.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>

namespace
{
  using namespace akmon;

  Discretization
  block(const unsigned int n, const MaterialLaw &law, const CellIntegration integration)
  {
    Body body;
    BoxShape box;
    box.size         = dealii::Tensor<1, 3>({1., 1., 1.});
    box.cells        = {{n, n, n}};
    body.name        = "block";
    body.material    = "copper";
    body.rotation    = dealii::unit_symmetric_tensor<3>();
    body.integration = integration;
    body.mesh.shape  = box;
    Material copper{"copper", 8930., law};
    return Discretization({body}, {copper}, MPI_COMM_WORLD);
  }


  // Million cell-steps per second of one rank.
  double
  measure(const Discretization &discretization)
  {
    InternalForces internal_forces(discretization);
    NodalVector x = discretization.reference, dx = discretization.make_vector(),
                force = discretization.make_vector();
    for (unsigned int node = 0; node < discretization.n_nodes; ++node)
      {
        const auto X                   = at_node(x, node);
        dx.local_element(3 * node)     = 1e-4 * X[1];
        dx.local_element(3 * node + 1) = 5e-5 * X[1] * X[0];
        dx.local_element(3 * node + 2) = -1e-4 * X[2];
      }
    constexpr unsigned int n_repetitions = 5, n_passes = 4;
    double best = 0.;
    for (unsigned int repetition = 0; repetition < n_repetitions; ++repetition)
      {
        const auto start = std::chrono::steady_clock::now();
        for (unsigned int pass = 0; pass < n_passes; ++pass)
          {
            for (unsigned int i = 0; i < 3 * discretization.n_nodes; ++i)
              x.local_element(i) += dx.local_element(i);
            force = 0.;
            internal_forces.update(x, dx, force);
          }
        const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
        best = std::max(best, 1e-6 * n_passes * discretization.cells.size() / wall.count());
      }
    return best;
  }
} // namespace


int
main(int argc, char **argv)
{
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const unsigned int n        = argc > 1 ? std::atoi(argv[1]) : 60;
  const Elasticity elasticity = Elasticity::from_young(117e9, 0.35);
  const J2Plastic j2{elasticity, 400e6, 100e6};
  const Hypoelastic elastic{elasticity};

  std::printf(
    "cell pass, block of %u^3 cells, %u SIMD lanes, million cell-steps per second and core\n",
    n,
    n_lanes);
  const struct
  {
    const char *name;
    MaterialLaw law;
    CellIntegration integration;
  } variants[] = {{"j2, mean dilatation", j2, CellIntegration::mean_dilatation},
                  {"j2, full", j2, CellIntegration::full},
                  {"hypoelastic, mean dilatation", elastic, CellIntegration::mean_dilatation},
                  {"hypoelastic, full", elastic, CellIntegration::full}};
  for (const auto &variant : variants)
    std::printf("  %-30s %6.2f\n",
                variant.name,
                measure(block(n, variant.law, variant.integration)));
  return 0;
}
