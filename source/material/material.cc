#include <akmon/material/material.h>
#include <akmon/parameters.h>

#include <cmath>

namespace akmon
{
  namespace
  {
    // The laws' names, "hypoelastic|j2|...", from the library list.
    template <std::size_t... I>
    std::string
    law_names(std::index_sequence<I...>)
    {
      std::string names;
      ((names += (I ? "|" : "") + std::string(std::variant_alternative_t<I, MaterialLaw>::name)),
       ...);
      return names;
    }

    template <std::size_t... I>
    void
    declare_laws(dealii::ParameterHandler &prm, std::index_sequence<I...>)
    {
      (std::variant_alternative_t<I, MaterialLaw>::declare(prm), ...);
    }

    template <std::size_t... I>
    MaterialLaw
    law_by_name(const std::string &name, std::index_sequence<I...>)
    {
      MaterialLaw law;
      ((name == std::variant_alternative_t<I, MaterialLaw>::name ?
          (void)(law = std::variant_alternative_t<I, MaterialLaw>()) :
          (void)0),
       ...);
      return law;
    }

    constexpr auto all_laws = std::make_index_sequence<std::variant_size_v<MaterialLaw>>();
  } // namespace


  void
  J2Plastic::parse(dealii::ParameterHandler &prm, const std::string &section)
  {
    yield_stress      = prm.get_double("Yield stress");
    hardening_modulus = prm.get_double("Hardening modulus");
    if (yield_stress <= 0.)
      throw InputError(section,
                       "Yield stress",
                       prm.get("Yield stress"),
                       "law j2 needs a positive one");
  }


  void
  Material::declare(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Law",
                      "hypoelastic",
                      dealii::Patterns::Selection(law_names(all_laws)),
                      "Material law");
    prm.declare_entry("Density",
                      "0",
                      dealii::Patterns::Double(),
                      "Density rho in the initial configuration (mass/volume)");
    prm.declare_entry("Young's modulus",
                      "0",
                      dealii::Patterns::Double(),
                      "Young's modulus E (stress)");
    prm.declare_entry("Poisson's ratio",
                      "0",
                      dealii::Patterns::Double(),
                      "Poisson's ratio nu (dimensionless, -1 < nu < 0.5)");
    declare_laws(prm, all_laws);
  }


  void
  Material::parse(dealii::ParameterHandler &prm, const std::string &section)
  {
    density                     = prm.get_double("Density");
    const double youngs_modulus = prm.get_double("Young's modulus");
    const double poissons_ratio = prm.get_double("Poisson's ratio");
    if (!(density > 0.))
      throw InputError(section, "Density", prm.get("Density"), "allowed are positive numbers");
    if (!(youngs_modulus > 0.))
      throw InputError(section,
                       "Young's modulus",
                       prm.get("Young's modulus"),
                       "allowed are positive numbers");
    if (!(poissons_ratio > -1. && poissons_ratio < 0.5))
      throw InputError(section,
                       "Poisson's ratio",
                       prm.get("Poisson's ratio"),
                       "allowed are numbers above -1 and below 0.5");

    law = law_by_name(prm.get("Law"), all_laws);
    std::visit(
      [&](auto &chosen) {
        chosen.elasticity = Elasticity::from_young(youngs_modulus, poissons_ratio);
        chosen.parse(prm, section);
      },
      law);
  }


  const Elasticity &
  Material::elasticity() const
  {
    return std::visit([](const auto &chosen) -> const Elasticity & { return chosen.elasticity; },
                      law);
  }


  double
  Material::dilatational_wave_speed() const
  {
    return std::sqrt((elasticity().lambda + 2. * elasticity().mu) / density);
  }
} // namespace akmon
