#pragma once

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/patterns.h>
#include <deal.II/base/tensor.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace akmon
{
  /**
   * An error in what the user gave: one clear line, exit status 1. The top level prefixes the name
   * of the parameter file.
   */
  class InputError : public std::runtime_error
  {
  public:
    /// A message that stands for itself.
    explicit InputError(const std::string &message);

    /// The value of a key is not acceptable: names section ("Bodies/left"; may be empty), key,
    /// value and what is allowed.
    InputError(const std::string &section,
               const std::string &key,
               const std::string &value,
               const std::string &allowed);
  };

  /// What a pattern of dealii::Patterns admits, in words: "allowed are numbers from 0 to 1".
  std::string
  allowed_values(const std::string &pattern);

  /// A comma-separated value as its entries, blanks around entries removed; empty text gives no
  /// entry.
  std::vector<std::string>
  split_list(const std::string &text, char separator = ',');

  /// The three numbers of an entry such as "1, 0, 0". Throws InputError (section, key) if there are
  /// not three.
  dealii::Tensor<1, 3>
  get_vector(dealii::ParameterHandler &prm, const std::string &section, const std::string &key);

  /// The number of an entry that is one that @p pattern admits (@p numbers in words), or @p word,
  /// which gives none. Throws InputError (section, key) for anything else.
  std::optional<double>
  get_number_or(const std::string &word,
                dealii::ParameterHandler &prm,
                const std::string &section,
                const std::string &key,
                const dealii::Patterns::Double &pattern,
                const std::string &numbers);

  /// Declare an entry of three numbers.
  void
  declare_vector(dealii::ParameterHandler &prm,
                 const std::string &key,
                 const std::string &default_value,
                 const std::string &documentation);
} // namespace akmon
