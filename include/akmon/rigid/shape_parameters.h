#pragma once

#include <akmon/rigid/rigid_shape.h>

#include <deal.II/base/parameter_handler.h>

#include <memory>
#include <string>
#include <vector>

namespace akmon
{
  /// A shape made from parameters, and what was repaired in its file.
  struct ShapeFromParameters
  {
    std::shared_ptr<const RigidShape> shape;
    std::vector<std::string> repairs;

    /// Declare all keys in the subsection the handler stands in, an obstacle's.
    static void
    declare(dealii::ParameterHandler &prm);

    /// Throws InputError for sizes that make no shape and files that hold no closed surface.
    static ShapeFromParameters
    parse(dealii::ParameterHandler &prm, const std::string &section);
  };
} // namespace akmon
