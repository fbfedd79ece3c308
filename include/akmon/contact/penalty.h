#pragma once

#include <akmon/model/discretization.h>

#include <map>
#include <string>
#include <vector>

namespace akmon
{
  /**
   * K A^2/V of the cell behind a face in the initial configuration, with the bulk modulus K; what
   * penalty stiffness is a part of. Force/length.
   * Reference: Hallquist, LS-DYNA Theory Manual, section 29.6 (solid segments).
   */
  double
  penalty_stiffness(const Discretization &discretization, const BoundaryFace &face);

  /// The mean of it over a node's faces, by the local numbers of owned nodes.
  std::map<unsigned int, double>
  penalty_stiffness_of_nodes(const Discretization &discretization,
                             const std::vector<BoundaryFace> &faces);


  /// What penalty springs do to the critical step.
  struct PenaltyLimit
  {
    double
      frequency_squared = 0.; ///< upper bound of the largest eigenvalue of M^{-1} K_c; 1/time^2
    std::string where;        ///< name of the contact or obstacle and place, of this rank
  };
} // namespace akmon
