#include <akmon/model/mesh_description.h>
#include <akmon/model/mesh_shapes.h>
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
  declare_sector(dealii::ParameterHandler &prm)
  {
    prm.declare_entry(
      "Sector",
      "full",
      dealii::Patterns::Selection("full|half|quarter"),
      "The sector that is meshed: half keeps x >= 0 with the plane of symmetry x-, quarter "
      "keeps x >= 0 and y >= 0 with x- and y-.");
  }


  Sector
  get_sector(dealii::ParameterHandler &prm,
             const std::string &section,
             const unsigned int cells_across)
  {
    const std::string chosen = prm.get("Sector");
    const Sector sector      = chosen == "full" ? Sector::full :
                               chosen == "half" ? Sector::half :
                                                  Sector::quarter;
    if (sector != Sector::full && cells_across % 2 != 0)
      throw InputError(section,
                       "Cells across",
                       prm.get("Cells across"),
                       "allowed are even numbers for Sector = " + chosen);
    return sector;
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
} // namespace akmon
