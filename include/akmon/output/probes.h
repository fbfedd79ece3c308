#pragma once

#include <akmon/forces/internal_forces.h>
#include <akmon/model/nodal_state.h>
#include <akmon/output/output_parameters.h>
#include <akmon/time/fidcd.h>

#include <string>
#include <vector>

namespace akmon
{
  /// Displacement, velocity and stress at chosen nodes.
  class Probes
  {
  public:
    /// Throws InputError for unknown bodies and points that are not on their body.
    Probes(const std::vector<Probe> &probes,
           const Discretization &discretization,
           const InternalForces &internal_forces,
           const Fidcd &integrator);

    std::vector<std::string>
    columns() const;

    /// Values in the order of columns(), on all ranks (collective).
    std::vector<double>
    values(const NodalState &state) const;

  private:
    struct Place
    {
      std::string name;
      bool here; ///< this rank owns the node
      unsigned int node;
      // (batches of the body, cell in it) of the cells around the node
      std::vector<std::pair<unsigned int, std::size_t>> cells;
    };

    const Discretization &discretization;
    const InternalForces &internal_forces;
    const Fidcd &integrator;
    std::vector<Place> places;
  };
} // namespace akmon
