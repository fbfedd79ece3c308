#pragma once

#include <akmon/rigid/triangle_mesh.h>

#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>

namespace akmon::test
{
  using Vector = dealii::Tensor<1, 3>;


  /// The surface of a box around the origin, two triangles a side, normals outward.
  inline TriangleMesh
  triangle_box(const Vector &size)
  {
    TriangleMesh mesh;
    for (unsigned int i = 0; i < 8; ++i)
      mesh.vertices.push_back(Vector(
        {((i & 1) - 0.5) * size[0], (((i >> 1) & 1) - 0.5) * size[1], ((i >> 2) - 0.5) * size[2]}));
    const unsigned int sides[6][4] =
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto &s : sides)
      {
        mesh.triangles.push_back({{s[0], s[1], s[2]}});
        mesh.triangles.push_back({{s[0], s[2], s[3]}});
      }
    return mesh;
  }


  /// A block whose top is a valley along y with its bottom at the origin, slopes of 45 degrees.
  inline TriangleMesh
  triangle_valley()
  {
    const double profile[5][2] = {{0., 0.}, {1., 1.}, {1., -1.}, {-1., -1.}, {-1., 1.}};
    TriangleMesh mesh;
    for (const double y : {-1., 1.})
      for (const auto &point : profile)
        mesh.vertices.push_back(Vector({point[0], y, point[1]}));
    for (unsigned int i = 0; i < 5; ++i)
      {
        const unsigned int j = (i + 1) % 5;
        mesh.triangles.push_back({{i, j, j + 5}});
        mesh.triangles.push_back({{i, j + 5, i + 5}});
      }
    for (unsigned int i = 1; i < 4; ++i)
      {
        mesh.triangles.push_back({{0, i + 1, i}});
        mesh.triangles.push_back({{5, i + 5, i + 6}});
      }
    if (mesh.volume() < 0.)
      for (auto &triangle : mesh.triangles)
        std::swap(triangle[0], triangle[1]);
    return mesh;
  }


  inline void
  add(TriangleMesh &mesh, const TriangleMesh &other)
  {
    const unsigned int first = mesh.vertices.size();
    mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const auto &t : other.triangles)
      mesh.triangles.push_back({{t[0] + first, t[1] + first, t[2] + first}});
  }


  inline std::string
  ascii_stl(const TriangleMesh &mesh)
  {
    std::ostringstream out;
    out.precision(17);
    out << "solid test\n";
    for (const auto &t : mesh.triangles)
      {
        out << "facet normal 0 0 0\n outer loop\n";
        for (const unsigned int v : t)
          out << "  vertex " << mesh.vertices[v] << "\n";
        out << " endloop\nendfacet\n";
      }
    out << "endsolid test\n";
    return out.str();
  }


  inline std::string
  binary_stl(const TriangleMesh &mesh, const std::string &title = "test")
  {
    std::string out = title;
    out.resize(80, ' ');
    const auto write = [&](const auto value) {
      char bytes[sizeof(value)];
      std::memcpy(bytes, &value, sizeof(value));
      out.append(bytes, sizeof(value));
    };
    write(std::uint32_t(mesh.triangles.size()));
    for (const auto &t : mesh.triangles)
      {
        for (unsigned int d = 0; d < 3; ++d)
          write(0.f);
        for (const unsigned int v : t)
          for (unsigned int d = 0; d < 3; ++d)
            write(float(mesh.vertices[v][d]));
        write(std::uint16_t(0));
      }
    return out;
  }
} // namespace akmon::test
