#include <akmon/case.h>

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace parameter_reference_test
{
  std::string
  reference()
  {
    std::ostringstream text;
    akmon::Case::print_reference(text);
    return text.str();
  }


  TEST(ParameterReference, DocumentIsUpToDate)
  {
    const std::string path = AKMON_SOURCE_DIR "/doc/parameters.md";
    std::ifstream file(path);
    ASSERT_TRUE(file) << "cannot read " << path;
    std::ostringstream document;
    document << file.rdbuf();
    std::istringstream have(document.str()), want(reference());
    unsigned int line = 0;
    for (std::string a, b; true;)
      {
        const bool more_a = static_cast<bool>(std::getline(have, a));
        const bool more_b = static_cast<bool>(std::getline(want, b));
        ++line;
        ASSERT_TRUE(more_a == more_b && (!more_a || a == b))
          << path << " is out of date from line " << line
          << " on; write it anew: build/akmon --print-parameters > doc/parameters.md\n"
          << "document: " << (more_a ? a : "(ends)") << "\nprogram:  " << (more_b ? b : "(ends)");
        if (!more_a)
          break;
      }
  }


  TEST(ParameterReference, EveryKeyHasAMeaning)
  {
    std::istringstream text(reference());
    unsigned int n_keys = 0;
    for (std::string line; std::getline(text, line);)
      if (line.compare(0, 3, "| `") == 0)
        {
          ++n_keys;
          EXPECT_NE(line.substr(line.size() - 5), " |  |") << line;
          EXPECT_EQ(line.find("[Anything]"), std::string::npos) << line;
        }
    EXPECT_GT(n_keys, 60u);
  }
} // namespace parameter_reference_test
