#include <akmon/model/mesh_file.h>
#include <akmon/parameters.h>
#include <akmon/rigid/shape_parameters.h>
#include <akmon/rigid/triangle_shape.h>

#include <deal.II/base/utilities.h>

#include <filesystem>
#include <limits>
#include <stdexcept>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    const Patterns::Double positive(1e-300);


    template <typename Declare>
    void
    in_subsection(ParameterHandler &prm, const std::string &name, const Declare &declare)
    {
      prm.enter_subsection(name);
      declare();
      prm.leave_subsection();
    }


    void
    declare_edge_radius(ParameterHandler &prm)
    {
      prm.declare_entry("Edge radius",
                        "0",
                        Patterns::Double(0.),
                        "Radius by which the edges are rounded, 0: sharp (length)");
    }


    double
    edge_radius(ParameterHandler &prm, const std::string &section, const double largest)
    {
      const double radius = prm.get_double("Edge radius");
      if (radius > largest)
        throw InputError(section,
                         "Edge radius",
                         prm.get("Edge radius"),
                         "allowed is at most half the least size");
      return radius;
    }


    std::shared_ptr<const RigidShape>
    make_cylinder(ParameterHandler &prm, const std::string &section)
    {
      const double R      = prm.get_double("Radius");
      const double length = get_number_or("infinite",
                                          prm,
                                          section,
                                          "Length",
                                          positive,
                                          "positive numbers")
                              .value_or(std::numeric_limits<double>::infinity());
      return std::make_shared<RoundBarShape>(R,
                                             length,
                                             edge_radius(prm, section, std::min(R, 0.5 * length)));
    }


    std::shared_ptr<const RigidShape>
    make_box(ParameterHandler &prm, const std::string &section)
    {
      const auto size    = get_vector(prm, section, "Size");
      const double least = std::min({size[0], size[1], size[2]});
      if (!(least > 0.))
        throw InputError(section, "Size", prm.get("Size"), "allowed are three positive numbers");
      return std::make_shared<BlockShape>(size, edge_radius(prm, section, 0.5 * least));
    }


    std::shared_ptr<const RigidShape>
    make_torus(ParameterHandler &prm, const std::string &section)
    {
      const double ring = prm.get_double("Radius"), tube = prm.get_double("Tube radius");
      if (!(tube < ring))
        throw InputError(section,
                         "Tube radius",
                         prm.get("Tube radius"),
                         "it must be less than Radius, that of the ring");
      return std::make_shared<TorusShape>(ring, tube);
    }


    // The boundary of a hexahedral mesh, its quadrilaterals cut in two.
    TriangleMesh
    boundary_of(const BodyMesh &body)
    {
      TriangleMesh mesh;
      for (const auto &vertex : body.vertices)
        mesh.vertices.push_back(vertex);
      for (const auto &face : body.faces.boundary_quads)
        {
          const auto &v = face.vertices; // in deal.II's order
          mesh.triangles.push_back({{v[0], v[1], v[3]}});
          mesh.triangles.push_back({{v[0], v[3], v[2]}});
        }
      return mesh;
    }


    ShapeFromParameters
    make_from_file(ParameterHandler &prm, const std::string &section)
    {
      const std::string name = prm.get("Name");
      const double scale     = prm.get_double("Scale");
      if (name.empty())
        throw InputError(section, "Name", "(none)", "allowed is the path of a surface or mesh");
      try
        {
          const bool stl = std::filesystem::path(name).extension() == ".stl" ||
                           std::filesystem::path(name).extension() == ".STL";
          TriangleMesh mesh = stl ? read_stl(name) : boundary_of(FileShape{name, 1.}.make(section));
          for (auto &vertex : mesh.vertices)
            vertex *= scale;
          ShapeFromParameters result;
          const auto repairs      = make_closed(mesh);
          const std::string where = "[" + section + "] Name = " + name + ": ";
          if (stl) // a mesh's faces have no order that could be wrong
            for (const auto &repair : repairs)
              result.repairs.push_back(where + repair);
          result.shape = std::make_shared<TriangleShape>(mesh);
          return result;
        }
      catch (const InputError &)
        {
          throw;
        }
      catch (const std::runtime_error &error)
        {
          throw InputError(section, "Name", name, error.what());
        }
    }
  } // namespace


  void
  ShapeFromParameters::declare(ParameterHandler &prm)
  {
    prm.declare_entry("Shape",
                      "plane",
                      Patterns::Selection("plane|sphere|cylinder|box|torus|file"),
                      "Shape of the obstacle, around its Point with its z axis along Normal; the "
                      "subsection of that name describes it");
    prm.declare_entry("Side",
                      "outside",
                      Patterns::Selection("outside|inside"),
                      "Where the bodies are: outside of the shape, or inside, as in a container");
    in_subsection(prm, "Sphere", [&]() {
      prm.declare_entry("Radius", "1", positive, "Radius (length)");
    });
    in_subsection(prm, "Cylinder", [&]() {
      prm.declare_entry("Radius", "1", positive, "Radius (length)");
      prm.declare_entry("Length",
                        "infinite",
                        Patterns::Anything(),
                        "Length from end to end along the axis, or 'infinite' (length)");
      declare_edge_radius(prm);
    });
    in_subsection(prm, "Box", [&]() {
      declare_vector(prm, "Size", "1, 1, 1", "Lengths of the edges (length)");
      declare_edge_radius(prm);
    });
    in_subsection(prm, "Torus", [&]() {
      prm.declare_entry("Radius",
                        "1",
                        positive,
                        "Radius of the ring, to the tube's middle (length)");
      prm.declare_entry("Tube radius", "0.25", positive, "Radius of the tube (length)");
    });
    in_subsection(prm, "File", [&]() {
      prm.declare_entry("Name",
                        "",
                        Patterns::Anything(),
                        "A closed surface in STL format, or a hexahedral mesh (as for bodies) "
                        "whose boundary is taken; path of the file");
      prm.declare_entry("Scale",
                        "1",
                        positive,
                        "Factor by which the file's coordinates are multiplied (dimensionless)");
    });
  }


  ShapeFromParameters
  ShapeFromParameters::parse(ParameterHandler &prm, const std::string &section)
  {
    const std::string chosen = prm.get("Shape");
    const bool inside        = prm.get("Side") == "inside";
    ShapeFromParameters result;
    if (chosen == "plane")
      result.shape = std::make_shared<PlaneShape>();
    else if (chosen == "sphere")
      in_subsection(prm, "Sphere", [&]() {
        result.shape = std::make_shared<BallShape>(prm.get_double("Radius"));
      });
    else if (chosen == "cylinder")
      in_subsection(prm, "Cylinder", [&]() {
        result.shape = make_cylinder(prm, section + "/Cylinder");
      });
    else if (chosen == "box")
      in_subsection(prm, "Box", [&]() { result.shape = make_box(prm, section + "/Box"); });
    else if (chosen == "torus")
      in_subsection(prm, "Torus", [&]() { result.shape = make_torus(prm, section + "/Torus"); });
    else
      in_subsection(prm, "File", [&]() { result = make_from_file(prm, section + "/File"); });
    if (inside)
      {
        if (chosen == "plane")
          throw InputError(section, "Side", "inside", "a plane has one side; turn its Normal");
        result.shape = std::make_shared<HollowShape>(result.shape);
      }
    return result;
  }
} // namespace akmon
