#include <akmon/output/monitor.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>

// What Monitor stops a run for.

namespace akmon
{
  using namespace dealii;

  // The place of the rank with the largest size, as "body 'NAME', near (x, y, z)" (collective).
  std::string
  Monitor::describe(const Extremum &of_rank) const
  {
    const auto sizes       = Utilities::MPI::all_gather(watched.discretization.communicator(),
                                                  of_rank.size);
    const auto root        = std::max_element(sizes.begin(), sizes.end()) - sizes.begin();
    const std::string text = "body '" + watched.discretization.get_bodies()[of_rank.body].name +
                             "', near " + place_text(of_rank.place);
    return Utilities::MPI::broadcast(watched.discretization.communicator(), text, root);
  }


  std::string
  Monitor::level() const
  {
    return "step " + std::to_string(watched.state.step) + ", time " +
           shortest_text(watched.state.time) + ": ";
  }


  bool
  Monitor::beyond_penetration_bound() const
  {
    return worst.penetration_relative > parameters.output.penetration_bound;
  }


  void
  Monitor::check_contact() const
  {
    if (beyond_penetration_bound() &&
        parameters.contact_solver.type != ContactSolver::Type::penalty)
      throw RunError(ExitStatus::lost_contact,
                     level() + "contact is lost: a penetration of " +
                       rounded_text(worst.penetration_relative) +
                       " of the cell size is beyond [Output] Penetration bound = " +
                       shortest_text(parameters.output.penetration_bound) + "; deepest is " +
                       describe(deepest));
  }


  // Written so that not a number is beyond any bound.
  bool
  Monitor::energy_fault() const
  {
    return !(std::abs(worst.energy_error) <= parameters.output.energy_error_bound);
  }


  bool
  Monitor::hourglass_fault() const
  {
    return !(std::abs(balance.hourglass) <=
             parameters.output.hourglass_energy_bound * largest_energy);
  }


  void
  Monitor::check_energy() const
  {
    if (!energy_fault() && !hourglass_fault())
      return;
    Extremum fastest;
    for (unsigned int node = 0; node < watched.discretization.n_owned_nodes; ++node)
      if (const double speed = watched.integrator.velocity(node).norm(); !(speed <= fastest.size))
        fastest = {std::isnan(speed) ? std::numeric_limits<double>::infinity() : speed,
                   Point<3>(at_node(watched.state.x, node)),
                   watched.discretization.body_of_node[node]};
    const std::string where = "; fastest is " + describe(fastest);
    if (std::isnan(worst.energy_error))
      throw RunError(ExitStatus::not_a_number, level() + "the energy is not a number" + where);
    if (energy_fault())
      throw RunError(ExitStatus::energy_error,
                     level() + "energy error " + rounded_text(worst.energy_error) +
                       " is beyond the bound " +
                       shortest_text(parameters.output.energy_error_bound) +
                       " ([Output] Energy error bound)" + where);
    throw RunError(ExitStatus::energy_error,
                   level() + "hourglass energy " + rounded_text(balance.hourglass) + " is beyond " +
                     shortest_text(parameters.output.hourglass_energy_bound) +
                     " of the largest energy so far ([Output] Hourglass energy bound); refine the "
                     "mesh or integrate fully");
  }
} // namespace akmon
