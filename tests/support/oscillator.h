#pragma once

#include <akmon/time/fidcd.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace akmon::test::oscillator
{
  // Single masses through Fidcd, with forces and steps that are given as functions.

  // The step that leads from time level n (at time t) on.
  using Steps = std::function<double(double t, unsigned long n)>;
  // Force on a mass at its displacement u and the time.
  using Force = std::function<double(double u, double t)>;


  // One unit cube of density 8: its nodes are eight unit masses.
  inline std::vector<Body>
  unit_cube()
  {
    BoxShape shape;
    shape.size  = dealii::Tensor<1, 3>({1., 1., 1.});
    shape.cells = {{1, 1, 1}};
    Body body;
    body.name       = "cube";
    body.mesh.shape = shape;
    body.rotation   = dealii::unit_symmetric_tensor<3>();
    body.material   = "stuff";
    return {body};
  }


  inline std::vector<Material>
  stuff()
  {
    Material material;
    material.name    = "stuff";
    material.density = 8.;
    material.law     = Hypoelastic{Elasticity::from_young(1., 0.)};
    return {material};
  }


  // Node 0 moves in x, node 1 in y, ..., the others rest: components and nodes must not mix.
  class Oscillator
  {
  public:
    Oscillator(const double u_0,
               const double v_0,
               const Force &force,
               const Steps &steps,
               const double damping = 0.)
      : discretization(unit_cube(), stuff(), MPI_COMM_SELF)
      , state(discretization)
      , integrator(discretization, state, damping)
      , force(force)
      , steps(steps)
    {
      auto velocity = discretization.make_vector();
      for (unsigned int node = 0; node < 3; ++node)
        {
          velocity.local_element(3 * node + node) = v_0;
          state.x.local_element(3 * node + node) += u_0;
        }
      set_force();
      integrator.start(velocity, steps(0., 0));
      EXPECT_DOUBLE_EQ(integrator.effective_mass_factor(), 2. / (state.dt_next * state.dt_next));
      integrator.finish_start(velocity);
    }

    void
    advance()
    {
      integrator.predict();
      set_force();
      state.dt_next = steps(state.time, state.step);
      integrator.free_increment();
      const double dt_bar = 0.5 * (state.dt + state.dt_next);
      EXPECT_GE(integrator.effective_mass_factor(),
                (1. - 1e-15) / (state.dt_next * dt_bar)); // plus eta/(2 dt')
    }

    double
    displacement(const unsigned int node = 0) const
    {
      const unsigned int i = 3 * node + node;
      return state.x.local_element(i) - discretization.reference.local_element(i);
    }

    double
    velocity() const
    {
      return integrator.velocity(0)[0];
    }

    // Kinetic energy of one of the three masses.
    double
    kinetic_energy() const
    {
      return integrator.kinetic_energy() / 3.;
    }

    double
    time() const
    {
      return state.time;
    }

    // Largest displacement of what must rest.
    double
    unrest() const
    {
      double worst = 0.;
      for (unsigned int node = 0; node < 8; ++node)
        for (unsigned int d = 0; d < 3; ++d)
          if (node != d)
            worst = std::max(worst,
                             std::abs(state.x.local_element(3 * node + d) -
                                      discretization.reference.local_element(3 * node + d)));
      return worst;
    }

    Discretization discretization;
    NodalState state;
    Fidcd integrator;

  private:
    void
    set_force()
    {
      state.force = 0.;
      for (unsigned int node = 0; node < 3; ++node)
        state.force.local_element(3 * node + node) = force(displacement(node), state.time);
    }

    const Force force;
    const Steps steps;
  };


  inline Steps
  constant(const double dt)
  {
    return [dt](double, unsigned long) { return dt; };
  }


  // Steps between dt/2 and 3 dt/2 that vary smoothly with time.
  inline Steps
  smooth(const double dt)
  {
    return [dt](const double t, unsigned long) { return dt * (1. + 0.5 * std::sin(3. * t)); };
  }


  // Steps between dt/2 and dt that jump.
  inline Steps
  erratic(const double dt)
  {
    return [dt](double, const unsigned long n) { return dt * (0.5 + 0.5 * ((n * 7) % 11) / 10.); };
  }


  inline double
  no_force(double, double)
  {
    return 0.;
  }
} // namespace akmon::test::oscillator
