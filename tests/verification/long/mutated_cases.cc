#include <akmon/parameters.h>

#include <gtest/gtest.h>

#include <csignal>
#include <map>
#include <regex>
#include <unistd.h>

#include "support/run_directory.h"

// Every key that a shipped case sets, set to values that it may not be made for, one at a time: the
// case then runs its first steps, or is refused, or stops, in one line. Nothing else may happen,
// and nothing may take longer than a minute. Where a key is set for the first time in all cases it
// gets all values, later three of them in turn.

namespace mutated_cases
{
  using namespace akmon::test;

  const std::vector<std::string> values =
    {"", "0", "-1", "1e300", "1e-300", "nan", "word", "0, 0, 0", "1000000000", "0; t; sqrt(-1)"};
  constexpr unsigned int largest_to_run = 1000; ///< cells; larger cases are only built


  // "Section/Sub/Key" of all that a parameter file sets.
  std::vector<std::string>
  keys_of(const std::string &file)
  {
    std::istringstream lines(file_content(file));
    std::vector<std::string> open, keys;
    std::smatch match;
    for (std::string line; std::getline(lines, line);)
      if (std::regex_match(line, match, std::regex("\\s*subsection\\s+(.*?)\\s*(#.*)?")))
        open.push_back(match[1]);
      else if (std::regex_match(line, std::regex("\\s*end\\s*(#.*)?")))
        open.pop_back();
      else if (std::regex_match(line, match, std::regex("\\s*set\\s+(.*?)\\s*=.*")))
        {
          std::string path;
          for (const auto &section : open)
            path += section + "/";
          keys.push_back(path + match[1].str());
        }
    return keys;
  }


  std::vector<std::string>
  shipped_cases()
  {
    std::vector<std::string> names;
    for (const auto &entry :
         std::filesystem::directory_iterator(std::string(AKMON_SOURCE_DIR) + "/prm"))
      if (entry.path().extension() == ".prm")
        names.push_back(entry.path().stem());
    std::sort(names.begin(), names.end());
    return names;
  }


  // The key without the name of its body, material, contact...
  std::string
  without_name(const std::string &key)
  {
    return std::regex_replace(key, std::regex("^([^/]*)/[^/]*/"), "$1/");
  }


  struct Mutation
  {
    std::string key, value;
  };


  std::map<std::string, std::vector<Mutation>>
  mutations()
  {
    constexpr std::size_t n_later = 3;

    std::map<std::string, std::vector<Mutation>> of_case;
    std::map<std::string, std::size_t> next; // of the values of a key
    for (const auto &name : shipped_cases())
      for (const auto &key : keys_of(shipped(name)))
        {
          if (key == "Output directory" || key == "Title")
            continue;
          const bool first  = next.count(without_name(key)) == 0;
          std::size_t &turn = next[without_name(key)];
          for (std::size_t i = 0; i < (first ? values.size() : n_later); ++i)
            of_case[name].push_back({key, values[turn++ % values.size()]});
        }
    return of_case;
  }


  std::string current; // what is tried, for the alarm


  void
  give_up(int)
  {
    const std::string text              = "takes longer than a minute: " + current + "\n";
    [[maybe_unused]] const auto written = write(STDERR_FILENO, text.data(), text.size());
    _exit(1);
  }


  enum class Outcome
  {
    runs,
    refused,
    stopped
  };


  Outcome
  try_variant(const std::string &file, const std::string &override, const std::string &directory)
  {
    const double end = [&]() { return akmon::Case::read(file, {}).time.end; }();
    std::vector<std::string> overrides;
    if (file.find("poured_spheres") != std::string::npos) // eight are as good as two hundred
      overrides.push_back("Bodies/ball/Copies/Count=2, 2, 2");
    overrides.push_back(override);
    if (override.rfind("Time/", 0) != 0)
      overrides.push_back("Time/End=" + akmon::shortest_text(1e-3 * end));
    overrides.push_back("Output directory=" + directory);
    try
      {
        akmon::Simulation simulation(akmon::Case::read(file, overrides), MPI_COMM_SELF, true);
        if (override.rfind("Time/", 0) != 0 && simulation.model().n_global_cells <= largest_to_run)
          simulation.run();
        return Outcome::runs;
      }
    catch (const akmon::InputError &error)
      {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        EXPECT_GT(std::string(error.what()).size(), 10u);
        return Outcome::refused;
      }
    catch (const akmon::RunError &error)
      {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        return Outcome::stopped;
      }
  }


  class MutatedCase : public testing::TestWithParam<std::string>
  {
  };


  TEST_P(MutatedCase, runs_or_tells_why_not)
  {
    const ScratchDirectory scratch;
    std::signal(SIGALRM, give_up);
    unsigned int n[3]         = {0, 0, 0};
    static const auto of_case = mutations();
    for (const auto &mutation : of_case.at(GetParam()))
      {
        const std::string override = mutation.key + "=" + mutation.value;
        current                    = GetParam() + ": " + override;
        SCOPED_TRACE(current);
        alarm(60);
        try
          {
            ++n[int(try_variant(shipped(GetParam()), override, scratch.path + "/run"))];
          }
        catch (const std::exception &exception)
          {
            ADD_FAILURE() << "unexpected: " << exception.what();
          }
      }
    alarm(0);
    RecordProperty("runs", int(n[0]));
    RecordProperty("refused", int(n[1]));
    RecordProperty("stopped", int(n[2]));
    EXPECT_GT(n[1], n[2]);
  }


  INSTANTIATE_TEST_SUITE_P(Shipped,
                           MutatedCase,
                           testing::ValuesIn(shipped_cases()),
                           [](const auto &info) { return info.param; });
} // namespace mutated_cases
