#pragma once

#include <deal.II/base/function_parser.h>
#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <memory>
#include <string>

namespace akmon
{
  /**
   * A function of the initial position X = (x, y, z) and the time t with one or three components,
   * read from the prm as muParser expressions separated by semicolons, e.g. "0; 0; -9.81".
   */
  class SpaceTimeFunction
  {
  public:
    static void
    declare(dealii::ParameterHandler &prm,
            const std::string &key,
            const std::string &default_value,
            const std::string &documentation);

    /// Throws InputError if the expression cannot be read or does not have @p n_components
    /// components.
    void
    parse(dealii::ParameterHandler &prm,
          const std::string &section,
          const std::string &key,
          const unsigned int n_components);

    double
    value(const dealii::Point<3> &X, const double t, const unsigned int component = 0) const;

    dealii::Tensor<1, 3>
    vector(const dealii::Point<3> &X, const double t) const;

    /// Whether the value is the same at every point.
    bool
    uniform() const
    {
      return !depends_on_position;
    }

    bool
    identically_zero() const
    {
      return zero;
    }

  private:
    std::shared_ptr<dealii::FunctionParser<3>> function;
    bool depends_on_position = false;
    bool zero                = true;
  };
} // namespace akmon
