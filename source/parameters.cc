#include <akmon/parameters.h>

#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>

namespace akmon
{
  InputError::InputError(const std::string &message) : std::runtime_error(message)
  {
  }


  InputError::InputError(const std::string &section,
                         const std::string &key,
                         const std::string &value,
                         const std::string &allowed)
    : std::runtime_error("[" + section + "] " + key + " = " + value + ": " + allowed)
  {
  }


  std::vector<std::string>
  split_list(const std::string &text, const char separator)
  {
    std::vector<std::string> entries;
    for (const auto &entry : dealii::Utilities::split_string_list(text, separator))
      if (!entry.empty())
        entries.push_back(entry);
    return entries;
  }


  dealii::Tensor<1, 3>
  get_vector(dealii::ParameterHandler &prm, const std::string &section, const std::string &key)
  {
    const auto entries = split_list(prm.get(key));
    if (entries.size() != 3)
      throw InputError(section, key, prm.get(key), "allowed are three numbers separated by commas");
    dealii::Tensor<1, 3> vector;
    for (unsigned int d = 0; d < 3; ++d)
      vector[d] = dealii::Utilities::string_to_double(entries[d]);
    return vector;
  }


  void
  declare_vector(dealii::ParameterHandler &prm,
                 const std::string &key,
                 const std::string &default_value,
                 const std::string &documentation)
  {
    prm.declare_entry(key,
                      default_value,
                      dealii::Patterns::List(dealii::Patterns::Double(), 3, 3),
                      documentation);
  }
} // namespace akmon
