#include <akmon/model/body_mesh.h>
#include <akmon/model/global_mesh.h>

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/utilities.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <utility>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    using Curve = std::vector<Triangulation<3>::active_cell_iterator>;


    Point<3>
    centroid(const BodyMesh &mesh)
    {
      double volume = 0.;
      Point<3> moment;
      for (const auto &cell : mesh.cells)
        {
          Point<3> centre;
          for (const unsigned int v : cell.vertices)
            centre += mesh.vertices[v] / 8.;
          const double cell_volume = GridTools::cell_measure<3>(mesh.vertices,
                                                                ArrayView<const unsigned int>(
                                                                  cell.vertices));
          volume += cell_volume;
          moment += cell_volume * centre;
        }
      return moment / volume;
    }


    // The coarse meshes of all bodies in one.
    struct CoarseMesh
    {
      std::vector<Point<3>> vertices;
      std::vector<CellData<3>> cells; // material_id = body
      SubCellData boundary;
      std::map<types::boundary_id, CurvedSurface> curved;
      types::boundary_id next_id = 0;

      // Adds a body, whose mesh is used up, and tells its parts.
      std::map<std::string, std::set<types::boundary_id>>
      add(const unsigned int body, BodyMesh mesh)
      {
        const unsigned int first_vertex = vertices.size();
        for (auto &cell : mesh.cells)
          {
            for (auto &v : cell.vertices)
              v += first_vertex;
            cell.material_id = body;
          }
        types::boundary_id largest = 0;
        for (auto &face : mesh.faces.boundary_quads)
          {
            for (auto &v : face.vertices)
              v += first_vertex;
            largest = std::max(largest, face.boundary_id);
            face.boundary_id += next_id;
          }
        append(std::move(mesh.vertices), vertices);
        append(std::move(mesh.cells), cells);
        append(std::move(mesh.faces.boundary_quads), boundary.boundary_quads);

        std::map<std::string, std::set<types::boundary_id>> parts;
        for (const auto &[name, ids] : mesh.parts)
          for (const auto id : ids)
            parts[name].insert(id + next_id);
        for (const auto &[id, surface] : mesh.curved)
          curved[id + next_id] = surface;
        next_id += largest + 1;
        return parts;
      }

    private:
      // Without a copy of the first body, often the only one.
      template <typename T>
      static void
      append(std::vector<T> &&more, std::vector<T> &all)
      {
        if (all.empty())
          all = std::move(more);
        else
          std::move(more.begin(), more.end(), std::back_inserter(all));
      }
    };


    void
    follow_curved_surfaces(Triangulation<3> &triangulation,
                           const std::map<types::boundary_id, CurvedSurface> &curved)
    {
      for (const auto &[id, surface] : curved)
        triangulation.set_manifold(id + 1, *surface.make_manifold());
      for (const auto &cell : triangulation.active_cell_iterators())
        for (const unsigned int f : cell->face_indices())
          if (cell->face(f)->at_boundary() && curved.count(cell->face(f)->boundary_id()) > 0)
            cell->face(f)->set_all_manifold_ids(cell->face(f)->boundary_id() + 1);
    }


    // Points in their order along Hilbert's curve. Its finest cubes are parts of cubes of the given
    // size, so that the cells of a regular mesh come in blocks of 2 x 2 x 2, these of
    // 4 x 4 x 4 and so on.
    std::vector<unsigned int>
    order_along_curve(const std::vector<Point<3>> &points, const double size)
    {
      constexpr int bits = 21; // a direction: three of them are one number

      const BoundingBox<3> box(points);
      double longest = 0.;
      for (unsigned int d = 0; d < 3; ++d)
        longest = std::max(longest, box.side_length(d));
      const double scale = std::ldexp(1. / size, bits - 1 - std::ilogb(longest / size + 1.));
      std::vector<std::array<std::uint64_t, 3>> places(points.size());
      for (std::size_t i = 0; i < points.size(); ++i)
        for (unsigned int d = 0; d < 3; ++d)
          places[i][d] = (points[i][d] - box.lower_bound(d) + 0.5 * size) * scale;
      places = Utilities::inverse_Hilbert_space_filling_curve<3>(places, bits);

      std::vector<std::pair<std::uint64_t, unsigned int>> along;
      along.reserve(points.size());
      for (std::size_t i = 0; i < points.size(); ++i)
        along.emplace_back(Utilities::pack_integers<3>(places[i], bits), i);
      std::sort(along.begin(), along.end());
      std::vector<unsigned int> order;
      order.reserve(points.size());
      for (const auto &[place, point] : along)
        order.push_back(point);
      return order;
    }


    // The coarse cells body by body, close ones with close numbers. As they are created, those of a
    // body come one after the other.
    std::vector<unsigned int>
    order_coarse_cells(const Triangulation<3> &triangulation)
    {
      std::vector<unsigned int> order;
      order.reserve(triangulation.n_cells(0));
      for (auto cell = triangulation.begin(0); cell != triangulation.end(0);)
        {
          const unsigned int first = cell->index();
          const auto body          = cell->material_id();
          double volume            = 0.;
          std::vector<Point<3>> centres;
          for (; cell != triangulation.end(0) && cell->material_id() == body; ++cell)
            {
              centres.push_back(cell->center());
              volume += cell->measure();
            }
          for (const unsigned int i :
               order_along_curve(centres, std::cbrt(volume / centres.size())))
            order.push_back(first + i);
        }
      return order;
    }


    void
    refine(Triangulation<3> &triangulation, const std::vector<Body> &bodies)
    {
      unsigned int deepest = 0;
      for (const auto &body : bodies)
        deepest = std::max(deepest, body.refinement);
      for (unsigned int level = 0; level < deepest; ++level)
        {
          for (const auto &cell : triangulation.active_cell_iterators())
            if (bodies[cell->material_id()].refinement > level)
              cell->set_refine_flag();
          triangulation.execute_coarsening_and_refinement();
        }
    }


    // The active cells below (and at) a cell; children are numbered along Morton's curve.
    void
    follow_curve(const Triangulation<3>::cell_iterator &cell, Curve &curve)
    {
      if (cell->has_children())
        for (unsigned int child = 0; child < cell->n_children(); ++child)
          follow_curve(cell->child(child), curve);
      else
        curve.emplace_back(cell);
    }


    // Number the nodes in the order in which the cells along the curve come upon them.
    void
    number_nodes(DoFHandler<3> &dof_handler, const Curve &curve)
    {
      std::vector<types::global_dof_index> numbers(dof_handler.n_dofs(),
                                                   numbers::invalid_dof_index);
      std::vector<types::global_dof_index> nodes(dof_handler.get_fe().n_dofs_per_cell());
      types::global_dof_index next = 0;
      for (const auto &cell : curve)
        {
          DoFHandler<3>::active_cell_iterator(&dof_handler.get_triangulation(),
                                              cell->level(),
                                              cell->index(),
                                              &dof_handler)
            ->get_dof_indices(nodes);
          for (const auto node : nodes)
            if (numbers[node] == numbers::invalid_dof_index)
              numbers[node] = next++;
        }
      dof_handler.renumber_dofs(numbers);
    }


    // What is needed of the mesh when deal.II's objects are gone.
    GlobalMesh
    describe(const DoFHandler<3> &dof_handler, const Curve &curve)
    {
      GlobalMesh mesh;
      mesh.cells.reserve(curve.size());
      mesh.body_of_cell.reserve(curve.size());
      mesh.nodes.resize(dof_handler.n_dofs());
      std::vector<types::global_dof_index> nodes(dof_handler.get_fe().n_dofs_per_cell());
      for (const auto &cell : curve)
        {
          DoFHandler<3>::active_cell_iterator(&dof_handler.get_triangulation(),
                                              cell->level(),
                                              cell->index(),
                                              &dof_handler)
            ->get_dof_indices(nodes);
          for (const unsigned int v : cell->vertex_indices())
            mesh.nodes[nodes[v]] = cell->vertex(v);
          for (const unsigned int f : cell->face_indices())
            if (const auto face = cell->face(f); face->at_boundary())
              mesh.faces.push_back({static_cast<types::global_cell_index>(mesh.cells.size()),
                                    f,
                                    face->boundary_id(),
                                    cell->measure() / face->measure()});
          mesh.cells.emplace_back();
          std::copy(nodes.begin(), nodes.end(), mesh.cells.back().begin());
          mesh.body_of_cell.push_back(cell->material_id());
        }
      return mesh;
    }
  } // namespace


  GlobalMesh
  make_global_mesh(const std::vector<Body> &bodies, std::vector<BodyOutline> &outlines)
  {
    Triangulation<3> triangulation;
    {
      CoarseMesh coarse;
      for (unsigned int b = 0; b < bodies.size(); ++b)
        {
          BodyMesh mesh = make_body_mesh(bodies[b].mesh, "Bodies/" + bodies[b].section_name());
          mesh.place(bodies[b].rotation, bodies[b].position);
          const auto centre = centroid(mesh);
          outlines.push_back({coarse.add(b, std::move(mesh)), centre});
        }
      triangulation.create_triangulation(coarse.vertices, coarse.cells, coarse.boundary);
      follow_curved_surfaces(triangulation, coarse.curved);
    }
    const auto coarse_cells = order_coarse_cells(triangulation);
    refine(triangulation, bodies);

    Curve curve;
    curve.reserve(triangulation.n_active_cells());
    for (const unsigned int cell : coarse_cells)
      follow_curve(Triangulation<3>::cell_iterator(&triangulation, 0, cell), curve);

    const FE_Q<3> trilinear(1); // a number for each node
    DoFHandler<3> dof_handler(triangulation);
    dof_handler.distribute_dofs(trilinear);
    number_nodes(dof_handler, curve);
    return describe(dof_handler, curve);
  }
} // namespace akmon
