#pragma once

#include <deal.II/base/tensor.h>

#include <string>

namespace akmon
{
  /// The shortest decimal text that reads back as exactly this number ("0.1", "1e-300", "nan").
  std::string
  shortest_text(const double number);

  /// A number as people read it, six digits of it ("0.333333").
  std::string
  rounded_text(const double number);

  /// The same of a place: "(x, y, z)".
  std::string
  place_text(const dealii::Tensor<1, 3> &place);
} // namespace akmon
