#pragma once

#include <akmon/model/mesh_library.h>
#include <akmon/parameters.h>

#include <deal.II/base/geometry_info.h>
#include <deal.II/grid/tria.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <string>
#include <vector>

namespace akmon::test
{
  // Body meshes from their input, and what a mesh must fulfill whatever its shape.

  using dealii::Point;
  using dealii::Tensor;
  using dealii::Triangulation;


  inline BodyMesh
  make(const std::string &input)
  {
    dealii::ParameterHandler prm;
    MeshParameters::declare(prm);
    prm.parse_input_from_string(input);
    MeshParameters parameters;
    parameters.parse(prm, "Bodies/b");
    return make_body_mesh(parameters, "Bodies/b");
  }


  inline std::string
  error_of(const std::string &input)
  {
    try
      {
        make(input);
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "no error";
  }


  inline void
  expect_contains(const std::string &text, const std::string &part)
  {
    EXPECT_NE(text.find(part), std::string::npos) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  }


  /// Triangulation of the mesh with its curved surfaces attached to the faces.
  inline void
  triangulate(const BodyMesh &mesh, Triangulation<3> &triangulation)
  {
    triangulation.create_triangulation(mesh.vertices, mesh.cells, mesh.faces);
    for (const auto &[id, surface] : mesh.curved)
      triangulation.set_manifold(id, *surface.make_manifold());
    for (const auto &face : triangulation.active_face_iterators())
      if (face->at_boundary() && mesh.curved.count(face->boundary_id()) == 1)
        face->set_all_manifold_ids(face->boundary_id());
  }


  struct Quality
  {
    double volume       = 0;
    double smallest     = 1; ///< scaled Jacobian over all corners
    double jacobian_min = std::numeric_limits<double>::max();
  };


  inline Quality
  quality(const Triangulation<3> &triangulation)
  {
    Quality result;
    for (const auto &cell : triangulation.active_cell_iterators())
      {
        result.volume += cell->measure();
        for (const unsigned int corner : cell->vertex_indices())
          {
            const auto xi = dealii::GeometryInfo<3>::unit_cell_vertex(corner);
            Tensor<2, 3> jacobian;
            for (const unsigned int v : cell->vertex_indices())
              jacobian += outer_product(
                dealii::GeometryInfo<3>::d_linear_shape_function_gradient(xi, v), cell->vertex(v));
            const double det    = determinant(jacobian);
            result.jacobian_min = std::min(result.jacobian_min, det);
            result.smallest     = std::min(result.smallest,
                                       det / (jacobian[0].norm() * jacobian[1].norm() *
                                              jacobian[2].norm()));
          }
      }
    return result;
  }


  inline Quality
  quality(const BodyMesh &mesh)
  {
    Triangulation<3> triangulation;
    triangulate(mesh, triangulation);
    return quality(triangulation);
  }


  inline std::vector<const dealii::CellData<2> *>
  faces_of(const BodyMesh &mesh, const std::string &part)
  {
    std::vector<const dealii::CellData<2> *> faces;
    for (const auto &face : mesh.faces.boundary_quads)
      if (mesh.parts.at(part).count(face.boundary_id) == 1)
        faces.push_back(&face);
    return faces;
  }


  inline double
  area(const BodyMesh &mesh, const std::string &part)
  {
    double sum = 0;
    for (const auto *face : faces_of(mesh, part))
      {
        const auto &v = face->vertices;
        const auto &x = mesh.vertices;
        sum += 0.5 * (cross_product_3d(x[v[1]] - x[v[0]], x[v[2]] - x[v[0]]).norm() +
                      cross_product_3d(x[v[1]] - x[v[3]], x[v[2]] - x[v[3]]).norm());
      }
    return sum;
  }


  /// Every boundary face is listed once, and the shape's own parts split the boundary among them.
  inline void
  expect_complete(const BodyMesh &mesh)
  {
    Triangulation<3> triangulation;
    triangulate(mesh, triangulation);
    unsigned int n_faces = 0;
    for (const auto &face : triangulation.active_face_iterators())
      n_faces += face->at_boundary();
    EXPECT_EQ(mesh.faces.boundary_quads.size(), n_faces);
    EXPECT_EQ(faces_of(mesh, "all").size(), n_faces);

    std::set<std::set<unsigned int>> distinct;
    for (const auto &face : mesh.faces.boundary_quads)
      distinct.insert({face.vertices.begin(), face.vertices.end()});
    EXPECT_EQ(distinct.size(), n_faces);

    std::size_t n_in_parts = 0;
    for (const auto &[name, ids] : mesh.parts)
      {
        EXPECT_FALSE(faces_of(mesh, name).empty()) << name;
        if (name != "all")
          n_in_parts += faces_of(mesh, name).size();
      }
    EXPECT_EQ(n_in_parts, n_faces);
  }
} // namespace akmon::test
