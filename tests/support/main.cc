#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <iostream>
#include <string>

// One program has the tests of many files. Started through a link with the name of a file, it runs
// the tests of this file; under its own name, all.

namespace
{
  // The tests of a suite that stand in the file with this stem, each with a colon behind it.
  std::string
  tests_in_file(const testing::TestSuite &suite, const std::string &stem)
  {
    std::string names;
    bool has_others = false;
    for (int i = 0; i < suite.total_test_count(); ++i)
      {
        const testing::TestInfo &test = *suite.GetTestInfo(i);
        if (std::filesystem::path(test.file()).stem() == stem)
          names += std::string(suite.name()) + '.' + test.name() + ':';
        else
          has_others = true;
      }
    return names.empty() || has_others ? names : std::string(suite.name()) + ".*:";
  }


  // The tests of a file as a filter of Google Test's; empty if there are none.
  std::string
  tests_in_file(const std::string &stem)
  {
    std::string filter;
    const testing::UnitTest &program = *testing::UnitTest::GetInstance();
    for (int i = 0; i < program.total_test_suite_count(); ++i)
      filter += tests_in_file(*program.GetTestSuite(i), stem);
    return filter.substr(0, filter.find_last_of(':'));
  }


  // Leave the tests of a file; of those the user chose, if he did. False if it has no tests.
  bool
  keep_tests_in_file(const std::string &stem)
  {
    const std::string filter = tests_in_file(stem), given = GTEST_FLAG_GET(filter);
    if (given == "*")
      GTEST_FLAG_SET(filter, filter);
    else if (given.rfind('-', 0) == 0)
      GTEST_FLAG_SET(filter, filter + given);
    return !filter.empty();
  }
} // namespace


int
main(int argc, char **argv)
{
  const std::string name = std::filesystem::path(argv[0]).stem();
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  testing::InitGoogleTest(&argc, argv);
  const bool is_link = std::filesystem::read_symlink("/proc/self/exe").stem() != name;
  if (is_link && !keep_tests_in_file(name))
    {
      std::cerr << "no tests of a file " << name << ".cc in this program" << std::endl;
      return 1;
    }
  return RUN_ALL_TESTS();
}
