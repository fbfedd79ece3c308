#pragma once

#include <cmath>

namespace akmon::benchmark
{
  /**
   * A double that counts the operations done with it. The cell kernel is a template on its number
   * type, so running it with this one counts the flops of the very code that is timed.
   */
  struct CountedNumber
  {
    CountedNumber() = default;

    CountedNumber(const double value)
      : value(value)
    {
    }

    CountedNumber &
    operator+=(const CountedNumber &b)
    {
      return *this = *this + b;
    }

    CountedNumber &
    operator-=(const CountedNumber &b)
    {
      return *this = *this - b;
    }

    CountedNumber &
    operator*=(const CountedNumber &b)
    {
      return *this = *this * b;
    }

    friend CountedNumber
    operator+(const CountedNumber &a, const CountedNumber &b)
    {
      return CountedNumber::counted(a.value + b.value);
    }

    friend CountedNumber
    operator-(const CountedNumber &a, const CountedNumber &b)
    {
      return CountedNumber::counted(a.value - b.value);
    }

    friend CountedNumber
    operator-(const CountedNumber &a)
    {
      return CountedNumber(-a.value);
    }

    friend CountedNumber
    operator*(const CountedNumber &a, const CountedNumber &b)
    {
      return CountedNumber::counted(a.value * b.value);
    }

    friend CountedNumber
    operator/(const CountedNumber &a, const CountedNumber &b)
    {
      return CountedNumber::counted(a.value / b.value);
    }

    friend bool
    operator<(const CountedNumber &a, const CountedNumber &b)
    {
      return a.value < b.value;
    }

    friend CountedNumber
    square_root(const CountedNumber &a)
    {
      return CountedNumber::counted(std::sqrt(a.value));
    }

    friend CountedNumber
    maximum(const CountedNumber &a, const CountedNumber &b)
    {
      return a.value > b.value ? a : b;
    }

    friend CountedNumber
    select(const bool condition, const CountedNumber &yes, const CountedNumber &no)
    {
      return condition ? yes : no;
    }

    friend void
    load(const double *from, CountedNumber &number)
    {
      number.value = *from;
    }

    friend void
    store(const CountedNumber &number, double *to)
    {
      *to = number.value;
    }

    double value = 0.;

    static CountedNumber
    counted(const double result)
    {
      ++n_operations;
      return CountedNumber(result);
    }

    static inline unsigned long n_operations = 0; ///< additions, multiplications, divisions, roots
  };
} // namespace akmon::benchmark
