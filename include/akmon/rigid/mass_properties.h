#pragma once

#include <deal.II/base/point.h>
#include <deal.II/base/symmetric_tensor.h>

namespace akmon
{
  /// Mass, centre of mass and inertia of a rigid body.
  struct MassProperties
  {
    double mass = 0.;
    dealii::Point<3> centre; ///< length
    dealii::SymmetricTensor<2, 3>
      inertia; ///< about the centre, int rho (r.r 1 - r r) dV; mass length^2

    /// A body that nothing can move.
    static MassProperties
    infinite();
  };
} // namespace akmon
