#pragma once

#include <akmon/material/tensors.h>

namespace akmon
{
  /// Isotropic elastic moduli C = lambda I (x) I + 2 mu I (17); Lame constants in stress units.
  struct Elasticity
  {
    double lambda = 0;
    double mu     = 0;

    /// From Young's modulus (stress) and Poisson's ratio.
    static Elasticity
    from_young(const double youngs_modulus, const double poissons_ratio)
    {
      return {youngs_modulus * poissons_ratio /
                ((1. + poissons_ratio) * (1. - 2. * poissons_ratio)),
              youngs_modulus / (2. * (1. + poissons_ratio))};
    }

    /// C : E
    template <typename N>
    Symmetric3<N>
    stress(const Symmetric3<N> &strain) const
    {
      const N volumetric = lambda * trace(strain);
      Symmetric3<N> result;
      for (unsigned int i = 0; i < 6; ++i)
        result[i] = 2. * mu * strain[i];
      return add_to_diagonal(result, volumetric);
    }
  };
} // namespace akmon
