#pragma once

#include <akmon/material/j2_plastic.h>

#include <cmath>
#include <functional>
#include <random>

namespace akmon::test::j2_points
{
  // A point of J2 plasticity with its state, driven by strain increments without any map.

  using Stress     = Symmetric3<double>;
  using StrainPath = std::function<Stress(double)>; // strain at 0 <= t <= 1, tensor components

  // Copper of the Taylor bar, MPa: E = 117 GPa, nu = 0.35, sigma_y = 400, h' = 100.
  inline const double E  = 117e3;
  inline const double nu = 0.35;
  inline const double H  = 100.;
  inline const J2Plastic copper{Elasticity::from_young(E, nu), 400., H};
  inline const double G = copper.elasticity.mu;
  inline const double K = copper.elasticity.lambda + 2. / 3. * G;


  struct State
  {
    Stress stress       = {};
    double eps_p        = 0.;
    double plastic_work = 0.;
  };


  inline Stress
  difference(const Stress &a, const Stress &b)
  {
    Stress result;
    for (unsigned int i = 0; i < 6; ++i)
      result[i] = a[i] - b[i];
    return result;
  }


  inline double
  norm(const Stress &s)
  {
    return std::sqrt(contract(s, s));
  }


  inline double
  equivalent_stress(const Stress &s)
  {
    return std::sqrt(equivalent_stress_squared(s));
  }


  // One small-strain increment; returns the plastic work.
  inline double
  strain_by(const J2Plastic &law, const Stress &strain, State &state)
  {
    state.stress      = state.stress + law.elasticity.stress(strain);
    const double work = law.return_to_yield_surface(state.stress, &state.eps_p);
    state.plastic_work += work;
    return work;
  }


  inline State
  integrate(const StrainPath &path, const unsigned int N)
  {
    State state;
    for (unsigned int n = 0; n < N; ++n)
      strain_by(copper, difference(path((n + 1.) / N), path(double(n) / N)), state);
    return state;
  }


  // The same numbers in every test, run alone or with the others.
  struct Random
  {
    std::mt19937 generator{1};

    double
    between(const double low, const double high)
    {
      return low + (high - low) * (generator() / 4294967296.);
    }

    Stress
    tensor(const double magnitude)
    {
      Stress result;
      for (unsigned int i = 0; i < 6; ++i)
        result[i] = between(-magnitude, magnitude);
      return result;
    }
  };
} // namespace akmon::test::j2_points
