#include <akmon/forces/cell_kernel.h>
#include <akmon/forces/internal_forces.h>
#include <akmon/forces/one_point_cell.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "benchmark.h"
#include "counted_number.h"

namespace akmon::benchmark
{
  namespace
  {
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


    // Displacement per pass at X: squeezes and shears a little, so that every Gauss point works and
    // J2 flows.
    dealii::Tensor<1, 3>
    increment(const dealii::Tensor<1, 3> &X)
    {
      return dealii::Tensor<1, 3>({5e-4 * X[1], 2e-4 * X[1] * X[0], -5e-4 * X[2]});
    }


    // Million cell-steps per second of one rank.
    double
    rate(const Discretization &discretization)
    {
      constexpr unsigned int n_repetitions = 5, n_passes = 4;

      InternalForces internal_forces(discretization);
      NodalVector x = discretization.reference, dx = discretization.make_vector(),
                  force = discretization.make_vector();
      for (unsigned int node = 0; node < discretization.n_nodes; ++node)
        for (unsigned int d = 0; d < 3; ++d)
          dx.local_element(3 * node + d) = increment(at_node(discretization.reference, node))[d];
      internal_forces.govern(internal_forces.largest_frequency_squared());
      double best = 0.;
      for (unsigned int repetition = 0; repetition < n_repetitions; ++repetition)
        {
          double seconds = 0.;
          for (unsigned int pass = 0; pass < n_passes; ++pass)
            {
              for (unsigned int i = 0; i < 3 * discretization.n_nodes; ++i)
                x.local_element(i) += dx.local_element(i);
              force              = 0.;
              const double start = processor_seconds();
              internal_forces.update(x, dx, force);
              seconds += processor_seconds() - start;
              internal_forces.govern(internal_forces.largest_frequency_squared());
            }
          best = std::max(best, 1e-6 * n_passes * discretization.cells.size() / seconds);
        }
      return best;
    }


    // Flops of one cell, counted by running the kernel with numbers that count.
    template <CellIntegration integration, typename Law>
    unsigned long
    flops(const Law &law)
    {
      using N = CountedNumber;
      N x[8][3], dx[8][3], force[8][3];
      for (unsigned int v = 0; v < 8; ++v)
        {
          const dealii::Tensor<1, 3> X({double(v & 1), double((v >> 1) & 1), double(v >> 2)});
          for (unsigned int d = 0; d < 3; ++d)
            {
              dx[v][d] = increment(X)[d];
              x[v][d]  = X[d] + increment(X)[d];
            }
        }
      double state[CellBatches::n_gauss_points * (6 + Law::n_internals)] = {};
      CellPassSums<N> sums;
      N::n_operations = 0;
      if constexpr (integration == CellIntegration::one_point)
        {
          double hourglass[12] = {};
          const HourglassConstants constants(HourglassControl::stiffness,
                                             0.05,
                                             law.elasticity,
                                             1.,
                                             1.);
          update_one_point_cell(law, constants, x, dx, N(1.), state, hourglass, sums, force);
        }
      else
        update_stress_and_force<integration == CellIntegration::mean_dilatation>(law,
                                                                                 x,
                                                                                 dx,
                                                                                 N(1.),
                                                                                 state,
                                                                                 state,
                                                                                 sums,
                                                                                 force);
      // gather and scatter add the forces to the nodes
      return N::n_operations + 24;
    }


    // Bytes of one cell-step from and to memory if every datum travels once: state in and out, node
    // numbers, owned flag, frequency and growth in, growth out; its share of nodes with position
    // and increment in, force in and out.
    double
    bytes(const Discretization &discretization, const CellBatches &batches)
    {
      const double nodes_per_cell = double(discretization.n_nodes) / discretization.cells.size();
      return 2. * 8. * double(batches.state.size() + batches.hourglass.size()) /
               (n_lanes * batches.n_batches()) +
             8. * 4. + 8. + 3. * 8. + nodes_per_cell * 3. * 8. * 4.;
    }


    template <CellIntegration integration, typename Law>
    void
    report(const char *name, const Law &law, const unsigned int n, const Machine &machine)
    {
      const auto discretization = block(n, law, integration);
      const double million      = rate(discretization);
      const double flop         = flops<integration>(law),
                   byte         = bytes(discretization, CellBatches(discretization, 0));
      std::printf("  %-30s %7.2f %9.0f %7.1f %6.0f %% %9.0f %7.1f %6.0f %%\n",
                  name,
                  million,
                  flop,
                  1e-3 * million * flop,
                  1e8 * million * flop / machine.flops_per_second,
                  byte,
                  1e-3 * million * byte,
                  1e8 * million * byte / machine.bytes_per_second);
    }
  } // namespace


  void
  measure_cell_pass(const Machine &machine)
  {
    const Elasticity elasticity = Elasticity::from_young(117e9, 0.35);
    const J2Plastic j2{elasticity, 400e6, 100e6};
    const Hypoelastic elastic{elasticity};
    for (const unsigned int n : {60, 25})
      {
        std::printf("\ncell pass, block of %u^3 cells, per core\n"
                    "  %-30s %7s %9s %7s %8s %9s %7s %8s\n",
                    n,
                    "",
                    "M/s",
                    "flop/cell",
                    "GF/s",
                    "of FMA",
                    "byte/cell",
                    "GB/s",
                    "of triad");
        report<CellIntegration::mean_dilatation>("j2, mean dilatation", j2, n, machine);
        report<CellIntegration::full>("j2, full", j2, n, machine);
        report<CellIntegration::one_point>("j2, one point", j2, n, machine);
        report<CellIntegration::mean_dilatation>("hypoelastic, mean dilatation",
                                                 elastic,
                                                 n,
                                                 machine);
        report<CellIntegration::full>("hypoelastic, full", elastic, n, machine);
      }
  }
} // namespace akmon::benchmark
