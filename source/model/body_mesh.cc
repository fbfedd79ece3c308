#include <akmon/model/body_mesh.h>

#include <deal.II/grid/manifold_lib.h>

namespace akmon
{
  std::unique_ptr<dealii::Manifold<3>>
  CurvedSurface::make_manifold() const
  {
    if (kind == Kind::sphere)
      return std::make_unique<dealii::SphericalManifold<3>>(center);
    return std::make_unique<dealii::CylindricalManifold<3>>(axis, center);
  }


  void
  BodyMesh::place(const dealii::Tensor<2, 3> &rotation, const dealii::Tensor<1, 3> &shift)
  {
    const auto moved = [&](const dealii::Point<3> &x) {
      return dealii::Point<3>(rotation * x + shift);
    };
    for (auto &vertex : vertices)
      vertex = moved(vertex);
    for (auto &[id, surface] : curved)
      {
        surface.center = moved(surface.center);
        surface.axis   = rotation * surface.axis;
      }
  }
} // namespace akmon
