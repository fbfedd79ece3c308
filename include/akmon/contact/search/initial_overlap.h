#pragma once

#include <akmon/model/discretization.h>

#include <optional>

namespace akmon
{
  /// A place of one body that lies inside another one.
  struct BodyOverlap
  {
    unsigned int inside, outside; ///< bodies: the one that has the place, the one around it
    dealii::Point<3> place;
    double depth; ///< distance of the place to the closest boundary face of `outside`; length
  };


  /**
   * The deepest place at which two bodies share space in their initial configuration, whether or
   * not contact is defined between them and however deep they are in each other; nothing if they do
   * not overlap by more than a millionth of a cell. Collective, the same answer on any number of
   * ranks.
   *
   * The places that are looked at are the corners, edge middles and centres of all boundary faces
   * and the centres of their cells, each against the cells (exact inversion of the trilinear map)
   * and the boundary faces of the other bodies. What is finer than half a cell of both bodies, such
   * as corners of cells that cut each other, may pass.
   */
  std::optional<BodyOverlap>
  find_deepest_overlap(const Discretization &discretization);

  /// Throws InputError naming both bodies, the place and the depth if bodies overlap initially.
  void
  refuse_body_overlap(const Discretization &discretization);
} // namespace akmon
