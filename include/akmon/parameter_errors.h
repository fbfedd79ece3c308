#pragma once

#include <deal.II/base/exceptions.h>
#include <deal.II/base/parameter_handler.h>

#include <string>
#include <vector>

namespace akmon
{
  /// "a, b, c"
  std::string
  join(const std::vector<std::string> &names, const std::string &separator);

  /// What is wrong with a section that is not declared, and which there are instead.
  std::string
  no_such_section(const dealii::ParameterHandler &prm, const std::vector<std::string> &section);

  /// What is wrong with a key that a section does not have, and which there are instead.
  std::string
  no_such_key(const dealii::ParameterHandler &prm, const std::vector<std::string> &section);

  /**
   * Throws InputError for the first value with a brace that its pattern does not allow: deal.II
   * reads these unchecked, for its loops over parameters.
   * @param prm  that has read the file
   */
  void
  check_braces(dealii::ParameterHandler &prm, const std::string &file);

  /// One line out of what deal.II says about a prm file: line, section, key, value, what is
  /// allowed.
  std::string
  in_one_line(const dealii::ExceptionBase &exception,
              const dealii::ParameterHandler &prm,
              const std::string &file);
} // namespace akmon
