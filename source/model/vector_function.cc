#include <akmon/model/vector_function.h>
#include <akmon/parameters.h>

#include <regex>

namespace akmon
{
  void
  SpaceTimeFunction::declare(dealii::ParameterHandler &prm,
                             const std::string &key,
                             const std::string &default_value,
                             const std::string &documentation)
  {
    prm.declare_entry(key,
                      default_value,
                      dealii::Patterns::Anything(),
                      documentation + "; muParser expressions in x, y, z (initial position) and t, "
                                      "components separated by semicolons");
  }


  void
  SpaceTimeFunction::parse(dealii::ParameterHandler &prm,
                           const std::string &section,
                           const std::string &key,
                           const unsigned int n_components)
  {
    const std::string expression = prm.get(key);
    const auto components        = split_list(expression, ';');
    if (components.size() != n_components)
      throw InputError(section,
                       key,
                       expression,
                       n_components == 1 ? "allowed is one expression" :
                                           "allowed are three expressions separated by semicolons");
    function = std::make_shared<dealii::FunctionParser<3>>(n_components);
    try
      {
        function->initialize("x,y,z,t", expression, {{"pi", dealii::numbers::PI}}, true);
        for (unsigned int c = 0; c < n_components; ++c)
          function->value(dealii::Point<3>(), c);
      }
    catch (const std::exception &)
      {
        throw InputError(section, key, expression, "cannot be read as a function of x, y, z, t");
      }
    depends_on_position = std::regex_search(expression, std::regex("\\b[xyz]\\b"));
    zero                = true;
    for (const auto &component : components)
      zero = zero && std::regex_match(component, std::regex("0*\\.?0*"));
  }


  double
  SpaceTimeFunction::value(const dealii::Point<3> &X,
                           const double t,
                           const unsigned int component) const
  {
    function->set_time(t);
    return function->value(X, component);
  }


  dealii::Tensor<1, 3>
  SpaceTimeFunction::vector(const dealii::Point<3> &X, const double t) const
  {
    dealii::Tensor<1, 3> result;
    for (unsigned int d = 0; d < 3; ++d)
      result[d] = value(X, t, d);
    return result;
  }
} // namespace akmon
