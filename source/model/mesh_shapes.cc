#include <akmon/model/mesh_description.h>
#include <akmon/model/mesh_shapes.h>
#include <akmon/parameters.h>

#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>
#include <deal.II/grid/grid_generator.h>

#include <cmath>

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


  std::vector<double>
  slices(const double length, const unsigned int n, const double grading)
  {
    std::vector<double> coordinates = {0.};
    const double growth             = n > 1 ? std::pow(grading, 1. / (n - 1)) : 1.;
    for (unsigned int i = 0; i < n; ++i)
      coordinates.push_back(coordinates.back() + std::pow(growth, i));
    const double sum = coordinates.back();
    for (double &z : coordinates)
      z *= length / sum;
    coordinates.back() = length;
    return coordinates;
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
    prm.declare_entry("Grading",
                      "1, 1, 1",
                      dealii::Patterns::List(dealii::Patterns::Double(0), 3, 3),
                      "Ratios of the length of the last cell (at +L/2) to that of the first (at "
                      "-L/2) along x, y and z; lengths grow geometrically in between [-].");
  }


  void
  BoxShape::parse(dealii::ParameterHandler &prm, const std::string &section)
  {
    size             = get_vector(prm, section, "Size");
    grading          = get_vector(prm, section, "Grading");
    const auto texts = split_list(prm.get("Cells"));
    if (texts.size() != 3)
      throw InputError(section, "Cells", prm.get("Cells"), "allowed are three whole numbers");
    for (unsigned int d = 0; d < 3; ++d)
      {
        if (!(size[d] > 0))
          throw InputError(section, "Size", prm.get("Size"), "allowed are three numbers above 0");
        if (!(grading[d] > 0))
          throw InputError(section,
                           "Grading",
                           prm.get("Grading"),
                           "allowed are three numbers above 0");
        cells[d] = dealii::Utilities::string_to_int(texts[d]);
      }
  }


  BodyMesh
  BoxShape::make(const std::string &) const
  {
    dealii::Triangulation<3> triangulation;
    const dealii::Point<3> lower(-0.5 * size), upper(0.5 * size);
    if (grading == dealii::Tensor<1, 3>({1., 1., 1.}))
      dealii::GridGenerator::subdivided_hyper_rectangle(triangulation,
                                                        {cells[0], cells[1], cells[2]},
                                                        lower,
                                                        upper,
                                                        true);
    else
      {
        std::vector<std::vector<double>> lengths(3);
        for (unsigned int d = 0; d < 3; ++d)
          {
            const auto coordinates = slices(size[d], cells[d], grading[d]);
            for (unsigned int i = 0; i < cells[d]; ++i)
              lengths[d].push_back(coordinates[i + 1] - coordinates[i]);
          }
        dealii::GridGenerator::subdivided_hyper_rectangle(triangulation,
                                                          lengths,
                                                          lower,
                                                          upper,
                                                          true);
      }
    return describe_mesh(triangulation, {"x-", "x+", "y-", "y+", "z-", "z+"});
  }
} // namespace akmon
