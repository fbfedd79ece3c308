#pragma once

#include <deal.II/base/mpi.h>

#include <map>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace akmon
{
  /**
   * The results of a run that fit a few numbers, written as one JSON object. Keys keep the order in
   * which they were first set; setting a key again replaces its value. Numbers that are not finite
   * become null, as JSON has no other word for them. Text is UTF-8.
   */
  class Summary
  {
  public:
    /// A number, written without loss.
    void
    set(const std::string &key, const double value);

    /// A text.
    void
    set(const std::string &key, const std::string &value);

    /// A list of texts.
    void
    set(const std::string &key, const std::vector<std::string> &values);

    /// Named numbers, as an object of its own.
    void
    set(const std::string &key, const std::map<std::string, double> &values);

    /// An integer, written exactly; a bool becomes true or false.
    template <typename Integer>
    std::enable_if_t<std::is_integral_v<Integer>>
    set(const std::string &key, const Integer value)
    {
      if constexpr (std::is_same_v<Integer, bool>)
        set_json(key, value ? "true" : "false");
      else
        set_json(key, std::to_string(value));
    }

    /**
     * Write the file in one move. Collective; what rank 0 has set counts. All ranks throw
     * std::runtime_error (path and reason) if it cannot be written.
     */
    void
    write(const std::string &path, const MPI_Comm comm) const;

  private:
    void
    set_json(const std::string &key, const std::string &json);

    std::vector<std::pair<std::string, std::string>> entries; // key and value as JSON text
  };
} // namespace akmon
