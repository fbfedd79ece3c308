#pragma once

#include <akmon/model/body_mesh.h>

#include <deal.II/base/parameter_handler.h>

#include <array>
#include <string>
#include <vector>

namespace akmon
{
  /// The number of an entry, above zero, which a pattern cannot ask for. Throws InputError
  /// (section, key).
  double
  get_positive(dealii::ParameterHandler &prm, const std::string &section, const std::string &key);


  /// The part of a body of revolution about z that is meshed.
  enum class Sector
  {
    full,
    half,   ///< x >= 0
    quarter ///< x >= 0 and y >= 0
  };

  /// The entry "Sector".
  void
  declare_sector(dealii::ParameterHandler &prm);

  /// Throws InputError (section, "Cells across") where the planes of symmetry would cut cells.
  Sector
  get_sector(dealii::ParameterHandler &prm,
             const std::string &section,
             const unsigned int cells_across);

  /// Whether a point belongs to a sector.
  template <int dim>
  bool
  is_in(const Sector sector, const dealii::Point<dim> &x)
  {
    return (sector == Sector::full || x[0] > 0) && (sector != Sector::quarter || x[1] > 0);
  }


  /// Coordinates of n + 1 slices from 0 to exactly `length`; cell lengths grow geometrically, the
  /// last one over the first is `grading`.
  std::vector<double>
  slices(const double length, const unsigned int n, const double grading);


  // Every shape is a value with the same three functions: declare() its keys in the subsection the
  // handler stands in, parse() them (throws InputError, naming `section`), and make() its mesh,
  // complete but for the part "all".

  /// A box with its center at the origin. Parts: x-, x+, y-, y+, z-, z+.
  struct BoxShape
  {
    dealii::Tensor<1, 3> size;         ///< edge lengths; length
    std::array<unsigned int, 3> cells; ///< number of cells along x, y, z
    dealii::Tensor<1, 3> grading = dealii::Tensor<1, 3>(
      {1., 1., 1.}); ///< length of the last cell over that of the first

    static void
    declare(dealii::ParameterHandler &prm);
    void
    parse(dealii::ParameterHandler &prm, const std::string &section);
    /// Number of cells, before any is made; of a full cylinder where this is a sector.
    double
    n_cells() const
    {
      return double(cells[0]) * cells[1] * cells[2];
    }

    BodyMesh
    make(const std::string &section) const;
  };

  /**
   * A solid cylinder along z from z = 0 (part "bottom") to its length ("top") with the lateral
   * surface "side"; sectors have their planes of symmetry as parts "x-" and "y-".
   */
  struct CylinderShape
  {
    double radius; ///< length
    double length; ///< length
    unsigned int cells_across;
    unsigned int cells_radial;
    unsigned int cells_axial;
    Sector sector;
    double axial_grading; ///< length of the last cell over that of the first, along z

    static void
    declare(dealii::ParameterHandler &prm);
    void
    parse(dealii::ParameterHandler &prm, const std::string &section);
    /// Number of cells, before any is made; of a full cylinder where this is a sector.
    double
    n_cells() const
    {
      return (double(cells_across) + 4. * cells_radial) * cells_across * cells_axial;
    }

    BodyMesh
    make(const std::string &section) const;
  };

  /// A hollow cylinder along z from z = 0. Parts: inner, outer, bottom, top.
  struct HollowCylinderShape
  {
    double inner_radius; ///< length
    double outer_radius; ///< length
    double length;       ///< length
    unsigned int cells_radial;
    unsigned int cells_around;
    unsigned int cells_axial;

    static void
    declare(dealii::ParameterHandler &prm);
    void
    parse(dealii::ParameterHandler &prm, const std::string &section);
    /// Number of cells, before any is made; of a full cylinder where this is a sector.
    double
    n_cells() const
    {
      return double(cells_radial) * cells_around * cells_axial;
    }

    BodyMesh
    make(const std::string &section) const;
  };

  /// A solid sphere with its center at the origin. Part: surface; sectors have their planes of
  /// symmetry as parts "x-" and "y-".
  struct SphereShape
  {
    double radius; ///< length
    unsigned int cells_across;
    unsigned int cells_radial;
    Sector sector    = Sector::full;
    double pole_size = 1.; ///< of cells at the pole z = -R over those of an even mesh

    static void
    declare(dealii::ParameterHandler &prm);
    void
    parse(dealii::ParameterHandler &prm, const std::string &section);
    /// Number of cells, before any is made; of a full sphere where this is a sector.
    double
    n_cells() const
    {
      return (double(cells_across) + 6. * cells_radial) * cells_across * cells_across;
    }

    BodyMesh
    make(const std::string &section) const;
  };
} // namespace akmon
