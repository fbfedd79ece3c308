#pragma once

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/tensor.h>

#include <array>
#include <string>
#include <vector>

namespace akmon
{
  struct Body;

  /// How often a body stands on a lattice. Subsection "Copies" of a body.
  struct Copies
  {
    std::array<unsigned int, 3> count = {{1, 1, 1}}; ///< along x, y, z
    dealii::Tensor<1, 3> spacing;                    ///< of neighbours along x, y, z; length
    double jitter     = 0.;    ///< largest random shift of a copy along each axis; length
    bool turn         = false; ///< every copy is turned about its origin at random
    unsigned int seed = 1;

    unsigned int
    n() const
    {
      return count[0] * count[1] * count[2];
    }

    static void
    declare(dealii::ParameterHandler &prm);

    /// Throws InputError where a value is missing or inadmissible.
    void
    parse(dealii::ParameterHandler &prm, const std::string &section);
  };


  /**
   * The bodies with their copies, which are bodies of their own: "ball" becomes "ball.1", "ball.2"
   * and so on, first along x, then y, then z, the first at the position of "ball". Random numbers
   * are the same on all machines. Throws InputError where two bodies have the same name then.
   */
  std::vector<Body>
  with_copies(const std::vector<Body> &bodies);
} // namespace akmon
