#include <akmon/model/abaqus_deck.h>
#include <akmon/model/mesh_description.h>
#include <akmon/model/mesh_file.h>
#include <akmon/model/mesh_shapes.h>
#include <akmon/model/mesh_table.h>
#include <akmon/model/words.h>
#include <akmon/parameters.h>

#include <deal.II/base/exceptions.h>
#include <deal.II/base/geometry_info.h>
#include <deal.II/base/patterns.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/utilities.h>
#include <deal.II/grid/grid_tools.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace akmon
{
  namespace
  {
    /// Why a file is of no use, to be completed with section and key.
    struct Unusable
    {
      std::string reason;
    };


    /// The first sentence of what deal.II says about an exception, on one line.
    std::string
    first_sentence(const std::string &text)
    {
      const std::string heading = "Additional information:";
      const auto at             = text.find(heading);
      std::istringstream stream(at == std::string::npos ? text : text.substr(at + heading.size()));
      std::string word, line;
      while (stream >> word && word != "Stacktrace:")
        {
          line += (line.empty() ? "" : " ") + word;
          if (word.back() == '.')
            break;
        }
      return line;
    }


    std::ifstream
    open(const std::string &name)
    {
      if (!std::filesystem::exists(name))
        throw Unusable{"there is no such file"};
      std::ifstream stream(name);
      if (!std::filesystem::is_regular_file(name) || !stream)
        throw Unusable{"the file cannot be read"};
      if (std::filesystem::file_size(name) == 0)
        throw Unusable{"the file is empty"};
      return stream;
    }


    bool
    is_abaqus(const std::string &name)
    {
      auto stream = open(name);
      for (std::string line; std::getline(stream, line);)
        if (!line.empty() && line[0] == '*')
          return true;
      return false;
    }


    void
    read(const std::string &name, dealii::Triangulation<3> &triangulation)
    {
      auto stream            = open(name);
      const std::string type = upper_case(std::filesystem::path(name).extension().string());
      MeshTable table;
      if (type == ".MSH")
        read_msh(stream, table);
      else if (type == ".VTK")
        read_vtk(stream, table);
      else if (type == ".INP" && is_abaqus(name))
        AbaqusDeck(stream, table);
      else if (type == ".INP" || type == ".UCD")
        read_ucd(stream, table);
      else
        throw Unusable{"allowed are files ending in .msh, .inp, .vtk or .ucd"};
      if (table.n_others() > 0)
        throw Unusable{"only hexahedra are supported, found " + std::to_string(table.n_others()) +
                       " " + table.other_kind()};
      if (table.n_hexahedra() == 0)
        throw Unusable{"the mesh has no cells"};
      table.make_triangulation(triangulation);
    }


    /// Cells of negative volume have been turned; what is still bad at a Gauss point is folded.
    void
    check_jacobians(const dealii::Triangulation<3> &triangulation)
    {
      const dealii::QGauss<3> gauss(2);
      for (const auto &cell : triangulation.active_cell_iterators())
        for (const auto &xi : gauss.get_points())
          {
            dealii::Tensor<2, 3> jacobian;
            for (const unsigned int v : cell->vertex_indices())
              jacobian += outer_product(
                cell->vertex(v), dealii::GeometryInfo<3>::d_linear_shape_function_gradient(xi, v));
            if (!(determinant(jacobian) > 0))
              {
                std::ostringstream message;
                message << "cell " << cell->index() + 1 << " with its center at (" << cell->center()
                        << ") is folded or has no volume";
                throw Unusable{message.str()};
              }
          }
    }
  } // namespace


  void
  FileShape::declare(dealii::ParameterHandler &prm)
  {
    prm.declare_entry(
      "Name",
      "",
      dealii::Patterns::FileName(),
      "Path of the mesh file, relative to the working directory: hexahedra in the format "
      "of Gmsh (.msh), Abaqus (.inp), legacy VTK (.vtk) or UCD (.ucd, .inp).");
    prm.declare_entry(
      "Scale",
      "1",
      dealii::Patterns::Double(0),
      "Factor s that takes the file's coordinates to this model's unit of length [-].");
  }


  void
  FileShape::parse(dealii::ParameterHandler &prm, const std::string &section)
  {
    name  = prm.get("Name");
    scale = get_positive(prm, section, "Scale");
    if (name.empty())
      throw InputError(section, "Name", name, "allowed is the path of a mesh file");
  }


  BodyMesh
  FileShape::make(const std::string &section) const
  {
    const auto error = [&](const std::string &reason) {
      return InputError(section + "/File", "Name", name, reason);
    };
    dealii::Triangulation<3> triangulation;
    try
      {
        read(name, triangulation);
        check_jacobians(triangulation);
      }
    catch (const Unusable &unusable)
      {
        throw error(unusable.reason);
      }
    catch (const dealii::ExceptionBase &exception)
      {
        std::ostringstream info;
        exception.print_info(info);
        throw error("not a readable mesh: " + first_sentence(info.str()));
      }
    catch (const std::exception &exception)
      {
        throw error("not a readable mesh: " + std::string(exception.what()));
      }

    dealii::GridTools::scale(scale, triangulation);
    BodyMesh mesh = describe_mesh(triangulation);
    for (const auto &face : mesh.faces.boundary_quads)
      mesh.parts[std::to_string(face.boundary_id)].insert(face.boundary_id);
    return mesh;
  }
} // namespace akmon
