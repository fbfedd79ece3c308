#include <akmon/model/mesh_description.h>
#include <akmon/model/mesh_shapes.h>
#include <akmon/model/o_grid.h>
#include <akmon/parameters.h>

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/numbers.h>
#include <deal.II/base/patterns.h>
#include <deal.II/grid/tria.h>

#include <cmath>

namespace akmon
{
  namespace
  {
    const dealii::Patterns::Double non_negative(0);
    const dealii::Patterns::Integer one_or_more(1);


    // Whether a face of a plane mesh lies where a coordinate is zero.
    bool
    on_axis(const dealii::Triangulation<2>::face_iterator &face, const unsigned int direction)
    {
      return face->vertex(0)[direction] == 0 && face->vertex(1)[direction] == 0;
    }


    // Faces of the ends have ids of their own, others those of the plane mesh. deal.II's
    // extrude_triangulation() needs a kilobyte per cell besides the mesh.
    BodyMesh
    extrude(const dealii::Triangulation<2> &plane,
            const std::vector<double> &coordinates,
            const dealii::types::boundary_id bottom,
            const dealii::types::boundary_id top,
            const std::vector<std::string> &names)
    {
      const unsigned int n_layers = coordinates.size() - 1, n = plane.n_vertices();
      BodyMesh mesh;
      mesh.vertices.reserve(std::size_t(n) * coordinates.size());
      for (const double z : coordinates)
        for (const auto &vertex : plane.get_vertices())
          mesh.vertices.emplace_back(vertex[0], vertex[1], z);

      mesh.cells.reserve(std::size_t(plane.n_active_cells()) * n_layers);
      for (const auto &cell : plane.active_cell_iterators())
        for (unsigned int layer = 0; layer < n_layers; ++layer)
          {
            mesh.cells.emplace_back();
            auto &hexahedron       = mesh.cells.back();
            hexahedron.material_id = 0;
            hexahedron.manifold_id = dealii::numbers::flat_manifold_id;
            for (unsigned int v = 0; v < 8; ++v)
              hexahedron.vertices[v] = cell->vertex_index(v % 4) + (layer + v / 4) * n;
            for (unsigned int f = 0; f < 6; ++f)
              if (f == 4 ? layer == 0 :
                  f == 5 ? layer + 1 == n_layers :
                           cell->face(f)->at_boundary())
                {
                  dealii::CellData<2> face;
                  face.boundary_id = f == 4 ? bottom : f == 5 ? top : cell->face(f)->boundary_id();
                  for (unsigned int v = 0; v < 4; ++v)
                    face.vertices[v] = hexahedron.vertices
                                         [dealii::GeometryInfo<3>::face_to_cell_vertices(f, v)];
                  mesh.faces.boundary_quads.push_back(face);
                }
          }
      for (unsigned int id = 0; id < names.size(); ++id)
        mesh.parts[names[id]].insert(id);
      return mesh;
    }


    const CurvedSurface around_z_axis = {CurvedSurface::Kind::cylinder,
                                         dealii::Point<3>(),
                                         dealii::Point<3>(0, 0, 1)};
  } // namespace


