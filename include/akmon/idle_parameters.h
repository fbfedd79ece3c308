#pragma once

#include <deal.II/base/parameter_handler.h>

#include <string>
#include <vector>

namespace akmon
{
  /**
   * What a case says in vain: keys with another value than their default that a choice made
   * elsewhere rules out, as a yield stress of an elastic law or a velocity of an obstacle that
   * stands still.
   * @return  a line for each, with section, key, value and the choice that it needs
   */
  std::vector<std::string>
  idle_parameters(const dealii::ParameterHandler &prm);
} // namespace akmon
