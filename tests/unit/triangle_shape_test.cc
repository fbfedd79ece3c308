#include <akmon/rigid/triangle_shape.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>

#include "support/triangles.h"

// Surfaces of triangles: STL files, repair, distances, mass.

namespace triangle_shape_test
{
  using namespace akmon;
  using namespace akmon::test;

  std::string
  failure_of(TriangleMesh mesh)
  {
    try
      {
        make_closed(mesh);
      }
    catch (const std::runtime_error &error)
      {
        return error.what();
      }
    return "none";
  }


  class StlFile : public ::testing::Test
  {
  protected:
    void
    TearDown() override
    {
      std::filesystem::remove(path);
    }

    TriangleMesh
    read(const std::string &content) const
    {
      std::ofstream(path, std::ios::binary) << content;
      return read_stl(path);
    }

    std::string
    refusal(const std::string &content) const
    {
      try
        {
          read(content);
        }
      catch (const std::runtime_error &error)
        {
          return error.what();
        }
      return "none";
    }

    const std::string path = ::testing::TempDir() + "akmon_surface.stl";
  };


  TEST_F(StlFile, AsciiAndBinaryAreTheSame)
  {
    const TriangleMesh box = triangle_box(Vector({1., 2., 3.}));
    for (const auto &content : {ascii_stl(box), binary_stl(box), binary_stl(box, "solid tricky")})
      {
        TriangleMesh mesh = read(content);
        EXPECT_EQ(mesh.triangles.size(), 12u);
        EXPECT_TRUE(make_closed(mesh).empty());
        EXPECT_EQ(mesh.vertices.size(), 8u);
        EXPECT_NEAR(mesh.volume(), 6., 1e-14);
      }
  }


  TEST_F(StlFile, Refused)
  {
    EXPECT_EQ(refusal(""), "the file is empty or cannot be read");
    EXPECT_EQ(refusal("solid nothing\nendsolid nothing\n"), "there are no triangles in it");
    EXPECT_EQ(refusal("v 1 2 3\n"), "line 1 is not that of an STL file, ASCII or binary");
    EXPECT_EQ(refusal("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n"),
              "line 4 is not that of an STL file, ASCII or binary");
    EXPECT_EQ(refusal("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop\nendfacet"),
              "line 6 is not that of an STL file, ASCII or binary");
    const std::string whole = binary_stl(triangle_box(Vector({1., 1., 1.})));
    EXPECT_NE(refusal(whole.substr(0, whole.size() - 7)), "none");
    TriangleMesh not_a_number   = triangle_box(Vector({1., 1., 1.}));
    not_a_number.vertices[3][1] = NAN;
    EXPECT_NE(refusal(binary_stl(not_a_number)).find("not a number"), std::string::npos);
    std::filesystem::remove(path);
    EXPECT_THROW(read_stl(path), std::runtime_error);
  }


  TEST(TriangleMesh, HolesAreRefusedWithTheirPlace)
  {
    TriangleMesh mesh = triangle_box(Vector({2., 2., 2.}));
    mesh.triangles.pop_back();
    const std::string text = failure_of(mesh);
    EXPECT_EQ(text.find("the surface has a hole: 3 edges with a triangle on one side only"), 0u);
    EXPECT_NE(text.find("near ("), std::string::npos);
  }


  TEST(TriangleMesh, FinsAndFlatSurfacesAreRefused)
  {
    TriangleMesh fin = triangle_box(Vector({2., 2., 2.}));
    fin.triangles.push_back(fin.triangles[0]);
    std::swap(fin.triangles.back()[0], fin.triangles.back()[1]);
    fin.triangles.push_back(fin.triangles[0]);
    EXPECT_EQ(failure_of(fin).find("the surface touches itself: 3 edges"), 0u);

    TriangleMesh flat;
    flat.vertices  = {Vector({0., 0., 0.}), Vector({1., 0., 0.}), Vector({0., 1., 0.})};
    flat.triangles = {{{0, 1, 2}}, {{0, 2, 1}}};
    EXPECT_EQ(failure_of(flat).find("a part of the surface encloses no volume"), 0u);
  }


  TEST(TriangleMesh, FlippedNormalsAreTurned)
  {
    TriangleMesh mesh = triangle_box(Vector({1., 1., 1.}));
    std::swap(mesh.triangles[4][0], mesh.triangles[4][1]);
    std::swap(mesh.triangles[7][0], mesh.triangles[7][1]);
    EXPECT_EQ(make_closed(mesh),
              std::vector<std::string>{"2 triangles whose normals pointed inward turned round"});
    EXPECT_NEAR(mesh.volume(), 1., 1e-14);

    for (auto &triangle : mesh.triangles)
      std::swap(triangle[0], triangle[1]);
    EXPECT_EQ(make_closed(mesh),
              std::vector<std::string>{"12 triangles whose normals pointed inward turned round"});
    EXPECT_NEAR(mesh.volume(), 1., 1e-14);
  }


