#include <akmon/model/mesh_library.h>
#include <akmon/parameters.h>

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/numbers.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_out.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

namespace
{
  using namespace akmon;
  using dealii::Point;
  using dealii::Tensor;
  using dealii::Triangulation;
  using dealii::numbers::PI;

  BodyMesh
  make(const std::string &input)
  {
    dealii::ParameterHandler prm;
    MeshParameters::declare(prm);
    prm.parse_input_from_string(input);
    MeshParameters parameters;
    parameters.parse(prm, "Bodies/b");
    return make_body_mesh(parameters, "Bodies/b");
  }


  std::string
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


  std::string
  cylinder(const std::string &keys)
  {
    return "set Shape = cylinder\nsubsection Cylinder\n" + keys + "end\n";
  }


  std::string
  file(const std::string &name, const std::string &keys = "")
  {
    return "set Shape = file\nsubsection File\nset Name = " + name + "\n" + keys + "end\n";
  }


  void
  expect_contains(const std::string &text, const std::string &part)
  {
    EXPECT_NE(text.find(part), std::string::npos) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  }


  /// Triangulation of the mesh with its curved surfaces attached to the faces.
  void
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


  Quality
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


  Quality
  quality(const BodyMesh &mesh)
  {
    Triangulation<3> triangulation;
    triangulate(mesh, triangulation);
    return quality(triangulation);
  }


  std::vector<const dealii::CellData<2> *>
  faces_of(const BodyMesh &mesh, const std::string &part)
  {
    std::vector<const dealii::CellData<2> *> faces;
    for (const auto &face : mesh.faces.boundary_quads)
      if (mesh.parts.at(part).count(face.boundary_id) == 1)
        faces.push_back(&face);
    return faces;
  }


  double
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
  void
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


