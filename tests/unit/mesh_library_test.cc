#include <deal.II/base/numbers.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "support/body_mesh.h"

// The shapes of the library: exact and converging volumes, quality of the cells, parts, curved
// surfaces, refused input.

namespace mesh_library_test
{
  using namespace akmon;
  using namespace akmon::test;
  using dealii::numbers::PI;

  std::string
  cylinder(const std::string &keys)
  {
    return "set Shape = cylinder\nsubsection Cylinder\n" + keys + "end\n";
  }


  double
  distance_from_axis(const Point<3> &x)
  {
    return std::hypot(x[0], x[1]);
  }


  /// Largest deviation of the part's nodes from the radius, which `distance` measures, after a
  /// refinement.
  template <typename Distance>
  double
  radius_error_refined(const BodyMesh &mesh,
                       const std::string &part,
                       const double radius,
                       const Distance &distance)
  {
    Triangulation<3> triangulation;
    triangulate(mesh, triangulation);
    triangulation.refine_global(1);
    double error = 0;
    for (const auto &face : triangulation.active_face_iterators())
      if (face->at_boundary() && mesh.parts.at(part).count(face->boundary_id()) == 1)
        for (const unsigned int v : face->vertex_indices())
          error = std::max(error, std::abs(distance(face->vertex(v)) - radius));
    EXPECT_GT(quality(triangulation).jacobian_min, 0);
    return error;
  }


  TEST(MeshLibrary, BoxIsExact)
  {
    const auto mesh = make("subsection Box\nset Size = 2, 3, 4\nset Cells = 2, 3, 5\nend\n");
    expect_complete(mesh);
    EXPECT_EQ(mesh.cells.size(), 30u);
    const auto q = quality(mesh);
    EXPECT_NEAR(q.volume, 24, 1e-12);
    EXPECT_NEAR(q.smallest, 1, 1e-12);
    const std::array<double, 3> areas = {{12, 8, 6}};
    const std::array<double, 3> half  = {{1, 1.5, 2}};
    for (unsigned int d = 0; d < 3; ++d)
      for (const int sign : {-1, 1})
        {
          const std::string part = std::string(1, "xyz"[d]) + (sign < 0 ? '-' : '+');
          EXPECT_NEAR(area(mesh, part), areas[d], 1e-12) << part;
          for (const auto *face : faces_of(mesh, part))
            EXPECT_NEAR(mesh.vertices[face->vertices[0]][d], sign * half[d], 1e-14);
        }
  }


  // Cells of 1, 2, 4 along x and 4, 2, 1 along z, and the volume of the box.
  TEST(MeshLibrary, BoxGradingIsTheRatioOfLastToFirstCell)
  {
    const auto mesh = make(
      "subsection Box\nset Size = 7, 2, 7\nset Cells = 3, 2, 3\nset Grading = 4, 1, 0.25\nend\n");
    expect_complete(mesh);
    EXPECT_NEAR(quality(mesh).volume, 98, 1e-12);
    for (const auto &x : mesh.vertices)
      {
        const auto near = [](const double value, const std::vector<double> &allowed) {
          return std::any_of(allowed.begin(), allowed.end(), [&](const double one) {
            return std::abs(value - one) < 1e-12;
          });
        };
        EXPECT_TRUE(near(x[0], {-3.5, -2.5, -0.5, 3.5})) << x;
        EXPECT_TRUE(near(x[1], {-1., 0., 1.})) << x;
        EXPECT_TRUE(near(x[2], {-3.5, 0.5, 2.5, 3.5})) << x;
      }
  }


  TEST(MeshLibrary, CylinderQualityAndParts)
  {
    for (const unsigned int across : {1, 2, 3, 4, 6, 8})
      for (const unsigned int radial : {1, 2, 4})
        {
          const auto mesh = make(cylinder(
            "set Radius = 0.5\nset Length = 2\nset Cells across = " + std::to_string(across) +
            "\nset Cells radial = " + std::to_string(radial) + "\nset Cells axial = 3\n"));
          expect_complete(mesh);
          const auto q = quality(mesh);
          EXPECT_GT(q.jacobian_min, 0);
          EXPECT_GT(q.smallest, 0.6) << across << " across, " << radial << " radial";
          for (const auto *face : faces_of(mesh, "side"))
            for (const unsigned int v : face->vertices)
              EXPECT_NEAR(distance_from_axis(mesh.vertices[v]), 0.5, 1e-15);
          EXPECT_EQ(faces_of(mesh, "side").size(), 3 * 4 * across);
          // The rim is a regular polygon.
          const double polygon = 2 * across * 0.25 * std::sin(2 * PI / (4 * across));
          EXPECT_NEAR(area(mesh, "top"), polygon, 1e-12);
          EXPECT_NEAR(area(mesh, "bottom"), polygon, 1e-12);
          EXPECT_NEAR(q.volume, 2 * polygon, 1e-12);
        }
  }


