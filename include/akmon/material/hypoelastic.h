#pragma once

#include <akmon/material/elasticity.h>

#include <deal.II/base/parameter_handler.h>

#include <string>

namespace akmon
{
  /// Hypoelasticity with the Truesdell rate: no yield surface, nothing to return to, no internal
  /// variable.
  struct Hypoelastic
  {
    static constexpr const char *name         = "hypoelastic";
    static constexpr unsigned int n_internals = 0;

    Elasticity elasticity;

    static void
    declare(dealii::ParameterHandler &)
    {
    }

    void
    parse(dealii::ParameterHandler &, const std::string & /*section*/)
    {
    }

    /// The trial stress is the stress; dissipates nothing.
    template <typename N>
    [[gnu::always_inline]] inline N
    return_to_yield_surface(Symmetric3<N> & /*stress*/, N * /*internals*/) const
    {
      return N(0.);
    }
  };
} // namespace akmon
