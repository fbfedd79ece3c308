#include <akmon/model/hexahedron_cell.h>
#include <akmon/output/fields.h>
#include <akmon/output/history.h>
#include <akmon/output/probes.h>
#include <akmon/parameters.h>

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace akmon
{
  using namespace dealii;

  Probes::Probes(const std::vector<Probe> &probes,
                 const Discretization &discretization,
                 const InternalForces &internal_forces,
                 const Fidcd &integrator)
    : discretization(discretization)
    , internal_forces(internal_forces)
    , integrator(integrator)
  {
    for (const auto &probe : probes)
      {
        const std::string section = "Probes/" + probe.name;
        const unsigned int body   = discretization.body_index(section, "Body", probe.body);
        // The closest node of all ranks; among equally close ones the first global number.
        std::pair<double, types::global_dof_index> best(std::numeric_limits<double>::max(),
                                                        numbers::invalid_dof_index);
        unsigned int best_node = 0;
        for (unsigned int node = 0; node < discretization.n_owned_nodes; ++node)
          if (discretization.body_of_node[node] == body)
            {
              const std::pair<double, types::global_dof_index>
                candidate((at_node(discretization.reference, node) - probe.point).norm(),
                          discretization.global_node(node));
              if (candidate < best)
                {
                  best      = candidate;
                  best_node = node;
                }
            }
        const auto all    = Utilities::MPI::all_gather(discretization.communicator(), best);
        const auto winner = *std::min_element(all.begin(), all.end());
        Place place{probe.name, winner == best, best_node, {}};

        double diameter = 0.;
        HexahedronCell hexahedron;
        for (std::size_t c = 0; c < discretization.cells.size(); ++c)
          {
            const auto &cell = discretization.cells[c];
            if (place.here &&
                std::find(cell.nodes.begin(), cell.nodes.end(), best_node) != cell.nodes.end())
              {
                place.cells.emplace_back(cell.body,
                                         c - internal_forces.batches()[cell.body].first_cell);
                diameter = std::max(diameter,
                                    hexahedron.at(discretization.corners_of(cell))->diameter());
              }
          }
        diameter = Utilities::MPI::max(diameter, discretization.communicator());
        if (winner.first > diameter)
          throw InputError(section,
                           "Point",
                           shortest_text(probe.point[0]) + ", " + shortest_text(probe.point[1]) +
                             ", " + shortest_text(probe.point[2]),
                           "it must lie on body '" + probe.body + "', whose closest node is " +
                             shortest_text(winner.first) + " away");
        places.push_back(place);
      }
  }


  std::vector<std::string>
  Probes::columns() const
  {
    std::vector<std::string> names;
    for (const auto &place : places)
      {
        for (const char *const quantity : {".displacement_", ".velocity_"})
          for (const char *const axis : {"x", "y", "z"})
            names.push_back(place.name + quantity + axis);
        for (const char *const component : {"xx", "yy", "zz", "xy", "xz", "yz"})
          names.push_back(place.name + ".stress_" + component);
      }
    return names;
  }


  std::vector<double>
  Probes::values(const NodalState &state) const
  {
    std::vector<double> result;
    for (const auto &place : places)
      {
        std::vector<double> of_place(12, 0.);
        if (place.here)
          {
            const auto u = at_node(state.x, place.node) -
                           at_node(discretization.reference, place.node);
            const auto v = integrator.velocity(place.node);
            for (unsigned int d = 0; d < 3; ++d)
              {
                of_place[d]     = u[d];
                of_place[3 + d] = v[d];
              }
            for (const auto &[body, cell] : place.cells)
              {
                const auto stress = average_over_cell(internal_forces.batches()[body], cell).stress;
                for (unsigned int c = 0; c < 6; ++c)
                  of_place[6 + c] += stress[c] / place.cells.size();
              }
          }
        result.insert(result.end(), of_place.begin(), of_place.end());
      }
    Utilities::MPI::sum(result, discretization.communicator(), result);
    return result;
  }
} // namespace akmon
