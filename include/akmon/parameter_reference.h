#pragma once

#include <deal.II/base/parameter_handler.h>

#include <ostream>

namespace akmon
{
  /// Print every declared parameter as Markdown: a heading for each section and below it a table
  /// of keys, defaults, what is allowed in words, and meaning. Sections and keys come in the order
  /// of declaration. doc/parameters.md is made by it.
  void
  print_parameter_reference(const dealii::ParameterHandler &prm, std::ostream &out);
} // namespace akmon
