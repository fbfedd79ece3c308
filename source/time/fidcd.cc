#include <akmon/time/fidcd.h>

#include <cmath>

namespace akmon
{
  Fidcd::Fidcd(const Discretization &discretization,
               NodalState &state,
               const double damping,
               const double damping_end)
    : discretization(discretization)
    , state(state)
    , damping(damping)
    , damping_end(damping_end)
  {
  }


  // dx_f = dt v_0 + dt^2/2 (F_0/m - eta v_0)
  void
  Fidcd::start(const NodalVector &velocity, const double dt)
  {
    state.dt = state.dt_next = dt;
    mass_factor              = 2. / (dt * dt);
    const double carry       = dt * (1. - 0.5 * damping_rate() * dt);
    for (unsigned int node = 0, i = 0; node < discretization.n_owned_nodes; ++node)
      {
        const double inverse_mass = 1. / (discretization.mass[node] * mass_factor);
        for (unsigned int d = 0; d < 3; ++d, ++i)
          state.dx_next.local_element(i) = carry * velocity.local_element(i) +
                                           inverse_mass * state.force.local_element(i);
      }
  }


  // dx_{-1} = 2 dt v_0 - dx_0
  void
  Fidcd::finish_start(const NodalVector &velocity)
  {
    for (unsigned int i = 0; i < 3 * discretization.n_owned_nodes; ++i)
      state.dx.local_element(i) = 2. * state.dt * velocity.local_element(i) -
                                  state.dx_next.local_element(i);
  }


  void
  Fidcd::predict()
  {
    state.dx_next.update_ghost_values();
    const unsigned int n   = 3 * discretization.n_nodes;
    double *const x        = state.x.begin();
    const double *const dx = state.dx_next.begin();
    for (unsigned int i = 0; i < n; ++i)
      x[i] += dx[i];
    state.dx.swap(state.dx_next);
    state.time += state.dt_next;
    state.dt = state.dt_next;
    ++state.step;
  }


  // dx_f = (F/m + (1/(dt dt_bar) - eta/(2 dt)) dx_{n-1}) / (1/(dt' dt_bar) + eta/(2 dt'))
  void
  Fidcd::free_increment()
  {
    const double dt_bar = 0.5 * (state.dt + state.dt_next), eta = damping_rate();
    mass_factor        = 1. / (state.dt_next * dt_bar) + 0.5 * eta / state.dt_next;
    const double carry = (1. / (state.dt * dt_bar) - 0.5 * eta / state.dt) / mass_factor;

    const double *const dx    = state.dx.begin();
    const double *const force = state.force.begin();
    double *const dx_next     = state.dx_next.begin();
    for (unsigned int node = 0; node < discretization.n_owned_nodes; ++node)
      {
        const double inverse_mass = 1. / (discretization.mass[node] * mass_factor);
        for (unsigned int i = 3 * node; i < 3 * node + 3; ++i)
          dx_next[i] = carry * dx[i] + inverse_mass * force[i];
      }
  }


  double
  Fidcd::kinetic_energy() const
  {
    double sum = 0.;
    if (state.step == 0)
      {
        for (unsigned int node = 0; node < discretization.n_owned_nodes; ++node)
          sum += discretization.mass[node] * velocity(node).norm_square();
        return 0.5 * sum;
      }
    // With all divisions outside the loop: this runs over all nodes for every row of the history.
    const double dt = state.dt, dt_next = state.dt_next, dt_bar = 0.5 * (dt + dt_next);
    const double from_before = dt_next / (dt * (dt + dt_next)),
                 from_after  = dt / (dt_next * (dt + dt_next));
    const double half        = 0.5 * std::sqrt(dt * dt_next) / dt_bar;
    const double to_before = half / dt, to_after = half / dt_next;
    const double *const dx      = state.dx.begin();
    const double *const dx_next = state.dx_next.begin();
    for (unsigned int node = 0; node < discretization.n_owned_nodes; ++node)
      {
        double of_node = 0.;
        for (unsigned int i = 3 * node; i < 3 * node + 3; ++i)
          {
            const double v = from_before * dx[i] + from_after * dx_next[i];
            const double a = to_after * dx_next[i] - to_before * dx[i];
            of_node += v * v - a * a;
          }
        sum += discretization.mass[node] * of_node;
      }
    return 0.5 * sum;
  }


  double
  Fidcd::damping_work(const NodalVector &increment) const
  {
    const double eta = damping_rate();
    if (eta == 0.)
      return 0.;
    double sum = 0.;
    for (unsigned int node = 0; node < discretization.n_owned_nodes; ++node)
      sum -= discretization.mass[node] * (velocity(node) * at_node(increment, node));
    return eta * sum;
  }
} // namespace akmon
