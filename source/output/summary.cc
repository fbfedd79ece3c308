#include <akmon/output/directory.h>
#include <akmon/output/history.h>
#include <akmon/output/summary.h>

#include <algorithm>
#include <cmath>

namespace akmon
{
  namespace
  {
    std::string
    json(const double number)
    {
      return std::isfinite(number) ? shortest_text(number) : "null";
    }


    std::string
    json(const std::string &text)
    {
      static constexpr char hex[] = "0123456789abcdef";

      std::string quoted = "\"";
      for (const char c : text)
        if (c == '"' || c == '\\')
          quoted += {'\\', c};
        else if (c == '\n')
          quoted += "\\n";
        else if (static_cast<unsigned char>(c) < 0x20)
          quoted += {'\\', 'u', '0', '0', hex[c / 16], hex[c % 16]};
        else
          quoted += c;
      return quoted + '"';
    }


    /// Items in brackets, one per line at this indentation; nothing between them if there are none.
    std::string
    enclose(const char open,
            const std::vector<std::string> &items,
            const char close,
            const unsigned int indentation)
    {
      std::string text(1, open);
      for (std::size_t i = 0; i < items.size(); ++i)
        text += (i == 0 ? "\n" : ",\n") + std::string(indentation + 2, ' ') + items[i];
      if (!items.empty())
        text += "\n" + std::string(indentation, ' ');
      return text + close;
    }
  } // namespace


  void
  Summary::set(const std::string &key, const double value)
  {
    set_json(key, json(value));
  }


  void
  Summary::set(const std::string &key, const std::string &value)
  {
    set_json(key, json(value));
  }


  void
  Summary::set(const std::string &key, const std::vector<std::string> &values)
  {
    std::vector<std::string> items;
    for (const auto &value : values)
      items.push_back(json(value));
    set_json(key, enclose('[', items, ']', 2));
  }


  void
  Summary::set(const std::string &key, const std::map<std::string, double> &values)
  {
    std::vector<std::string> items;
    for (const auto &[name, value] : values)
      items.push_back(json(name) + ": " + json(value));
    set_json(key, enclose('{', items, '}', 2));
  }


  void
  Summary::set_json(const std::string &key, const std::string &json)
  {
    const auto known = std::find_if(entries.begin(), entries.end(), [&key](const auto &entry) {
      return entry.first == key;
    });
    if (known == entries.end())
      entries.emplace_back(key, json);
    else
      known->second = json;
  }


  void
  Summary::write(const std::string &path, const MPI_Comm comm) const
  {
    run_on_root(comm, [&]() {
      std::vector<std::string> items;
      for (const auto &[key, value] : entries)
        items.push_back(json(key) + ": " + value);
      replace_file(path, enclose('{', items, '}', 0) + '\n');
    });
  }
} // namespace akmon