  TEST(MeshLibrary, NonPositiveNumbersAreRefused)
  {
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


  /// A folder of its own for each test's files, removed afterwards.
  class MeshFile : public ::testing::Test
  {
  protected:
    void
    SetUp() override
    {
      folder = std::filesystem::path(::testing::TempDir()) /
               (std::string("akmon_") +
                ::testing::UnitTest::GetInstance()->current_test_info()->name());
      std::filesystem::create_directories(folder);
    }

    void
    TearDown() override
    {
      std::filesystem::remove_all(folder);
    }

    std::string
    write(const std::string &name, const std::string &text) const
    {
      const std::string path = folder / name;
      std::ofstream(path) << text;
      return path;
    }

    template <typename Writer>
    std::string
    write_with(const std::string &name, const Writer &writer) const
    {
      std::ostringstream text;
      dealii::GridOut grid_out;
      grid_out.set_flags(dealii::GridOutFlags::Msh(true));
      grid_out.set_flags(dealii::GridOutFlags::Ucd(false, true));
      writer(grid_out, text);
      return write(name, text.str());
    }

    std::filesystem::path folder;
  };


  // Two cubes side by side along x.
  const std::string nodes = "1, 0,0,0\n2, 1,0,0\n3, 1,1,0\n4, 0,1,0\n"
                            "5, 0,0,1\n6, 1,0,1\n7, 1,1,1\n8, 0,1,1\n"
                            "9, 2,0,0\n10, 2,1,0\n11, 2,0,1\n12, 2,1,1\n";


  TEST_F(MeshFile, FormatsOfDealii)
  {
    Triangulation<3> box;
    dealii::GridGenerator::subdivided_hyper_rectangle(box,
                                                      {2, 3, 4},
                                                      Point<3>(),
                                                      Point<3>(1, 2, 3),
                                                      true);
    const auto names =
      {write_with("a.msh", [&](auto &out, auto &text) { out.write_msh(box, text); }),
       write_with("a.vtk", [&](auto &out, auto &text) { out.write_vtk(box, text); }),
       write_with("a.ucd", [&](auto &out, auto &text) { out.write_ucd(box, text); }),
       write_with("a.inp", [&](auto &out, auto &text) { out.write_ucd(box, text); })};
    const std::map<std::string, double> areas =
      {{"0", 6}, {"1", 6}, {"2", 3}, {"3", 3}, {"4", 2}, {"5", 2}};
    for (const auto &name : names)
      {
        const auto mesh = make(file(name, "set Scale = 2\n"));
        SCOPED_TRACE(name);
        expect_complete(mesh);
        EXPECT_EQ(mesh.cells.size(), 24u);
        EXPECT_NEAR(quality(mesh).volume, 8 * 6, 1e-12);
        EXPECT_EQ(mesh.parts.size(), areas.size() + 1);
        for (const auto &[part, expected] : areas)
          EXPECT_NEAR(area(mesh, part), 4 * expected, 1e-12) << part;
      }
  }


  TEST_F(MeshFile, Abaqus)
  {
    const auto mesh = make(file(write("a.inp",
                                      "*Heading\n two cubes\n** a comment\n*Node\n" + nodes +
                                        "*Element, type=C3D8R, elset=EB1\n"
                                        "1, 1,2,3,4,5,6,7,8\n2, 2,9,10,3,6,11,12,7\n")));
    expect_complete(mesh);
    EXPECT_NEAR(quality(mesh).volume, 2, 1e-14);
    EXPECT_NEAR(area(mesh, "0"), 10, 1e-14);
  }


  TEST_F(MeshFile, AbaqusSurfacesBecomeParts)
  {
    const std::string deck = "*Part, name=P\r\n*Node\n" + nodes +
                             "*Element, type=C3D8, elset=B\n70, 1,2,3,4,5,6,7,8\n"
                             "30, 2,9,10,3,6,11,12,7\n*Nset, nset=N, generate\n1, 8, 1\n"
                             "*Elset, elset=E, generate\n30, 70, 40\n";
    const auto mesh = make(file(
      write("a.inp",
            deck + "*Surface, type=ELEMENT, name=Bottom-7\nE,S1\n"
                   "*Surface, name=SS3\n30, S4\n*Material, name=steel\n*Elastic\n210., 0.3\n")));
    expect_complete(mesh);
    EXPECT_EQ(mesh.parts.size(), 4u); // 0, 3, 7, all
    EXPECT_NEAR(area(mesh, "7"), 2, 1e-14);
    for (const auto *face : faces_of(mesh, "7"))
      EXPECT_EQ(mesh.vertices[face->vertices[0]][2], 0);
    EXPECT_NEAR(area(mesh, "3"), 1, 1e-14);

    const std::map<std::string, std::string> bad =
      {{"*Surface, name=top\nE, S1\n", "surface 'TOP' must have a name that ends in a number"},
       {"*Surface, name=S1\nE, S7\n", "surface 'S1' must list elements"},
       {"*Surface, name=S1\n5, S1\n", "surface 'S1' names the absent element 5"},
       {"*Surface, name=S1\nF, S1\n", "'F' stands where a number is expected"}};
    for (const auto &[surface, message] : bad)
      expect_contains(error_of(file(write("b.inp", deck + surface))), message);
  }


  TEST_F(MeshFile, CellsOfNegativeVolumeAreTurned)
  {
    const auto inverted = make(
      file(write("a.inp",
                 "*NODE\n" + nodes +
                   "*ELEMENT, TYPE=C3D8\n1, 5,6,7,8,1,2,3,4\n2, 6,11,12,7,2,9,10,3\n")));
    EXPECT_GT(quality(inverted).jacobian_min, 0);
    EXPECT_NEAR(quality(inverted).volume, 2, 1e-14);

    std::string gmsh_nodes = nodes;
    std::replace(gmsh_nodes.begin(), gmsh_nodes.end(), ',', ' ');
    const auto mixed = make(
      file(write("a.msh",
                 "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n12\n" + gmsh_nodes +
                   "$EndNodes\n$Elements\n2\n1 5 2 0 1 1 2 3 4 5 6 7 8\n"
                   "2 5 2 0 1 6 11 12 7 2 9 10 3\n$EndElements\n")));
    EXPECT_GT(quality(mixed).jacobian_min, 0);
    EXPECT_NEAR(quality(mixed).volume, 2, 1e-14);
  }


  TEST_F(MeshFile, AbaqusCellsOfMixedOrientationAreRefused)
  {
    const auto name = write("a.inp",
                            "*NODE\n" + nodes +
                              "*ELEMENT, TYPE=C3D8\n1, 1,2,3,4,5,6,7,8\n2, 6,11,12,7,2,9,10,3\n");
    expect_contains(error_of(file(name)), "all cells have positive volume");
  }


  TEST_F(MeshFile, FoldedCellsAreRefused)
  {
    const auto name = write("a.inp",
                            "*NODE\n" + nodes +
                              "*ELEMENT, TYPE=C3D8\n1, 1,2,3,4,5,6,7,8\n2, 2,10,9,3,6,11,12,7\n");
    expect_contains(error_of(file(name)), "cell 2 with its center at (1.5 0.5 0.5) is folded");
  }


  TEST_F(MeshFile, OtherCellsThanHexahedraAreRefused)
  {
    Triangulation<3> box, tetrahedra;
    dealii::GridGenerator::hyper_cube(box);
    dealii::GridGenerator::convert_hypercube_to_simplex_mesh(box, tetrahedra);
    const std::string n = std::to_string(tetrahedra.n_active_cells());
    for (const auto &name :
         {write_with("a.msh", [&](auto &out, auto &text) { out.write_msh(tetrahedra, text); }),
          write_with("a.vtk", [&](auto &out, auto &text) { out.write_vtk(tetrahedra, text); })})
      expect_contains(error_of(file(name)),
                      "Name = " + name + ": only hexahedra are supported, found " + n +
                        " tetrahedra");
    expect_contains(error_of(file(
                      write("a.inp",
                            "*NODE\n" + nodes + "*ELEMENT, TYPE=C3D4\n1, 1,2,4,5\n2, 3,4,2,7\n"))),
                    "only hexahedra are supported, found 2 tetrahedra");
  }


  TEST_F(MeshFile, UnusableFilesAreRefused)
  {
    expect_contains(error_of(file("/no/such/file.msh")),
                    "[Bodies/b/File] Name = /no/such/file.msh: there is no such file");
    expect_contains(error_of(file(folder)), "cannot be read");
    expect_contains(error_of(file(write("empty.msh", ""))), "the file is empty");
    expect_contains(error_of(file(write("mesh.stl", "solid"))), "allowed are files ending in .msh");
    for (const std::string type : {"msh", "vtk", "ucd", "inp"})
      expect_contains(error_of(file(write("bad." + type, "this is\nno mesh\n"))),
                      "not a readable mesh: ");
    expect_contains(error_of(file(write("short.inp", "*NODE\n" + nodes))), "there are no elements");
    expect_contains(error_of("set Shape = file"), "[Bodies/b/File] Name = : allowed is");
  }
} // namespace