  void
  CylinderShape::declare(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Radius",
                      "1",
                      non_negative,
                      "Radius R of the cylinder about the z axis [length].");
    prm.declare_entry("Length",
                      "1",
                      non_negative,
                      "Length L of the cylinder, from z = 0 to z = L [length].");
    prm.declare_entry(
      "Cells across",
      "4",
      one_or_more,
      "Number of cells along a side of the core square of the full disc [-]; even for a half "
      "or quarter.");
    prm.declare_entry("Cells radial",
                      "2",
                      one_or_more,
                      "Number of layers of cells from core to rim [-].");
    prm.declare_entry("Cells axial", "4", one_or_more, "Number of cells along the length [-].");
    declare_sector(prm);
    prm.declare_entry(
      "Axial grading",
      "1",
      non_negative,
      "Ratio of the length of the last cell (at z = L) to that of the first (at z = 0) [-].");
  }


  void
  CylinderShape::parse(dealii::ParameterHandler &prm, const std::string &section)
  {
    radius        = get_positive(prm, section, "Radius");
    length        = get_positive(prm, section, "Length");
    cells_across  = prm.get_integer("Cells across");
    cells_radial  = prm.get_integer("Cells radial");
    cells_axial   = prm.get_integer("Cells axial");
    axial_grading = get_positive(prm, section, "Axial grading");

    sector = get_sector(prm, section, cells_across);
  }


  BodyMesh
  CylinderShape::make(const std::string &) const
  {
    dealii::Triangulation<2> disc;
    OGrid<2>(radius, cells_across, cells_radial).create(disc, [&](const dealii::Point<2> &x) {
      return is_in(sector, x);
    });
    std::vector<std::string> names = {"side", "bottom", "top"};
    if (sector != Sector::full)
      names.push_back("x-");
    if (sector == Sector::quarter)
      names.push_back("y-");
    // Coordinates in the planes of symmetry are exact (see OGrid).
    for (const auto &face : disc.active_face_iterators())
      if (face->at_boundary())
        face->set_boundary_id(on_axis(face, 0) ? 3 : on_axis(face, 1) ? 4 : 0);
    BodyMesh mesh = extrude(disc, slices(length, cells_axial, axial_grading), 1, 2, names);
    mesh.curved.emplace(0, around_z_axis);
    return mesh;
  }


  void
  HollowCylinderShape::declare(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Inner radius",
                      "0.5",
                      non_negative,
                      "Inner radius Ri, about the z axis [length].");
    prm.declare_entry("Outer radius",
                      "1",
                      non_negative,
                      "Outer radius Ro, above the inner one [length].");
    prm.declare_entry("Length",
                      "1",
                      non_negative,
                      "Length L of the cylinder, from z = 0 to z = L [length].");
    prm.declare_entry("Cells radial", "2", one_or_more, "Number of cells across the wall [-].");
    prm.declare_entry("Cells around",
                      "16",
                      dealii::Patterns::Integer(3),
                      "Number of cells around the circumference [-].");
    prm.declare_entry("Cells axial", "4", one_or_more, "Number of cells along the length [-].");
  }


  void
  HollowCylinderShape::parse(dealii::ParameterHandler &prm, const std::string &section)
  {
    inner_radius = get_positive(prm, section, "Inner radius");
    outer_radius = get_positive(prm, section, "Outer radius");
    length       = get_positive(prm, section, "Length");
    cells_radial = prm.get_integer("Cells radial");
    cells_around = prm.get_integer("Cells around");
    cells_axial  = prm.get_integer("Cells axial");
    if (inner_radius >= outer_radius)
      throw InputError(section,
                       "Inner radius",
                       prm.get("Inner radius"),
                       "allowed are numbers below Outer radius = " + prm.get("Outer radius"));
  }


  BodyMesh
  HollowCylinderShape::make(const std::string &) const
  {
    // deal.II's own rings take either the number of cells around or across, not both.
    std::vector<dealii::Point<2>> vertices;
    std::vector<dealii::CellData<2>> cells;
    for (unsigned int j = 0; j < cells_around; ++j)
      for (unsigned int i = 0; i <= cells_radial; ++i)
        {
          const double angle = 2 * dealii::numbers::PI * j / cells_around;
          const double t     = static_cast<double>(i) / cells_radial;
          const double r     = (1 - t) * inner_radius + t * outer_radius;
          vertices.emplace_back(r * std::cos(angle), r * std::sin(angle));
          if (i == cells_radial)
            continue;
          const unsigned int here = j * (cells_radial + 1) + i;
          const unsigned int next = (j + 1) % cells_around * (cells_radial + 1) + i;
          dealii::CellData<2> cell;
          cell.vertices = {here, here + 1, next, next + 1};
          cells.push_back(cell);
        }
    dealii::Triangulation<2> ring;
    ring.create_triangulation(vertices, cells, dealii::SubCellData());
    const double middle = 0.5 * (inner_radius + outer_radius);
    for (const auto &face : ring.active_face_iterators())
      if (face->at_boundary())
        face->set_boundary_id(face->vertex(0).norm() < middle ? 0 : 1);
    BodyMesh mesh = extrude(ring,
                            slices(length, cells_axial, 1),
                            2,
                            3,
                            {"inner", "outer", "bottom", "top"});
    mesh.curved.emplace(0, around_z_axis);
    mesh.curved.emplace(1, around_z_axis);
    return mesh;
  }
} // namespace akmon
