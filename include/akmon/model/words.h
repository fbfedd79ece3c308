#pragma once

#include <deal.II/base/point.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <istream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace akmon
{
  /// A word as messages have it: short.
  inline std::string
  shown(const std::string &word)
  {
    return word.empty() ? "the end of the file" : "'" + word.substr(0, 40) + "'";
  }


  /// The words of a file, one after another. Throw std::runtime_error, in one line, for what is not
  /// there.
  class Words
  {
  public:
    explicit Words(std::istream &stream)
    {
      std::ostringstream stored;
      stored << stream.rdbuf();
      const std::string text = stored.str();
      size                   = text.size();
      words.str(text);
    }

    std::string
    line()
    {
      std::string text;
      std::getline(words, text);
      return text;
    }

    /// Empty at the end of the file.
    std::string
    word()
    {
      std::string text;
      words >> text;
      return text;
    }

    void
    expect(const std::string &expected)
    {
      const std::string found = word();
      if (found != expected)
        throw std::runtime_error(shown(found) + " stands where '" + expected + "' is expected");
    }

    /// Go on behind a word.
    void
    find(const std::string &wanted)
    {
      while (words)
        if (word() == wanted)
          return;
      throw std::runtime_error("there is no '" + wanted + "'");
    }

    double
    number()
    {
      const std::string text = word();
      std::size_t end        = 0;
      double value           = 0.;
      try
        {
          value = std::stod(text, &end);
        }
      catch (const std::exception &)
        {
          end = 0;
        }
      if (end == 0 || end != text.size())
        throw std::runtime_error(shown(text) + " stands where a number is expected");
      return value;
    }

    long
    integer()
    {
      constexpr double largest = 4e15; // exact in a double

      const double value = number();
      if (!(std::abs(value) < largest) || value != std::floor(value))
        throw std::runtime_error("a whole number is expected where " + std::to_string(value) +
                                 " stands");
      return static_cast<long>(value);
    }

    /// Of things that take two characters each at least.
    long
    count()
    {
      const long n = integer();
      if (n < 0 || static_cast<unsigned long>(n) > size / 2 + 1)
        throw std::runtime_error("the file cannot hold " + std::to_string(n) + " entries");
      return n;
    }

    dealii::Point<3>
    point()
    {
      const double x = number(), y = number(), z = number();
      return dealii::Point<3>(x, y, z);
    }

    std::vector<long>
    integers(const long n)
    {
      std::vector<long> values(n);
      for (long &value : values)
        value = integer();
      return values;
    }

    void
    skip(const long n)
    {
      for (long i = 0; i < n; ++i)
        if (word().empty())
          throw std::runtime_error("the file ends too early");
    }

  private:
    std::istringstream words;
    std::size_t size;
  };


  /// A text with its letters in upper case.
  inline std::string
  upper_case(std::string text)
  {
    std::transform(text.begin(), text.end(), text.begin(), [](const unsigned char c) {
      return static_cast<char>(std::toupper(c));
    });
    return text;
  }
} // namespace akmon