  TEST(MeshLibrary, CylinderVolumeConverges)
  {
    std::vector<double> errors;
    for (const std::string across : {"4", "8", "16"})
      errors.push_back(
        PI -
        quality(make(cylinder("set Cells axial = 1\nset Cells across = " + across + "\n"))).volume);
    EXPECT_NEAR(errors[0] / errors[1], 4, 0.1);
    EXPECT_NEAR(errors[1] / errors[2], 4, 0.1);
  }


  TEST(MeshLibrary, CylinderSectorsAreHalvesAndQuarters)
  {
    const auto full    = make(cylinder(""));
    const auto half    = make(cylinder("set Sector = half\n"));
    const auto quarter = make(cylinder("set Sector = quarter\n"));
    expect_complete(half);
    expect_complete(quarter);
    EXPECT_EQ(full.cells.size(), 2 * half.cells.size());
    EXPECT_EQ(full.cells.size(), 4 * quarter.cells.size());
    EXPECT_NEAR(quality(full).volume, 2 * quality(half).volume, 1e-12);
    EXPECT_NEAR(quality(full).volume, 4 * quality(quarter).volume, 1e-12);
    EXPECT_NEAR(area(full, "side"), 2 * area(half, "side"), 1e-12);
    EXPECT_NEAR(area(half, "x-"), 2, 1e-12);
    EXPECT_EQ(half.parts.count("y-"), 0u);
    for (const unsigned int d : {0, 1})
      {
        const std::string part = d == 0 ? "x-" : "y-";
        EXPECT_NEAR(area(quarter, part), 1, 1e-12);
        for (const auto *face : faces_of(quarter, part))
          for (const unsigned int v : face->vertices)
            EXPECT_EQ(quarter.vertices[v][d], 0);
      }
    expect_contains(error_of(cylinder("set Sector = half\nset Cells across = 3\n")),
                    "[Bodies/b/Cylinder] Cells across = 3: ");
  }


  TEST(MeshLibrary, CylinderGradingIsTheRatioOfLastToFirstCell)
  {
    const auto mesh = make(
      cylinder("set Length = 7\nset Cells axial = 3\nset Axial grading = 4\n"));
    std::set<double> z;
    for (const auto &x : mesh.vertices)
      z.insert(x[2]);
    ASSERT_EQ(z.size(), 4u);
    const std::vector<double> expected = {0, 1, 3, 7};
    EXPECT_TRUE(std::equal(z.begin(), z.end(), expected.begin(), [](double a, double b) {
      return std::abs(a - b) < 1e-14;
    }));
  }


  TEST(MeshLibrary, CurvedSurfacesSurviveRefinement)
  {
    const auto solid = make(cylinder("set Radius = 3\nset Cells across = 2\n"));
    EXPECT_LT(radius_error_refined(solid, "side", 3, distance_from_axis), 1e-12);
    const auto quarter = make(
      cylinder("set Radius = 3\nset Cells across = 2\nset Sector = quarter\n"));
    EXPECT_LT(radius_error_refined(quarter, "side", 3, distance_from_axis), 1e-12);
    const auto hollow = make("set Shape = hollow cylinder");
    EXPECT_LT(radius_error_refined(hollow, "inner", 0.5, distance_from_axis), 1e-12);
    EXPECT_LT(radius_error_refined(hollow, "outer", 1, distance_from_axis), 1e-12);
    const auto ball = make("set Shape = sphere");
    EXPECT_LT(radius_error_refined(ball, "surface", 1, [](const auto &x) { return x.norm(); }),
              1e-12);
  }


