#include <akmon/output/directory.h>
#include <akmon/output/history.h>
#include <akmon/output/pvd.h>
#include <akmon/output/summary.h>
#include <akmon/parameters.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

namespace output_test
{
  using namespace akmon;
  namespace fs = std::filesystem;

  const MPI_Comm comm = MPI_COMM_WORLD;


  bool
  is_root()
  {
    return dealii::Utilities::MPI::this_mpi_process(comm) == 0;
  }


  std::string
  content_of(const fs::path &path)
  {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
  }


  unsigned int
  count(const std::string &text, const std::string &part)
  {
    unsigned int n = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size()))
      ++n;
    return n;
  }


  /// A directory of its own for every test, the same on all ranks.
  class Output : public ::testing::Test
  {
  protected:
    void
    SetUp() override
    {
      std::string name = (fs::temp_directory_path() / "akmon_output_XXXXXX").string();
      if (is_root() && mkdtemp(name.data()) == nullptr)
        name.clear();
      directory = dealii::Utilities::MPI::broadcast(comm, name, 0);
      ASSERT_FALSE(directory.empty());
    }

    void
    TearDown() override
    {
      MPI_Barrier(comm);
      if (is_root())
        fs::remove_all(directory);
    }

    /// Create a file with the content "old" on rank 0; the others wait.
    void
    touch(const std::string &name) const
    {
      if (is_root())
        std::ofstream(file(name)) << "old";
      MPI_Barrier(comm);
    }

    std::string
    file(const std::string &name) const
    {
      return (fs::path(directory) / name).string();
    }

    std::string directory;
  };


  using HistoryFile = Output;

  TEST_F(HistoryFile, NumbersReadBackExactly)
  {
    const std::vector<double> numbers = {0.1,
                                         1. / 3.,
                                         -0.,
                                         1e-310,
                                         std::numeric_limits<double>::max(),
                                         -std::numeric_limits<double>::min(),
                                         123456789.};
    for (const double number : numbers)
      {
        const double read = std::strtod(shortest_text(number).c_str(), nullptr);
        EXPECT_EQ(read, number);
        EXPECT_EQ(std::signbit(read), std::signbit(number));
      }
    EXPECT_EQ(shortest_text(0.1), "0.1");
    EXPECT_EQ(shortest_text(std::nan("")), "nan");
  }


  TEST_F(HistoryFile, HeaderAndRowsAreOnDiskAtOnce)
  {
    History history(file("history.csv"), comm);
    history.add_column("time");
    history.add_columns({"dt", "probe.velocity_x"});
    EXPECT_FALSE(fs::exists(file("history.csv")));
    MPI_Barrier(comm);
    history.write_row({0, 0.1, -2.5e-7});
    EXPECT_EQ(content_of(file("history.csv")), "time,dt,probe.velocity_x\n0,0.1,-2.5e-07\n");
    MPI_Barrier(comm);
    history.write_row({0.5, 0.25, 1});
    EXPECT_EQ(content_of(file("history.csv")),
              "time,dt,probe.velocity_x\n0,0.1,-2.5e-07\n0.5,0.25,1\n");
  }


  TEST_F(HistoryFile, WrongNumberOfValuesOrLateColumnIsALogicError)
  {
    History history(file("history.csv"), comm);
    history.add_columns({"time", "dt"});
    EXPECT_THROW(history.write_row({1}), std::logic_error);
    history.write_row({1, 2});
    EXPECT_THROW(history.add_column("late"), std::logic_error);
  }


  void
  expect_write_error(History &history, const std::string &path, const std::string &reason)
  {
    history.add_column("time");
    try
      {
        history.write_row({1});
        ADD_FAILURE() << "no error for " << path;
      }
    catch (const std::runtime_error &error)
      {
        EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
      }
  }


  TEST_F(HistoryFile, FailuresNamePathAndReasonOnAllRanks)
  {
    History full("/dev/full", comm);
    expect_write_error(full, "/dev/full", "No space left on device");
    History lost(file("missing/history.csv"), comm);
    expect_write_error(lost, file("missing/history.csv"), "No such file or directory");
  }


  using SummaryFile = Output;

  TEST_F(SummaryFile, IsJson)
  {
    Summary summary;
    summary.set("wall_seconds", 1.);
    summary.set("cells", 10000000000ul);
    summary.set("complete", true);
    summary.set("case", "a \"b\" \\ \n\t\x01 ü");
    summary.set("energy_error", std::nan(""));
    summary.set("stages", std::map<std::string, double>{{"predict", 0.1}, {"search", INFINITY}});
    summary.set("warnings", std::vector<std::string>{"first", "second"});
    summary.set("none", std::vector<std::string>());
    summary.set("wall_seconds", 2.5);
    summary.write(file("summary.json"), comm);
    EXPECT_EQ(content_of(file("summary.json")),
              "{\n"
              "  \"wall_seconds\": 2.5,\n"
              "  \"cells\": 10000000000,\n"
              "  \"complete\": true,\n"
              "  \"case\": \"a \\\"b\\\" \\\\ \\n\\u0009\\u0001 ü\",\n"
              "  \"energy_error\": null,\n"
              "  \"stages\": {\n    \"predict\": 0.1,\n    \"search\": null\n  },\n"
              "  \"warnings\": [\n    \"first\",\n    \"second\"\n  ],\n"
              "  \"none\": []\n"
              "}\n");
    EXPECT_THROW(summary.write(file("missing/summary.json"), comm), std::runtime_error);
  }


  using PvdFile = Output;

  TEST_F(PvdFile, ListsTimesAndFiles)
  {
    PvdSeries series(file("fields.pvd"), comm);
    series.add(0, "fields_0000.vtu");
    series.add(2.5e-4, "fields_0001.vtu");
    const std::string content = content_of(file("fields.pvd"));
    EXPECT_EQ(count(content, "<DataSet "), 2u);
    EXPECT_EQ(count(content, "timestep=\"0.00025\""), 1u) << content;
    EXPECT_EQ(count(content, "file=\"fields_0001.vtu\""), 1u);
    EXPECT_EQ(count(content, "</VTKFile>"), 1u);
    EXPECT_FALSE(fs::exists(file("fields.pvd.tmp")));
    EXPECT_THROW(PvdSeries(file("missing/fields.pvd"), comm).add(0, "x"), std::runtime_error);
  }


  using OutputDirectory = Output;

  TEST_F(OutputDirectory, IsCreatedWithParentsAndLeftEmpty)
  {
    prepare_output_directory(file("a/b/"), comm);
    EXPECT_TRUE(fs::is_directory(file("a/b")));
    EXPECT_TRUE(fs::is_empty(file("a/b")));
  }


  TEST_F(OutputDirectory, OnlyOwnOldResultsAreRemoved)
  {
    const std::vector<std::string> own    = {"fields.pvd",
                                             "fields_0001.vtu",
                                             "history.csv",
                                             "contact.csv",
                                             "summary.json",
                                             "parameters.prm",
                                             "checkpoint.info",
                                             "summary.json.tmp"};
    const std::vector<std::string> others = {"notes.txt", "fields_plot.png", "my_history.csv"};
    for (const auto &names : {own, others})
      for (const auto &name : names)
        touch(name);
    if (is_root())
      fs::create_directories(file("checkpoint_1/data"));
    prepare_output_directory(directory, comm);
    for (const auto &name : own)
      EXPECT_FALSE(fs::exists(file(name))) << name;
    EXPECT_FALSE(fs::exists(file("checkpoint_1")));
    for (const auto &name : others)
      EXPECT_TRUE(fs::exists(file(name))) << name;
  }


  TEST_F(OutputDirectory, UnwritableIsRefusedOnAllRanks)
  {
    touch("regular");
    for (const auto &path :
         std::vector<std::string>{"", "/proc/akmon", file("regular"), file("regular/below")})
      try
        {
          prepare_output_directory(path, comm);
          ADD_FAILURE() << "no error for '" << path << "'";
        }
      catch (const InputError &error)
        {
          EXPECT_EQ(std::string(error.what())
                      .find("output directory '" + path + "' cannot be written: "),
                    0u)
            << error.what();
        }
    EXPECT_EQ(content_of(file("regular")), "old");
  }
} // namespace output_test
