#include <akmon/forces/cell_kernel.h>
#include <akmon/forces/one_point_cell.h>
#include <akmon/material/j2_plastic.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <random>

// The cell kernels with one number and with SIMD lanes: a cell's result has the same bits wherever
// it stands in a batch and whatever its neighbours are, and is that of scalar arithmetic to
// round-off.

namespace cell_kernel_test
{
  using namespace akmon;

  const J2Plastic copper{Elasticity::from_young(117e9, .35), 400e6, 100e6};
  constexpr unsigned int n_components = 7, n_state = 8 * n_components, n_hourglass = 12;

  enum class Kernel
  {
    full,
    mean_dilatation,
    one_point
  };
  constexpr Kernel kernels[] = {Kernel::full, Kernel::mean_dilatation, Kernel::one_point};


  /// A cell before a step, and what a step makes of it.
  struct Cell
  {
    double x[8][3], dx[8][3];
    double state[n_state], hourglass[n_hourglass], force[8][3];
  };


  // A distorted cell under stress, about to yield or not, and a step as large as a stable one.
  Cell
  random_cell(std::mt19937 &generator)
  {
    std::uniform_real_distribution<double> uniform(-1., 1.);
    Cell cell{};
    for (unsigned int v = 0; v < 8; ++v)
      for (unsigned int d = 0; d < 3; ++d)
        {
          cell.x[v][d]  = 1e-3 * (((v >> d) & 1) + .15 * uniform(generator));
          cell.dx[v][d] = 3e-6 * uniform(generator);
        }
    for (unsigned int i = 0; i < n_state; ++i)
      cell.state[i] = i % n_components < 6 ? 3e8 * uniform(generator) :
                                             std::abs(uniform(generator));
    for (auto &Q : cell.hourglass)
      Q = 10. * uniform(generator);
    return cell;
  }


  // One step with numbers N, n_lanes_of<N> cells at a time.
  template <typename N>
  void
  step(const Kernel kernel, std::array<Cell, n_lanes_of<N>> &cells)
  {
    constexpr unsigned int W = n_lanes_of<N>;
    alignas(lane_alignment) double x[24][W], dx[24][W], state[n_state][W],
      hourglass[n_hourglass][W], force[24][W];
    N X[8][3], dX[8][3], F[8][3];
    for (unsigned int lane = 0; lane < W; ++lane)
      {
        for (unsigned int i = 0; i < 24; ++i)
          {
            x[i][lane]  = cells[lane].x[i / 3][i % 3];
            dx[i][lane] = cells[lane].dx[i / 3][i % 3];
          }
        for (unsigned int i = 0; i < n_state; ++i)
          state[i][lane] = cells[lane].state[i];
        for (unsigned int i = 0; i < n_hourglass; ++i)
          hourglass[i][lane] = cells[lane].hourglass[i];
      }
    for (unsigned int i = 0; i < 24; ++i)
      {
        load(x[i], X[i / 3][i % 3]);
        load(dx[i], dX[i / 3][i % 3]);
      }
    CellPassSums<N> sums;
    if (kernel == Kernel::one_point)
      {
        const HourglassConstants constants(HourglassControl::stiffness,
                                           .05,
                                           copper.elasticity,
                                           8930.,
                                           1e-7);
        update_one_point_cell(copper, constants, X, dX, N(1.), state[0], hourglass[0], sums, F);
      }
    else if (kernel == Kernel::full)
      update_stress_and_force<false>(copper, X, dX, N(1.), state[0], state[0], sums, F);
    else
      update_stress_and_force<true>(copper, X, dX, N(1.), state[0], state[0], sums, F);
    for (unsigned int i = 0; i < 24; ++i)
      store(F[i / 3][i % 3], force[i]);
    for (unsigned int lane = 0; lane < W; ++lane)
      {
        for (unsigned int i = 0; i < 24; ++i)
          cells[lane].force[i / 3][i % 3] = force[i][lane];
        for (unsigned int i = 0; i < n_state; ++i)
          cells[lane].state[i] = state[i][lane];
        for (unsigned int i = 0; i < n_hourglass; ++i)
          cells[lane].hourglass[i] = hourglass[i][lane];
      }
  }


  TEST(CellKernel, SameCellHasTheSameBitsInEveryLane)
  {
    std::mt19937 generator(3);
    for (const Kernel kernel : kernels)
      for (unsigned int trial = 0; trial < 20; ++trial)
        {
          const Cell cell = random_cell(generator);
          Cell first{};
          for (unsigned int place = 0; place < n_lanes; ++place)
            {
              std::array<Cell, n_lanes> batch;
              for (auto &neighbour : batch)
                neighbour = random_cell(generator);
              batch[place] = cell;
              step<Lanes>(kernel, batch);
              if (place == 0)
                first = batch[place];
              EXPECT_EQ(std::memcmp(&batch[place], &first, sizeof(Cell)), 0)
                << "kernel " << int(kernel) << " lane " << place;
            }
        }
  }


  TEST(CellKernel, LanesAgreeWithScalarArithmetic)
  {
    // What cancels in a strain increment of 3e-3 leaves the stresses of an increment, 1e9, to 1e-13
    // of themselves.
    std::mt19937 generator(5);
    for (const Kernel kernel : kernels)
      for (unsigned int trial = 0; trial < 20; ++trial)
        {
          std::array<Cell, n_lanes> batch;
          for (auto &cell : batch)
            cell = random_cell(generator);
          const auto before = batch;
          step<Lanes>(kernel, batch);
          for (unsigned int lane = 0; lane < n_lanes; ++lane)
            {
              std::array<Cell, 1> scalar = {{before[lane]}};
              step<double>(kernel, scalar);
              for (unsigned int i = 0; i < n_state; ++i)
                EXPECT_NEAR(batch[lane].state[i],
                            scalar[0].state[i],
                            i % n_components < 6 ? 1e-3 : 1e-14);
              for (unsigned int i = 0; i < 24; ++i)
                EXPECT_NEAR(batch[lane].force[i / 3][i % 3], scalar[0].force[i / 3][i % 3], 1e-9);
            }
        }
  }
} // namespace cell_kernel_test
