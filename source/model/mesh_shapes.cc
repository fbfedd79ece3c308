#include <akmon/model/mesh_description.h>
#include <akmon/model/mesh_shapes.h>
#include <akmon/model/o_grid.h>
#include <akmon/parameters.h>

#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>
#include <deal.II/grid/grid_generator.h>

namespace akmon
{
  double
  get_positive(dealii::ParameterHandler &prm, const std::string &section, const std::string &key)
  {
    const double value = prm.get_double(key);
    if (!(value > 0))
      throw InputError(section, key, prm.get(key), "allowed are numbers above 0");
    return value;
  }


  void
  BoxShape::declare(dealii::ParameterHandler &prm)
  {
    prm.declare_entry(
      "Size",
      "1, 1, 1",
      dealii::Patterns::List(dealii::Patterns::Double(0), 3, 3),
      "Edge lengths Lx, Ly, Lz of the box [length]; the origin of the body's frame is the "
      "box's CENTER, so that it spans -L/2..L/2.");
    prm.declare_entry("Cells",
                      "1, 1, 1",
                      dealii::Patterns::List(dealii::Patterns::Integer(1), 3, 3),
                      "Numbers of cells along x, y and z [-].");
  }


  void
  BoxShape::parse(dealii::ParameterHandler &prm, const std::string &section)
  {
    size             = get_vector(prm, section, "Size");
    const auto texts = split_list(prm.get("Cells"));
    if (texts.size() != 3)
      throw InputError(section, "Cells", prm.get("Cells"), "allowed are three whole numbers");
    for (unsigned int d = 0; d < 3; ++d)
      {
        if (!(size[d] > 0))
          throw InputError(section, "Size", prm.get("Size"), "allowed are three numbers above 0");
        cells[d] = dealii::Utilities::string_to_int(texts[d]);
      }
  }


  BodyMesh
  BoxShape::make(const std::string &) const
  {
    dealii::Triangulation<3> triangulation;
    dealii::GridGenerator::subdivided_hyper_rectangle(triangulation,
                                                      {cells[0], cells[1], cells[2]},
                                                      dealii::Point<3>(-0.5 * size),
                                                      dealii::Point<3>(0.5 * size),
                                                      true);
    return describe_mesh(triangulation, {"x-", "x+", "y-", "y+", "z-", "z+"});
  }


  void
  SphereShape::declare(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Radius",
                      "1",
                      dealii::Patterns::Double(0),
                      "Radius R of the sphere about the origin [length].");
    prm.declare_entry("Cells across",
                      "4",
                      dealii::Patterns::Integer(1),
                      "Number of cells along an edge of the core cube [-].");
    prm.declare_entry("Cells radial",
                      "2",
                      dealii::Patterns::Integer(1),
                      "Number of layers of cells from core to surface [-].");
  }


  void
  SphereShape::parse(dealii::ParameterHandler &prm, const std::string &section)
  {
    radius       = get_positive(prm, section, "Radius");
    cells_across = prm.get_integer("Cells across");
    cells_radial = prm.get_integer("Cells radial");
  }


  BodyMesh
  SphereShape::make(const std::string &) const
  {
    dealii::Triangulation<3> triangulation;
    OGrid<3>(radius, cells_across, cells_radial)
      .create(triangulation, [](const dealii::Point<3> &) { return true; });
    BodyMesh mesh = describe_mesh(triangulation, {"surface"});
    mesh.curved.emplace(0,
                        CurvedSurface{CurvedSurface::Kind::sphere,
                                      dealii::Point<3>(),
                                      dealii::Tensor<1, 3>()});
    return mesh;
  }
} // namespace akmon
