#include <akmon/output/text.h>

#include <array>
#include <charconv>
#include <cstdio>

namespace akmon
{
  std::string
  shortest_text(const double number)
  {
    std::array<char, 32> text; // the longest, "-2.2250738585072014e-308", takes 24
    const auto end = std::to_chars(text.data(), text.data() + text.size(), number).ptr;
    return std::string(text.data(), end);
  }


  std::string
  rounded_text(const double number)
  {
    std::array<char, 32> text;
    std::snprintf(text.data(), text.size(), "%.6g", number);
    return text.data();
  }


  std::string
  place_text(const dealii::Tensor<1, 3> &place)
  {
    return "(" + rounded_text(place[0]) + ", " + rounded_text(place[1]) + ", " +
           rounded_text(place[2]) + ")";
  }
} // namespace akmon
