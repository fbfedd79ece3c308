#include <akmon/parameters.h>

#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>

#include <regex>

namespace akmon
{
  namespace
  {
    // "numbers from 0 to 1", "box, cylinder, sphere", "3 numbers separated by commas"
    std::string
    pattern_in_words(const std::string &pattern)
    {
      std::smatch match;
      if (std::regex_match(pattern,
                           match,
                           std::regex("\\[(Double|Integer)(?: range)?(?: (\\S+)\\.\\.\\.(\\S+))?"
                                      "(?: \\(inclusive\\))?\\]")))
        {
          std::string text  = match[1] == "Double" ? "numbers" : "integers";
          const auto finite = [](const std::string &bound) {
            return !bound.empty() && bound.find("MAX_DOUBLE") == std::string::npos &&
                   bound.find("2147483647") == std::string::npos &&
                   bound.find("2147483648") == std::string::npos;
          };
          const std::string lower = match[2], upper = match[3];
          if (finite(lower) && finite(upper))
            return text + " from " + lower + " to " + upper;
          if (finite(lower))
            return text + " not below " + lower;
          return finite(upper) ? text + " not above " + upper : text;
        }
      if (std::regex_match(pattern, match, std::regex("\\[(Multiple)?Selection (.*?) *\\]")))
        return (match[1].matched ? "any of " : "") +
               std::regex_replace(match[2].str(), std::regex("\\|"), ", ");
      if (std::regex_match(pattern,
                           match,
                           std::regex("\\[List of <(.*)> of length (\\d+)\\.\\.\\.(\\d+) .*\\]")))
        return (match[2] == match[3] ? match[2].str() + " " : "") + pattern_in_words(match[1]) +
               " separated by commas";
      if (pattern == "[Bool]")
        return "true, false";
      return pattern;
    }
  } // namespace


  std::string
  allowed_values(const std::string &pattern)
  {
    return "allowed are " + pattern_in_words(dealii::Utilities::trim(pattern));
  }


  InputError::InputError(const std::string &message)
    : std::runtime_error(message)
  {
  }


  InputError::InputError(const std::string &section,
                         const std::string &key,
                         const std::string &value,
                         const std::string &allowed)
    : std::runtime_error((section.empty() ? "" : "[" + section + "] ") + key + " = " + value +
                         ": " + allowed)
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


  std::optional<double>
  get_number_or(const std::string &word,
                dealii::ParameterHandler &prm,
                const std::string &section,
                const std::string &key,
                const dealii::Patterns::Double &pattern,
                const std::string &numbers)
  {
    const std::string text = prm.get(key);
    if (text == word)
      return {};
    if (!pattern.match(text))
      throw InputError(section, key, text, "allowed are '" + word + "' and " + numbers);
    return dealii::Utilities::string_to_double(text);
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
