#include <akmon/forces/trilinear.h>
#include <akmon/model/discretization.h>
#include <akmon/model/mesh_size.h>
#include <akmon/parameters.h>

#include <algorithm>
#include <functional>
#include <malloc.h>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // What the task throws, all ranks throw.
    void
    on_first_rank(const MPI_Comm communicator, const std::function<void()> &task)
    {
      std::string failure;
      try
        {
          if (Utilities::MPI::this_mpi_process(communicator) == 0)
            task();
        }
      catch (const InputError &error)
        {
          failure = error.what();
        }
      failure = Utilities::MPI::broadcast(communicator, failure);
      if (!failure.empty())
        throw InputError(failure);
    }
  } // namespace


  Discretization::Discretization(const std::vector<Body> &bodies,
                                 const std::vector<Material> &materials,
                                 const MPI_Comm communicator,
                                 const ExtraWork &extra_work)
    : bodies(bodies)
    , materials(materials)
  {
    for (const auto &body : bodies)
      {
        const auto found = std::find_if(materials.begin(), materials.end(), [&](const Material &m) {
          return m.name == body.material;
        });
        if (found == materials.end())
          throw InputError("Bodies/" + body.section_name(),
                           "Material",
                           body.material,
                           "there is no material of this name in Materials/Names");
        body_material.push_back(found - materials.begin());
      }
    refuse_too_large_meshes(bodies);
    GlobalMesh mesh;
    on_first_rank(communicator, [&]() { mesh = make_global_mesh(bodies, outlines); });
    outlines = Utilities::MPI::broadcast(communicator, outlines);
    take(share_out(std::move(mesh), extra_work, communicator), communicator);
    malloc_trim(0); // what the mesh took is kept for further use otherwise
    lump_masses();
  }


  void
  Discretization::take(MeshShare share, const MPI_Comm communicator)
  {
    n_global_cells = share.n_global_cells;
    n_owned_cells  = share.n_owned_cells;
    n_global_nodes = share.n_global_nodes;
    n_owned_nodes  = share.n_owned_nodes;
    n_nodes        = share.nodes.size();
    cells          = std::move(share.cells);
    faces          = std::move(share.faces);

    IndexSet owned(3 * n_global_nodes), ghosts(3 * n_global_nodes);
    owned.add_range(3 * share.first_node, 3 * (share.first_node + share.n_owned_nodes));
    for (const auto node : share.ghost_nodes)
      ghosts.add_range(3 * node, 3 * node + 3);
    partitioner = std::make_shared<Utilities::MPI::Partitioner>(owned, ghosts, communicator);

    reference.reinit(partitioner);
    for (unsigned int node = 0; node < n_nodes; ++node)
      for (unsigned int d = 0; d < 3; ++d)
        reference.local_element(3 * node + d) = share.nodes[node][d];
    body_of_node.resize(n_nodes);
    for (const auto &cell : cells)
      for (const unsigned int node : cell.nodes)
        body_of_node[node] = cell.body;
  }


  void
  Discretization::lump_masses()
  {
    // Not by FEValues, which takes over the Jacobian of a similar cell before: masses would then
    // depend, in their last digits, on which cells a rank has.
    NodalVector lumped = make_vector();
    std::string inverted;
    for (std::size_t c = 0; c < cells.size(); ++c)
      {
        const auto &cell     = cells[c];
        const double density = mass_factor_of(c) * material_of(cell.body).density;
        double X[8][3], cell_mass[8];
        for (unsigned int v = 0; v < 8; ++v)
          for (unsigned int d = 0; d < 3; ++d)
            X[v][d] = reference.local_element(3 * cell.nodes[v] + d);
        lump_cell_mass(X, density, cell_mass);
        for (unsigned int v = 0; v < 8; ++v)
          {
            if (!(cell_mass[v] > 0.))
              inverted = "body '" + bodies[cell.body].name + "': cell " + std::to_string(cell.id) +
                         " is inverted in the initial mesh";
            lumped.local_element(3 * cell.nodes[v]) += cell_mass[v];
          }
      }
    for (const auto &of_rank : Utilities::MPI::all_gather(communicator(), inverted))
      if (!of_rank.empty())
        throw InputError(of_rank);
    // Only owned nodes have all their cells here.
    lumped.update_ghost_values();
    mass.resize(n_nodes);
    for (unsigned int node = 0; node < n_nodes; ++node)
      mass[node] = lumped.local_element(3 * node);
  }


  void
  Discretization::scale_masses(std::vector<double> factors)
  {
    mass_factors = std::move(factors);
    lump_masses();
  }


  std::vector<BoundaryFace>
  Discretization::faces_on(const std::set<types::boundary_id> &ids) const
  {
    std::vector<BoundaryFace> selected;
    for (const auto &face : faces)
      if (ids.count(face.boundary) > 0)
        selected.push_back(face);
    return selected;
  }


  unsigned int
  Discretization::body_index(const std::string &section,
                             const std::string &key,
                             const std::string &name) const
  {
    std::string known;
    for (unsigned int b = 0; b < bodies.size(); ++b)
      {
        if (bodies[b].name == name)
          return b;
        if (bodies[b].copy == 0)
          known += (b ? ", " : "") + bodies[b].name;
        if (b > 0 && bodies[b].copy > 0 && (b + 1 == bodies.size() || bodies[b + 1].copy == 0))
          known += " ... " + bodies[b].name;
      }
    throw InputError(section, key, name, "there is no such body; allowed are " + known);
  }


  std::set<types::boundary_id>
  Discretization::boundary_ids(const std::string &section,
                               const std::string &key,
                               const std::string &part) const
  {
    if (part == "all")
      {
        std::set<types::boundary_id> every;
        for (const auto &outline : outlines)
          every.insert(outline.parts.at("all").begin(), outline.parts.at("all").end());
        return every;
      }
    const auto colon       = part.find(':');
    const std::string name = colon == std::string::npos ? "all" : part.substr(colon + 1);
    const std::string body = part.substr(0, colon);
    std::set<types::boundary_id> ids;
    for (unsigned int b = 0; b < bodies.size(); ++b)
      if (bodies[b].is_called(body))
        {
          const auto &parts = outlines[b].parts;
          const auto found  = parts.find(name);
          if (found == parts.end())
            {
              std::string known;
              for (const auto &entry : parts)
                known += (known.empty() ? "" : ", ") + entry.first;
              throw InputError(section, key, part, "body '" + body + "' has the parts " + known);
            }
          ids.insert(found->second.begin(), found->second.end());
        }
    if (ids.empty())
      body_index(section, key, body); // throws
    return ids;
  }


  std::set<types::boundary_id>
  Discretization::boundary_ids(const std::string &section,
                               const std::string &key,
                               const std::vector<std::string> &parts) const
  {
    std::set<types::boundary_id> ids;
    for (const auto &part : parts)
      ids.merge(boundary_ids(section, key, part));
    return ids;
  }
} // namespace akmon
