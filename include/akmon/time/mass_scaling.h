#pragma once

#include <akmon/forces/internal_forces.h>

namespace akmon
{
  /**
   * Mass scaling: cells whose omega^2 is beyond a limit in the initial configuration get omega^2
   * over the limit times their mass, which takes omega^2 to the limit. Masses stay constant through
   * the run, so that momenta are conserved; gravity acts on what was added too. Nothing happens
   * where no cell is beyond the limit.
   *
   * @param limit  allowed omega^2 of a cell, 1/time^2
   * @return       added mass of all ranks over the mass there was (collective)
   */
  double
  scale_masses(Discretization &discretization, InternalForces &forces, const double limit);
} // namespace akmon
