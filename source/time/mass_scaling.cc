#include <akmon/time/mass_scaling.h>

#include <deal.II/base/mpi.h>

#include <numeric>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    double
    mass_of_owned_nodes(const Discretization &discretization)
    {
      return std::accumulate(discretization.mass.begin(),
                             discretization.mass.begin() + discretization.n_owned_nodes,
                             0.);
    }
  } // namespace


  double
  scale_masses(Discretization &discretization, InternalForces &forces, const double limit)
  {
    const MPI_Comm communicator = discretization.communicator();
    if (Utilities::MPI::max(forces.largest_cell_bound(), communicator) <= limit)
      return 0.;
    std::vector<double> factors(discretization.cells.size(), 1.);
    for (const auto &batches : forces.batches())
      for (std::size_t cell = 0; cell < batches.n_cells; ++cell)
        factors[batches.first_cell + cell] = std::max(1., batches.frequency_bound(cell) / limit);
    const double before = Utilities::MPI::sum(mass_of_owned_nodes(discretization), communicator);
    discretization.scale_masses(std::move(factors));
    forces.calibrate_initially();
    const double after = Utilities::MPI::sum(mass_of_owned_nodes(discretization), communicator);
    return after / before - 1.;
  }
} // namespace akmon
