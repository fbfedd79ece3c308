#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_out.h>
#include <deal.II/grid/grid_tools.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "support/body_mesh.h"

// Meshes read from files: formats, parts, and the files that are refused.

namespace mesh_file_test
{
  using namespace akmon;
  using namespace akmon::test;

  std::string
  file(const std::string &name, const std::string &keys = "")
  {
    return "set Shape = file\nsubsection File\nset Name = " + name + "\n" + keys + "end\n";
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


  void
  expect_two_cubes(const BodyMesh &mesh)
  {
    EXPECT_GT(quality(mesh).jacobian_min, 0);
    EXPECT_NEAR(quality(mesh).volume, 2, 1e-14);
  }


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


  // To the last digit, with nodes in between that no element has.
  TEST_F(MeshFile, AbaqusCoordinatesAreThoseOfTheFile)
  {
    const auto mesh = make(
      file(write("a.inp",
                 "*Node\n1, 0,0,0.1234567890123456\n2, 1,0,0.1234567890123456\n3, 9,9,9\n"
                 "4, 1,1,0.1234567890123456\n5, 0,1,0.1234567890123456\n6, 0,0,1\n7, 1,0,1\n"
                 "8, 1,1,1\n9, 0,1,1\n*Element, type=C3D8\n1, 1,2,4,5,6,7,8,9\n")));
    double least = 1.;
    for (const auto &vertex : mesh.vertices)
      least = std::min(least, vertex[2]);
    EXPECT_EQ(least, 0.1234567890123456);
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
    expect_two_cubes(inverted);

    std::string gmsh_nodes = nodes;
    std::replace(gmsh_nodes.begin(), gmsh_nodes.end(), ',', ' ');
    const auto mixed = make(
      file(write("a.msh",
                 "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n12\n" + gmsh_nodes +
                   "$EndNodes\n$Elements\n2\n1 5 2 0 1 1 2 3 4 5 6 7 8\n"
                   "2 5 2 0 1 6 11 12 7 2 9 10 3\n$EndElements\n")));
    expect_two_cubes(mixed);
  }


  TEST_F(MeshFile, AbaqusCellsOfMixedOrientationAreTurned)
  {
    const auto mixed = make(
      file(write("a.inp",
                 "*NODE\n" + nodes +
                   "*ELEMENT, TYPE=C3D8\n1, 1,2,3,4,5,6,7,8\n2, 6,11,12,7,2,9,10,3\n")));
    expect_two_cubes(mixed);
  }


  // The format that Gmsh writes by default: boundaries are physical tags of surfaces.
  const std::string gmsh_4 =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 7 \"bottom\"\n$EndPhysicalNames\n"
    "$Entities\n1 0 1 1\n1 0 0 0 0\n5 0 0 0 1 1 0 1 7 0\n1 0 0 0 1 1 1 0 1 5\n$EndEntities\n"
    "$Nodes\n1 8 11 18\n3 1 0 8\n11\n12\n13\n14\n15\n16\n17\n18\n"
    "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n$EndNodes\n"
    "$Elements\n2 2 1 2\n2 5 3 1\n1 11 12 13 14\n3 1 5 1\n2 11 12 13 14 15 16 17 18\n$EndElements\n";


  TEST_F(MeshFile, GmshOfVersion4)
  {
    const auto mesh = make(file(write("a.msh", gmsh_4)));
    expect_complete(mesh);
    EXPECT_NEAR(quality(mesh).volume, 1, 1e-14);
    EXPECT_NEAR(area(mesh, "7"), 1, 1e-14);
    for (const auto *face : faces_of(mesh, "7"))
      EXPECT_EQ(mesh.vertices[face->vertices[0]][2], 0);
  }


  // What is wrong in a file is told; deal.II's readers trusted counts and numbers of nodes.
  TEST_F(MeshFile, DamagedFilesAreRefused)
  {
    const auto expect =
      [&](const std::string &from, const std::string &to, const std::string &reason) {
        std::string text = gmsh_4;
        text.replace(text.find(from), from.size(), to);
        expect_contains(error_of(file(write("a.msh", text))), "not a readable mesh: " + reason);
      };
    expect("13 14 15", "13 99 15", "there is no node 99");
    expect("13 14 15", "13 13 15", "cell 1 has a node twice");
    expect("13 14 15", "13 x 15", "'x' stands where a number is expected");
    expect("3 1 0 8", "3 1 0 888888888", "the file cannot hold 888888888 entries");
    expect("\n12\n", "\n11\n", "node 11 is there twice");
    expect("1 1 1\n0 1 1", "1 1 1e200\n0 1 1", "node 17 has no place in space");
    expect("3 1 5 1\n", "3 1 99 1\n", "cells of type '99' are not known");
    expect("11 12 13 14\n3",
           "11 12 13 15\n3",
           "a quadrilateral of boundary 7 is not on the boundary");
    expect("4.1 0 8", "4.1 1 8", "it is binary; save it as ASCII");
    expect("4.1 0 8", "4.0 0 8", "its version is not 1, 2 or 4.1");
    expect("2 11 12 13 14 15 16 17 18\n$EndElements\n",
           "2 11 12",
           "the end of the file stands where");

    const std::string deck = "*NODE\n" + nodes + "*ELEMENT, TYPE=C3D8, ELSET=E\n";
    const std::string cell = "1,2,3,4,5,6,7,8\n";
    expect_contains(error_of(
                      file(write("a.inp", deck + "1, " + cell + "2, " + cell + "3, " + cell))),
                    "more than two cells share a face of cell 3");
    expect_contains(error_of(file(
                      write("a.inp",
                            deck + "1, " + cell + "*ELSET, ELSET=F, GENERATE\n1, 999999999, 1\n"))),
                    "set 'F' has more elements than there are");
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
} // namespace mesh_file_test
