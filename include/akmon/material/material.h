#pragma once

#include <akmon/material/library.h>

#include <deal.II/base/parameter_handler.h>

#include <string>

namespace akmon
{
  /// A named material: its density and its law. Section "Materials/NAME".
  struct Material
  {
    std::string name;
    double density = 0; ///< rho_0 in the initial configuration, mass/volume
    MaterialLaw law;

    static void
    declare(dealii::ParameterHandler &prm);

    /// Throws InputError where a value is missing or inadmissible.
    void
    parse(dealii::ParameterHandler &prm, const std::string &section);

    const Elasticity &
    elasticity() const;

    /// Speed of dilatational waves in the unstressed material, sqrt((lambda + 2 mu)/rho).
    double
    dilatational_wave_speed() const;
  };
} // namespace akmon