  TEST(MeshLibrary, HollowCylinder)
  {
    const auto mesh = make(
      "set Shape = hollow cylinder\nsubsection Hollow cylinder\n"
      "set Inner radius = 1\nset Outer radius = 2\nset Length = 3\n"
      "set Cells radial = 2\nset Cells around = 12\nset Cells axial = 5\nend\n");
    expect_complete(mesh);
    EXPECT_EQ(mesh.cells.size(), 120u);
    const double ring = 6 * (4 - 1) * std::sin(2 * PI / 12);
    EXPECT_NEAR(quality(mesh).volume, 3 * ring, 1e-12);
    EXPECT_GT(quality(mesh).smallest, 0.9);
    EXPECT_NEAR(area(mesh, "top"), ring, 1e-12);
    EXPECT_NEAR(area(mesh, "bottom"), ring, 1e-12);
    EXPECT_NEAR(area(mesh, "inner"), 12 * 2 * std::sin(PI / 12) * 3, 1e-12);
    EXPECT_NEAR(area(mesh, "outer"), 2 * area(mesh, "inner"), 1e-12);
    expect_contains(error_of("set Shape = hollow cylinder\nsubsection Hollow cylinder\n"
                             "set Inner radius = 1\nend\n"),
                    "[Bodies/b/Hollow cylinder] Inner radius = 1: ");
  }


  TEST(MeshLibrary, Sphere)
  {
    for (const unsigned int across : {1, 2, 4, 5})
      for (const unsigned int radial : {1, 2, 4})
        {
          const auto mesh = make(
            "set Shape = sphere\nsubsection Sphere\nset Radius = 2\nset Cells across = " +
            std::to_string(across) + "\nset Cells radial = " + std::to_string(radial) + "\nend\n");
          expect_complete(mesh);
          EXPECT_EQ(mesh.cells.size(), across * across * (across + 6 * radial));
          EXPECT_EQ(faces_of(mesh, "surface").size(), 6 * across * across);
          const auto q = quality(mesh);
          EXPECT_GT(q.jacobian_min, 0);
          EXPECT_GT(q.smallest, 0.4) << across << " across, " << radial << " radial";
          for (const auto *face : faces_of(mesh, "surface"))
            for (const unsigned int v : face->vertices)
              EXPECT_NEAR(mesh.vertices[v].norm(), 2, 1e-15);
        }
    std::vector<double> errors;
    for (const std::string across : {"4", "8"})
      errors.push_back(4 * PI / 3 -
                       quality(make("set Shape = sphere\nsubsection Sphere\nset Cells across = " +
                                    across + "\nend\n"))
                         .volume);
    EXPECT_NEAR(errors[0] / errors[1], 4, 0.4);
  }


  std::string
  sphere(const std::string &keys)
  {
    return "set Shape = sphere\nsubsection Sphere\nset Cells across = 8\nset Cells radial = 4\n" +
           keys + "end\n";
  }


  TEST(MeshLibrary, SphereSectors)
  {
    const double volume  = quality(make(sphere(""))).volume,
                 surface = area(make(sphere("")), "surface");
    for (const std::string pole_size : {"1", "0.2"})
      {
        const auto whole = make(sphere("set Pole size = " + pole_size + "\n"));
        for (const std::string sector : {"half", "quarter"})
          {
            const auto mesh = make(
              sphere("set Sector = " + sector + "\nset Pole size = " + pole_size + "\n"));
            const double part = sector == "half" ? 2. : 4.;
            expect_complete(mesh);
            EXPECT_EQ(mesh.cells.size(), whole.cells.size() / part);
            EXPECT_NEAR(quality(mesh).volume, quality(whole).volume / part, 1e-12);
            // The area of a warped quadrilateral depends on the corner it is measured from.
            EXPECT_NEAR(area(mesh, "surface"), area(whole, "surface") / part, 1e-3);
            for (unsigned int d = 0; d < (sector == "half" ? 1 : 2); ++d)
              for (const auto *face : faces_of(mesh, d == 0 ? "x-" : "y-"))
                for (const unsigned int v : face->vertices)
                  EXPECT_EQ(mesh.vertices[v][d], 0.);
          }
      }
    EXPECT_NEAR(volume, 4 * PI / 3, 0.1);
    EXPECT_NEAR(surface, 4 * PI, 0.2);
    expect_contains(error_of("set Shape = sphere\nsubsection Sphere\nset Cells across = 3\n"
                             "set Sector = half\nend\n"),
                    "[Bodies/b/Sphere] Cells across = 3: ");
  }