  // Normals of a cavity point into it, and a solid in the cavity is one again.
  TEST(TriangleMesh, CavitiesAreHollow)
  {
    TriangleMesh mesh = triangle_box(Vector({3., 3., 3.}));
    add(mesh, triangle_box(Vector({2., 2., 2.})));
    add(mesh, triangle_box(Vector({1., 1., 1.})));
    EXPECT_EQ(make_closed(mesh),
              std::vector<std::string>{"12 triangles whose normals pointed inward turned round"});
    EXPECT_NEAR(mesh.volume(), 27. - 8. + 1., 1e-12);
    const TriangleShape shape(mesh);
    EXPECT_NEAR(shape.closest(Vector({0.8, 0., 0.})).distance, 0.2, 1e-14);
    EXPECT_NEAR(shape.closest(Vector({1.4, 0., 0.})).distance, -0.1, 1e-14);
  }


  // A T-junction is closed by a triangle of zero area; another has collapsed to a line.
  TEST(TriangleMesh, TrianglesOfZeroArea)
  {
    TriangleMesh mesh = triangle_box(Vector({1., 1., 1.}));
    const auto t      = mesh.triangles[0];
    const auto middle = 0.5 * (mesh.vertices[t[0]] + mesh.vertices[t[1]]);
    mesh.vertices.push_back(middle);
    const unsigned int m = mesh.vertices.size() - 1;
    mesh.triangles[0]    = {{t[0], m, t[2]}};
    mesh.triangles.push_back({{m, t[1], t[2]}});
    mesh.triangles.push_back({{t[0], t[1], m}}); // flat
    mesh.triangles.push_back({{t[0], t[0], t[1]}});
    EXPECT_EQ(make_closed(mesh), std::vector<std::string>{"2 triangles of zero area left out"});
    const TriangleShape shape(mesh);
    EXPECT_NEAR(shape.mass_properties(2.).mass, 2., 1e-14);
    // Above the junction, where the flat triangle has no say.
    const Vector outward = middle / middle.norm();
    EXPECT_NEAR(shape.closest(middle + 0.1 * outward).distance, 0.1, 1e-12);
    EXPECT_LT(shape.closest(middle - 0.1 * outward).distance, 0.);
  }


  // The surface of a box of triangles is that of the box, everywhere.
  TEST(TriangleShape, DistancesToABox)
  {
    std::mt19937 generator(3);
    std::uniform_real_distribution<double> number(-1.5, 1.5);
    const Vector size({1., 2., 1.5});
    TriangleMesh mesh = triangle_box(size);
    make_closed(mesh);
    const TriangleShape shape(mesh);
    const BlockShape block(size, 0.);
    EXPECT_NEAR(shape.radius(), block.radius(), 1e-14);
    for (unsigned int i = 0; i < 5000; ++i)
      {
        const Vector x({number(generator), number(generator), number(generator)});
        const auto actual = shape.closest(x), expected = block.closest(x);
        EXPECT_NEAR(actual.distance, expected.distance, 1e-14);
        EXPECT_NEAR((actual.normal - expected.normal).norm(), 0., 1e-10);
      }
    // On faces, edges and corners themselves.
    EXPECT_NEAR((shape.closest(Vector({0.5, 0.3, 0.2})).normal - Vector({1., 0., 0.})).norm(),
                0.,
                1e-14);
    EXPECT_NEAR((shape.closest(Vector({0.5, 1., 0.2})).normal -
                 Vector({1., 1., 0.}) / std::sqrt(2.))
                  .norm(),
                0.,
                1e-12);
    EXPECT_NEAR((shape.closest(Vector({0.5, 1., 0.75})).normal -
                 Vector({1., 1., 1.}) / std::sqrt(3.))
                  .norm(),
                0.,
                1e-12);
  }


  // In a valley both slopes are near; on a ridge only the closest point counts.
  TEST(TriangleShape, ValleysHaveTwoSides)
  {
    TriangleMesh mesh = triangle_valley();
    ASSERT_TRUE(make_closed(mesh).empty());
    const TriangleShape shape(mesh);
    std::vector<SurfacePoint> parts;
    shape.nearby(Vector({0.01, 0., 0.1}), 0.2, parts);
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_NEAR(parts[0].normal * parts[1].normal, 0., 1e-12);
    EXPECT_NEAR(parts[0].distance, 0.09 / std::sqrt(2.), 1e-12);
    EXPECT_NEAR(parts[1].distance, 0.11 / std::sqrt(2.), 1e-12);
    parts.clear();
    shape.nearby(Vector({0.01, 0., 5.}), 0.2, parts);
    EXPECT_TRUE(parts.empty());
    TriangleMesh box = triangle_box(Vector({2., 2., 2.}));
    make_closed(box);
    TriangleShape(box).nearby(Vector({1.1, 1.1, 1.1}), 0.2, parts);
    EXPECT_EQ(parts.size(), 1u);
    // By rounding inside, before a convex edge: the closest side alone.
    parts.clear();
    TriangleShape(box).nearby(Vector({0.99999, 0.5, 1. - 1e-16}), 0.2, parts);
    EXPECT_EQ(parts.size(), 1u);
    parts.clear();
    TriangleShape(box).nearby_from_inside(Vector({0.9, 0.9, 0.5}), 0.2, parts);
    EXPECT_EQ(parts.size(), 2u);
  }


