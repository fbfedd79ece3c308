#include <akmon/contact/mobility.h>

#include <deal.II/base/mpi.h>

namespace akmon
{
  using namespace dealii;

  Mobility::Mobility(const Discretization &discretization, const EssentialConditions &conditions)
    : discretization(discretization), conditions(conditions), n_owned(discretization.n_owned_nodes)
  {
  }


  void
  Mobility::reinit(const ContactNodes &nodes)
  {
    if (Utilities::MPI::n_mpi_processes(discretization.communicator()) == 1)
      return;
    NodalVector diagonal     = discretization.make_vector(),
                off_diagonal = discretization.make_vector();
    for (unsigned int node = 0; node < n_owned; ++node)
    {
      const auto W = of_owned(node);
      for (unsigned int d = 0; d < 3; ++d)
      {
        diagonal.local_element(3 * node + d)     = W[d][d];
        off_diagonal.local_element(3 * node + d) = W[(d + 1) % 3][(d + 2) % 3];
      }
    }
    ContactNodes::Field at_diagonal, at_off_diagonal;
    at_diagonal.exchange(nodes, diagonal);
    at_off_diagonal.exchange(nodes, off_diagonal);
    ghosts.resize(nodes.n_ghosts());
    for (unsigned int i = 0; i < ghosts.size(); ++i)
      for (unsigned int d = 0; d < 3; ++d)
      {
        ghosts[i][d][d]                     = at_diagonal[n_owned + i][d];
        ghosts[i][(d + 1) % 3][(d + 2) % 3] = at_off_diagonal[n_owned + i][d];
      }
  }


  double
  Mobility::along(const ContactPair &pair,
                  const Tensor<1, 3> &direction,
                  const double mass_factor) const
  {
    double sum = direction * ((*this)[pair.slave] * direction);
    for (unsigned int k = 0; k < pair.n_masters; ++k)
      sum += pair.N[k] * pair.N[k] * (direction * ((*this)[pair.masters[k]] * direction));
    return sum / mass_factor;
  }
} // namespace akmon