  TEST(MeshLibrary, SphereGradedTowardsThePole)
  {
    // Edges from the pole, and the nodes on the surface.
    const auto edge_at_pole = [](const BodyMesh &mesh) {
      double least = 1e300;
      for (const auto *face : faces_of(mesh, "surface"))
        for (const unsigned int v : face->vertices)
          {
            const auto x = mesh.vertices[v];
            EXPECT_NEAR(x.norm(), 1., 1e-15);
            const double distance = (x - Point<3>(0, 0, -1)).norm();
            if (distance > 1e-12)
              least = std::min(least, distance);
          }
      return least;
    };
    const auto even      = make(sphere(""));
    const double of_even = edge_at_pole(even);
    for (const double g : {0.5, 0.2, 0.1, 2.})
      {
        const auto mesh = make(sphere("set Pole size = " + std::to_string(g) + "\n"));
        EXPECT_NEAR(edge_at_pole(mesh), g * of_even, 0.05 * g * of_even) << g;
        // The map keeps angles: cells stay good but for those as large as the ball.
        EXPECT_GT(quality(mesh).jacobian_min, 0.) << g;
        EXPECT_GT(quality(mesh).smallest, 0.3) << g;
      }
    expect_contains(error_of("set Shape = sphere\nsubsection Sphere\nset Pole size = 0\nend\n"),
                    "[Bodies/b/Sphere] Pole size = 0: ");
  }


  TEST(MeshLibrary, NonPositiveNumbersAreRefused)
  {
    expect_contains(error_of("subsection Box\nset Grading = 1, 0, 1\nend\n"),
                    "[Bodies/b/Box] Grading = 1, 0, 1: ");
    expect_contains(error_of("subsection Box\nset Size = 1, 0, 1\nend\n"),
                    "[Bodies/b/Box] Size = 1, 0, 1: ");
    expect_contains(error_of(cylinder("set Radius = 0\n")), "[Bodies/b/Cylinder] Radius = 0: ");
    EXPECT_ANY_THROW(make(cylinder("set Cells axial = 0\n")));
    EXPECT_ANY_THROW(make("set Shape = cone"));
  }


  TEST(MeshLibrary, NamedPartsOverlapAndKeepTheOthersWhole)
  {
    const auto plain = make(cylinder("set Length = 4\n"));
    const auto mesh  = make(
      "set Named parts = tip: z < 1; low: z<=2 && x>0 ; right: (x > 0) && (z > -1)\n" +
      cylinder("set Length = 4\n"));
    for (const auto &[name, ids] : plain.parts)
      {
        EXPECT_EQ(faces_of(mesh, name).size(), faces_of(plain, name).size()) << name;
        EXPECT_NEAR(area(mesh, name), area(plain, name), 1e-12) << name;
      }
    EXPECT_NEAR(area(mesh, "tip"), area(plain, "side") / 4 + area(plain, "bottom"), 1e-12);
    EXPECT_NEAR(area(mesh, "low"), (area(plain, "side") / 2 + area(plain, "bottom")) / 2, 1e-12);
    EXPECT_NEAR(area(mesh, "right"), area(plain, "all") / 2, 1e-12);
    EXPECT_LT(radius_error_refined(mesh, "side", 1, distance_from_axis), 1e-12);
  }


  TEST(MeshLibrary, BadNamedPartsAreRefused)
  {
    const std::string where = "[Bodies/b] Named parts = ";
    expect_contains(error_of("set Named parts = tip: z > 9"),
                    where + "tip: z > 9: no boundary face");
    expect_contains(error_of("set Named parts = tip: z >"), where + "tip: z >: cannot read");
    expect_contains(error_of("set Named parts = tip: w > 1"), where + "tip: w > 1: cannot read");
    expect_contains(error_of("set Named parts = z > 0"), where + "z > 0: allowed is");
    expect_contains(error_of("set Named parts = x+: z > 0"), where + "x+: z > 0: the name 'x+'");
    expect_contains(error_of("set Named parts = all: z > 0"), where + "all: z > 0: the name 'all'");
  }


  TEST(BodyMesh, PlaceRotatesThenShifts)
  {
    auto mesh = make(cylinder("set Radius = 2\nset Length = 3\n"));
    Tensor<2, 3> rotation; // z -> x, x -> y, y -> z
    rotation[0][2] = rotation[1][0] = rotation[2][1] = 1;
    mesh.place(rotation, Point<3>(10, 20, 30));
    EXPECT_NEAR(quality(mesh).volume, 3 * area(mesh, "top"), 1e-10);
    for (const auto *face : faces_of(mesh, "top"))
      EXPECT_NEAR(mesh.vertices[face->vertices[0]][0], 13, 1e-13);
    EXPECT_LT(radius_error_refined(mesh,
                                   "side",
                                   2,
                                   [](const auto &x) { return std::hypot(x[1] - 20, x[2] - 30); }),
              1e-12);
  }
} // namespace mesh_library_test