  TEST(TriangleShape, MassOfABox)
  {
    TriangleMesh mesh = triangle_box(Vector({1., 2., 3.}));
    for (auto &x : mesh.vertices)
      x += Vector({5., -7., 11.});
    make_closed(mesh);
    const auto actual   = TriangleShape(mesh).mass_properties(3.);
    const auto expected = BlockShape(Vector({1., 2., 3.}), 0.).mass_properties(3.);
    EXPECT_NEAR(actual.mass, expected.mass, 1e-13 * expected.mass);
    EXPECT_NEAR((actual.centre - dealii::Point<3>(5., -7., 11.)).norm(), 0., 1e-13);
    EXPECT_NEAR((actual.inertia - expected.inertia).norm(), 0., 1e-12 * expected.mass);
  }


  // A box has the same sharp corners and edges, however its sides are cut into triangles; a concave
  // edge is none.
  TEST(SharpFeatures, OfABoxAndOfAValley)
  {
    const Vector size({0.6, 0.5, 0.2});
    const auto exact  = BlockShape(size, 0.).sharp_features(0.35),
               meshed = TriangleShape(triangle_box(size)).sharp_features(0.35);
    ASSERT_EQ(exact.vertices.size(), 8u);
    ASSERT_EQ(exact.edges.size(), 12u);
    ASSERT_EQ(meshed.vertices.size(), 8u);
    ASSERT_EQ(meshed.edges.size(), 12u);
    for (const auto &vertex : exact.vertices)
      EXPECT_TRUE(
        std::any_of(meshed.vertices.begin(), meshed.vertices.end(), [&](const auto &other) {
          return (vertex.place - other.place).norm() < 1e-15 &&
                 (vertex.outward - other.outward).norm() < 1e-15;
        }));
    for (const auto &edge : exact.edges)
      EXPECT_TRUE(std::any_of(meshed.edges.begin(), meshed.edges.end(), [&](const auto &other) {
        const auto middle = [](const SharpFeatures::Edge &of) { return of.ends[0] + of.ends[1]; };
        return (middle(edge) - middle(other)).norm() < 1e-15 &&
               (edge.normals[0] + edge.normals[1] - other.normals[0] - other.normals[1]).norm() <
                 1e-15;
      }));
    EXPECT_TRUE(BlockShape(size, 0.01).sharp_features(0.35).edges.empty());
    for (const auto &edge : TriangleShape(triangle_valley()).sharp_features(0.35).edges)
      EXPECT_GT(std::abs(edge.ends[0][0]) + std::abs(edge.ends[1][0]), 0.);
  }


  // The tip of a cone is sharp though the edges that meet there are not; what is rounder than the
  // angle is not sharp.
  TEST(SharpFeatures, OfATip)
  {
    constexpr unsigned int n = 32;
    for (const double height : {1., 0.02})
      {
        TriangleMesh cone;
        cone.vertices = {Vector({0., 0., height}), Vector({0., 0., -1.})};
        for (unsigned int i = 0; i < n; ++i)
          {
            const double angle = 2. * dealii::numbers::PI * i / n;
            cone.vertices.push_back(Vector({std::cos(angle), std::sin(angle), 0.}));
          }
        for (unsigned int i = 0; i < n; ++i)
          {
            cone.triangles.push_back({{2 + i, 2 + (i + 1) % n, 0}});
            cone.triangles.push_back({{2 + (i + 1) % n, 2 + i, 1}});
          }
        const auto features = TriangleShape(cone).sharp_features(0.35);
        EXPECT_EQ(features.edges.size(), n); // the rim
        const bool has_tip = std::any_of(features.vertices.begin(),
                                         features.vertices.end(),
                                         [&](const auto &vertex) {
                                           return (vertex.place - cone.vertices[0]).norm() <
                                                    1e-15 &&
                                                  vertex.outward[2] > 0.99;
                                         });
        EXPECT_EQ(has_tip, height == 1.);
      }
  }
} // namespace triangle_shape_test
