#include <akmon/model/mesh_description.h>
#include <akmon/model/mesh_shapes.h>
#include <akmon/model/o_grid.h>

#include <deal.II/base/patterns.h>
#include <deal.II/grid/grid_tools.h>

namespace akmon
{
  namespace
  {
    // The conformal map of the ball of radius R onto itself that scales the surface at the pole
    // z = -R by the factor g (and at the other one by 1/g): Ahlfors' Moebius transformation
    //
    //     T x = ((1 - s^2) (x - a) - |x - a|^2 a)/(1 - 2 a.x + s^2 |x|^2),   a = s e_z
    //
    // of the unit ball with s = (1 - g)/(1 + g). Being conformal it keeps the angles of small
    // cells, and it keeps the planes x = 0 and y = 0.
    dealii::Point<3>
    towards_pole(const dealii::Point<3> &point, const double radius, const double g)
    {
      const double s = (1. - g) / (1. + g);
      const dealii::Tensor<1, 3> a({0., 0., s}), x = point / radius;
      const auto from_a = x - a;
      const auto image  = (1. - s * s) * from_a - from_a.norm_square() * a;
      return dealii::Point<3>(radius / (1. - 2. * (a * x) + s * s * x.norm_square()) * image);
    }
  } // namespace


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
                      "Number of cells along an edge of the core cube of the full sphere [-]; even "
                      "for a half or quarter.");
    prm.declare_entry("Cells radial",
                      "2",
                      dealii::Patterns::Integer(1),
                      "Number of layers of cells from core to surface [-].");
    declare_sector(prm);
    prm.declare_entry(
      "Pole size",
      "1",
      dealii::Patterns::Double(0),
      "Size of the cells at the pole z = -R over their size in an even mesh [-]; below 1 the mesh "
      "is graded towards that pole, for contact there.");
  }


  void
  SphereShape::parse(dealii::ParameterHandler &prm, const std::string &section)
  {
    radius       = get_positive(prm, section, "Radius");
    cells_across = prm.get_integer("Cells across");
    cells_radial = prm.get_integer("Cells radial");
    sector       = get_sector(prm, section, cells_across);
    pole_size    = get_positive(prm, section, "Pole size");
  }


  BodyMesh
  SphereShape::make(const std::string &) const
  {
    dealii::Triangulation<3> triangulation;
    OGrid<3>(radius, cells_across, cells_radial)
      .create(triangulation, [&](const dealii::Point<3> &x) { return is_in(sector, x); });
    if (pole_size != 1.)
      dealii::GridTools::transform([&](const dealii::Point<3>
                                         &x) { return towards_pole(x, radius, pole_size); },
                                   triangulation);
    // Coordinates in these planes are exact.
    set_boundary_ids(triangulation, [&](const MeshFace &face) {
      return sector != Sector::full && on_plane(face, 0, 0.)    ? 1 :
             sector == Sector::quarter && on_plane(face, 1, 0.) ? 2 :
                                                                  0;
    });
    std::vector<std::string> names = {"surface"};
    if (sector != Sector::full)
      names.push_back("x-");
    if (sector == Sector::quarter)
      names.push_back("y-");
    BodyMesh mesh = describe_mesh(triangulation, names);
    mesh.curved.emplace(0,
                        CurvedSurface{CurvedSurface::Kind::sphere,
                                      dealii::Point<3>(),
                                      dealii::Tensor<1, 3>()});
    return mesh;
  }
} // namespace akmon
