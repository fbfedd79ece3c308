#include <akmon/forces/trilinear.h>
#include <akmon/model/body_mesh.h>
#include <akmon/model/discretization.h>
#include <akmon/model/mesh_size.h>
#include <akmon/parameters.h>

#include <deal.II/dofs/dof_renumbering.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/grid/grid_tools.h>

#include <algorithm>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // Volume centroid of a coarse mesh, the same bits on every rank because every rank has all of
    // it.
    Point<3>
    centroid(const BodyMesh &mesh)
    {
      double volume = 0.;
      Point<3> moment;
      for (const auto &cell : mesh.cells)
        {
          Point<3> centre;
          std::vector<Point<3>> corners;
          for (const unsigned int v : cell.vertices)
            {
              corners.push_back(mesh.vertices[v]);
              centre += mesh.vertices[v] / 8.;
            }
          const double cell_volume = GridTools::cell_measure<3>(mesh.vertices,
                                                                ArrayView<const unsigned int>(
                                                                  cell.vertices));
          volume += cell_volume;
          moment += cell_volume * centre;
        }
      return moment / volume;
    }


    // Visit the active cells below (and at) a cell along the space-filling curve.
    template <typename Iterator, typename Visitor>
    void
    visit_along_curve(const Iterator &cell, const Visitor &visitor)
    {
      if (cell->has_children())
        for (unsigned int child = 0; child < cell->n_children(); ++child)
          visit_along_curve(cell->child(child), visitor);
      else if (!cell->is_artificial())
        visitor(cell);
    }


    // The four local corner numbers of a right-handed cell's face, counter-clockwise seen from
    // outside.
    std::array<unsigned int, 4>
    outward_corners(const unsigned int face)
    {
      static constexpr std::array<std::array<unsigned int, 4>, 6> corners = {{{{0, 4, 6, 2}},
                                                                              {{1, 3, 7, 5}},
                                                                              {{0, 1, 5, 4}},
                                                                              {{2, 6, 7, 3}},
                                                                              {{0, 2, 3, 1}},
                                                                              {{4, 5, 7, 6}}}};
      return corners[face];
    }
  } // namespace


  Discretization::Discretization(const std::vector<Body> &bodies,
                                 const std::vector<Material> &materials,
                                 const MPI_Comm communicator,
                                 const ExtraWork &extra_work)
    : triangulation(communicator)
    , fe(FE_Q<3>(1), 3)
    , dof_handler(triangulation)
    , bodies(bodies)
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
    refuse_too_large_meshes(bodies, communicator);
    build_triangulation();
    share_out(extra_work);
    number_nodes();
    collect_cells();
    collect_faces();
    lump_masses();
  }


  void
  Discretization::build_triangulation()
  {
    std::vector<Point<3>> vertices;
    std::vector<CellData<3>> coarse_cells;
    SubCellData boundary;
    std::map<types::boundary_id, CurvedSurface> curved;
    types::boundary_id next_id = 0;

    for (unsigned int b = 0; b < bodies.size(); ++b)
      {
        BodyMesh mesh = make_body_mesh(bodies[b].mesh, "Bodies/" + bodies[b].section_name());
        mesh.place(bodies[b].rotation, bodies[b].position);
        centres.push_back(centroid(mesh));

        const unsigned int first_vertex = vertices.size();
        vertices.insert(vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
        for (auto &cell : mesh.cells)
          {
            for (auto &v : cell.vertices)
              v += first_vertex;
            cell.material_id = b;
            coarse_cells.push_back(cell);
          }
        types::boundary_id largest = 0;
        for (auto &face : mesh.faces.boundary_quads)
          {
            for (auto &v : face.vertices)
              v += first_vertex;
            largest = std::max(largest, face.boundary_id);
            face.boundary_id += next_id;
            boundary.boundary_quads.push_back(face);
          }
        parts.emplace_back();
        for (const auto &[name, ids] : mesh.parts)
          for (const auto id : ids)
            parts.back()[name].insert(id + next_id);
        for (const auto &[id, surface] : mesh.curved)
          curved[id + next_id] = surface;
        next_id += largest + 1;
      }

    triangulation.create_triangulation(vertices, coarse_cells, boundary);
    for (const auto &[id, surface] : curved)
      triangulation.set_manifold(id + 1, *surface.make_manifold());
    for (const auto &cell : triangulation.active_cell_iterators())
      for (const unsigned int f : cell->face_indices())
        if (cell->face(f)->at_boundary() && curved.count(cell->face(f)->boundary_id()) > 0)
          cell->face(f)->set_all_manifold_ids(cell->face(f)->boundary_id() + 1);

    unsigned int deepest = 0;
    for (const auto &body : bodies)
      deepest = std::max(deepest, body.refinement);
    for (unsigned int level = 0; level < deepest; ++level)
      {
        for (const auto &cell : triangulation.active_cell_iterators())
          if (cell->is_locally_owned() && bodies[cell->material_id()].refinement > level)
            cell->set_refine_flag();
        triangulation.execute_coarsening_and_refinement();
      }
  }


  // Ranks keep consecutive stretches of the space-filling curve, of equal work instead of equal
  // numbers of cells.
  void
  Discretization::share_out(const ExtraWork &extra_work)
  {
    if (extra_work.empty())
      return;
    std::vector<unsigned int> extra(triangulation.n_active_cells(), 0);
    types::global_cell_index next_id = first_owned_cell();
    for (const auto tree : triangulation.get_p4est_tree_to_coarse_cell_permutation())
      visit_along_curve(Triangulation<3>::cell_iterator(&triangulation, 0, tree),
                        [&](const Triangulation<3>::cell_iterator &cell) {
                          if (!cell->is_locally_owned())
                            return;
                          const auto found = extra_work.find(next_id++);
                          if (found != extra_work.end())
                            extra[cell->active_cell_index()] = found->second;
                        });
    constexpr unsigned int of_cell = 1000;
    const auto connection          = triangulation.signals.weight.connect(
      [&](const Triangulation<3>::cell_iterator &cell, const Triangulation<3>::CellStatus) {
        return of_cell + extra[cell->active_cell_index()];
      });
    triangulation.repartition();
    connection.disconnect();
  }


  // Number of cells that lower ranks own.
  types::global_cell_index
  Discretization::first_owned_cell() const
  {
    types::global_cell_index n = triangulation.n_locally_owned_active_cells(), first = 0;
    MPI_Exscan(&n,
               &first,
               1,
               Utilities::MPI::mpi_type_id_for_type<types::global_cell_index>,
               MPI_SUM,
               communicator());
    return first;
  }


  void
  Discretization::number_nodes()
  {
    dof_handler.distribute_dofs(fe);
    // First touch along the space-filling curve. Ranks own consecutive stretches of the curve and a
    // shared node belongs to the lowest rank, so the numbers are those of a single rank.
    DoFRenumbering::hierarchical(dof_handler);
    n_owned_nodes = dof_handler.n_locally_owned_dofs() / 3;
  }


  void
  Discretization::collect_cells()
  {
    const IndexSet &owned         = dof_handler.locally_owned_dofs();
    const auto touches_owned_node = [&](const std::vector<types::global_dof_index> &dofs) {
      return std::any_of(dofs.begin(), dofs.end(), [&](const auto i) {
        return owned.is_element(i);
      });
    };

    // Cells along the curve; ids count the owned cells of all lower ranks first.
    std::vector<DoFHandler<3>::cell_iterator> relevant;
    std::vector<types::global_cell_index> ids(triangulation.n_active_cells());
    std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell()), needed;
    types::global_cell_index next_id = first_owned_cell();
    const auto visitor               = [&](const DoFHandler<3>::cell_iterator &cell) {
      const DoFHandler<3>::active_cell_iterator active(cell);
      if (cell->is_locally_owned())
        ids[active->active_cell_index()] = next_id++;
      active->get_dof_indices(dofs);
      if (cell->is_locally_owned() || touches_owned_node(dofs))
        {
          relevant.push_back(cell);
          needed.insert(needed.end(), dofs.begin(), dofs.end());
        }
    };
    for (const auto tree : triangulation.get_p4est_tree_to_coarse_cell_permutation())
      visit_along_curve(DoFHandler<3>::cell_iterator(&triangulation, 0, tree, &dof_handler),
                        visitor);
    GridTools::exchange_cell_data_to_ghosts<types::global_cell_index, DoFHandler<3>>(
      dof_handler,
      [&](const auto &cell) { return ids[cell->active_cell_index()]; },
      [&](const auto &cell, const types::global_cell_index id) {
        ids[cell->active_cell_index()] = id;
      });

    std::sort(needed.begin(), needed.end());
    needed.erase(std::unique(needed.begin(), needed.end()), needed.end());
    IndexSet ghosts(dof_handler.n_dofs());
    ghosts.add_indices(needed.begin(), needed.end());
    ghosts.subtract_set(owned);
    partitioner = std::make_shared<Utilities::MPI::Partitioner>(owned, ghosts, communicator());
    n_nodes     = n_owned_nodes + partitioner->n_ghost_indices() / 3;

    reference.reinit(partitioner);
    body_of_node.resize(n_nodes);
    for (const auto &cell : relevant)
      {
        const DoFHandler<3>::active_cell_iterator active(cell);
        active->get_dof_indices(dofs);
        RelevantCell entry{{},
                           cell->material_id(),
                           cell->is_locally_owned(),
                           ids[active->active_cell_index()],
                           cell};
        for (unsigned int v = 0; v < 8; ++v)
          {
            const unsigned int node = partitioner->global_to_local(dofs[3 * v]) / 3;
            entry.nodes[v]          = node;
            body_of_node[node]      = entry.body;
            for (unsigned int d = 0; d < 3; ++d)
              reference.local_element(3 * node + d) = cell->vertex(v)[d];
          }
        cells.push_back(entry);
      }
    std::stable_sort(cells.begin(), cells.end(), [](const RelevantCell &a, const RelevantCell &b) {
      return a.body < b.body;
    });
  }


  void
  Discretization::collect_faces()
  {
    for (const auto &cell : cells)
      for (unsigned int f = 0; f < 6; ++f)
        if (cell.cell->face(f)->at_boundary())
          {
            const auto corners = outward_corners(f);
            BoundaryFace face{{},
                              cell.cell->face(f)->boundary_id(),
                              6 * cell.id + f,
                              cell.body,
                              cell.owned,
                              cell.cell->measure() / cell.cell->face(f)->measure()};
            for (unsigned int v = 0; v < 4; ++v)
              face.nodes[v] = cell.nodes[corners[v]];
            faces.push_back(face);
          }
    std::sort(faces.begin(), faces.end(), [](const BoundaryFace &a, const BoundaryFace &b) {
      return a.id < b.id;
    });
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
        for (const auto &of_body : parts)
          every.insert(of_body.at("all").begin(), of_body.at("all").end());
        return every;
      }
    const auto colon       = part.find(':');
    const std::string name = colon == std::string::npos ? "all" : part.substr(colon + 1);
    const std::string body = part.substr(0, colon);
    std::set<types::boundary_id> ids;
    for (unsigned int b = 0; b < bodies.size(); ++b)
      if (bodies[b].is_called(body))
        {
          const auto found = parts[b].find(name);
          if (found == parts[b].end())
            {
              std::string known;
              for (const auto &entry : parts[b])
                known += (known.empty() ? "" : ", ") + entry.first;
              throw InputError(section, key, part, "body '" + body + "' has the parts " + known);
            }
          ids.insert(found->second.begin(), found->second.end());
        }
    if (ids.empty())
      body_index(section, key, body); // throws
    return ids;
  }
} // namespace akmon
