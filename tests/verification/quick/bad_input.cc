#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <stdexcept>

#include "support/broken_bars.h"
#include "support/files.h"
#include "support/run_case.h"

// What a user gets wrong is told in one line that names the file, the place and what is allowed;
// the program ends with status 1 and touches no output directory.

namespace bad_input
{
  using namespace akmon::test;
  using namespace akmon::test::broken_bars;

  namespace fs = std::filesystem;

  class CaseFiles : public testing::Test
  {
  protected:
    CaseFiles()
      : file(scratch.path + "/case.prm")
      , output(scratch.path + "/results")
    {
      write_file(scratch.path + "/tetrahedron.msh", mesh_of_one_tetrahedron);
      // Set by this process's own MPI; with it, mpirun takes itself for a single process.
      unsetenv("OMPI_MCA_ess");
    }

    std::string
    in_scratch(std::string text) const
    {
      const auto at = text.find("SCRATCH");
      return at == std::string::npos ? text : text.replace(at, 7, scratch.path);
    }

    /// Run a variant of the two bars that writes to `output`.
    CommandResult
    run(const Variant &variant, const unsigned int n_ranks = 1)
    {
      std::string text = file_content(shipped("two_bars"));
      auto edits       = variant.edits;
      edits.emplace_back("set Output directory = output/two_bars",
                         "set Output directory = " + output);
      for (const auto &[from, to] : edits)
        {
          const auto at = text.find(from);
          if (at == std::string::npos)
            throw std::runtime_error("two_bars.prm has no '" + from + "'");
          text.replace(at, from.size(), to);
        }
      for (const auto &section : variant.without)
        {
          const auto begin = text.find("\nsubsection " + section);
          text.erase(begin, text.find("\nend\n", begin) + 5 - begin);
        }
      write_file(file, text + variant.appended);
      std::vector<std::string> arguments{file};
      for (const auto &entry : variant.overrides)
        {
          arguments.emplace_back("--set");
          arguments.push_back(in_scratch(entry));
        }
      return run_program(arguments, n_ranks);
    }

    /// The one line that starts like an error; empty if there are none or several.
    static std::string
    error_line(const std::string &text)
    {
      std::istringstream lines(text);
      std::vector<std::string> errors;
      for (std::string line; std::getline(lines, line);)
        if (line.rfind("akmon: error", 0) == 0)
          errors.push_back(line);
      EXPECT_EQ(errors.size(), 1u) << text;
      return errors.size() == 1 ? errors[0] : "";
    }

    ScratchDirectory scratch;
    const std::string file, output;
  };


  class BadInput : public CaseFiles, public testing::WithParamInterface<Variant>
  {
  };


  TEST_P(BadInput, is_told_in_one_line)
  {
    const auto result = run(GetParam());
    EXPECT_EQ(result.status, 1);
    const std::string line = error_line(result.output);
    EXPECT_EQ(result.output, line + "\n"); // nothing else
    const std::string start = "akmon: error: " + file + ": ";
    EXPECT_EQ(line.substr(0, start.size()), start);
    EXPECT_EQ(line.find(file, start.size()), std::string::npos) << line;
    for (const auto &part : GetParam().expected)
      EXPECT_NE(line.find(in_scratch(part)), std::string::npos) << part << "\n" << line;
    EXPECT_EQ(line.find("  "), std::string::npos) << line;
    EXPECT_FALSE(fs::exists(output));
  }


  INSTANTIATE_TEST_SUITE_P(TwoBars, BadInput, testing::ValuesIn(variants), [](const auto &info) {
    return info.param.name;
  });


  class BadInputFile : public CaseFiles
  {
  protected:
    std::string
    line_of(const std::vector<std::string> &arguments)
    {
      const auto result = run_program(arguments);
      EXPECT_EQ(result.status, 1);
      const std::string line = error_line(result.output);
      EXPECT_EQ(result.output, line + "\n");
      return line;
    }
  };


  TEST_F(BadInputFile, is_absent)
  {
    EXPECT_EQ(line_of({"no_such_case.prm"}),
              "akmon: error: no_such_case.prm: there is no such file, or it cannot be read");
  }


  TEST_F(BadInputFile, is_empty)
  {
    write_file(file, "");
    EXPECT_EQ(line_of({file}), "akmon: error: " + file + ": the file is empty");
  }


  TEST_F(BadInputFile, is_a_directory)
  {
    EXPECT_EQ(line_of({scratch.path}),
              "akmon: error: " + scratch.path +
                ": this is a directory; a parameter file is needed");
  }


  TEST_F(BadInputFile, is_not_given)
  {
    EXPECT_NE(line_of({}).find("a parameter file is missing"), std::string::npos);
    EXPECT_NE(line_of({"--fast"}).find("'--fast' is not understood"), std::string::npos);
    EXPECT_NE(line_of({file, "--set"}).find("--set needs"), std::string::npos);
  }


  // What an earlier run left in the output directory stays as it is.
  TEST_F(BadInputFile, leaves_earlier_results_alone)
  {
    const std::vector<std::string> files = {"fields.pvd",
                                            "fields_000000.vtu",
                                            "history.csv",
                                            "contact.csv",
                                            "summary.json",
                                            "parameters.prm",
                                            "notes"};
    fs::create_directories(output);
    for (const auto &name : files)
      write_file(output + "/" + name, "from the last run: " + name);
    const auto time = fs::last_write_time(output);

    for (const char *const name :
         {"unknown_key", "unknown_boundary", "overlap_by_three_lengths", "probe_outside"})
      EXPECT_EQ(run(variant_of(name)).status, 1) << name;

    EXPECT_EQ(fs::last_write_time(output), time);
    std::size_t n_entries = 0;
    for (const auto &entry : fs::directory_iterator(output))
      {
        ++n_entries;
        EXPECT_EQ(file_content(entry.path()),
                  "from the last run: " + entry.path().filename().string());
      }
    EXPECT_EQ(n_entries, files.size());
  }


  // On two ranks the same line, once.
  TEST_F(BadInputFile, is_told_once_on_two_ranks)
  {
    for (const char *const name : {"unknown_key",
                                   "unknown_boundary",
                                   "tetrahedral_mesh",
                                   "overlap_by_three_lengths",
                                   "body_completely_inside",
                                   "overlap_with_an_obstacle",
                                   "output_below_a_file",
                                   "probe_outside",
                                   "function_that_cannot_be_read"})
      {
        SCOPED_TRACE(name);
        const auto &variant = variant_of(name);
        const auto on_one = run(variant), on_two = run(variant, 2);
        EXPECT_EQ(on_two.status, 1);
        EXPECT_EQ(error_line(on_two.output), error_line(on_one.output));
        EXPECT_FALSE(fs::exists(output));
      }
  }
} // namespace bad_input
