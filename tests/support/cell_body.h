#pragma once

#include <akmon/simulation.h>

#include <string>

namespace akmon::test
{
  using Vector = dealii::Tensor<1, 3>;

  inline constexpr double pi = 3.14159265358979323846;


  inline Body
  body_of(const MeshParameters::Shape &shape, const CellIntegration integration)
  {
    Body body;
    body.name        = "cell";
    body.mesh.shape  = shape;
    body.rotation    = dealii::unit_symmetric_tensor<3>();
    body.material    = "elastic";
    body.integration = integration;
    return body;
  }


  inline BoxShape
  box(const Vector &size)
  {
    BoxShape shape;
    shape.size  = size;
    shape.cells = {{1, 1, 1}};
    return shape;
  }


  inline Material
  elastic(const double density = 1.)
  {
    Material material;
    material.name    = "elastic";
    material.density = density;
    material.law     = Hypoelastic{Elasticity::from_young(1000., .25)};
    return material;
  }
} // namespace akmon::test
