#include <akmon/output/screen.h>
#include <akmon/output/stage_timer.h>

#include <gtest/gtest.h>

#include <chrono>
#include <sstream>
#include <thread>

namespace screen_test
{
  using namespace akmon;

  const MPI_Comm comm = MPI_COMM_WORLD;


  bool
  is_root()
  {
    return dealii::Utilities::MPI::this_mpi_process(comm) == 0;
  }


  unsigned int
  count(const std::string &text, const std::string &part)
  {
    unsigned int n = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size()))
      ++n;
    return n;
  }


  TEST(StageTimer, OrderOfFirstUseAndCalls)
  {
    StageTimer timer;
    timer.add("unused");
    const auto inner = timer.add("inner");
    const auto outer = timer.add("outer");
    const auto again = timer.add("inner");
    for (unsigned int i = 0; i < 3; ++i)
      {
        const StageTimer::Scope outer_timing(outer);
        const StageTimer::Scope inner_timing(i == 0 ? again : inner);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
      }

    for (const auto &totals : {timer.totals(), timer.totals(comm)})
      {
        ASSERT_EQ(totals.size(), 2u);
        EXPECT_EQ(totals[0].name, "outer");
        EXPECT_EQ(totals[1].name, "inner");
        EXPECT_EQ(totals[0].calls, 3u);
        EXPECT_EQ(totals[1].calls, 3u);
        EXPECT_GE(totals[1].seconds, 0.006);
        EXPECT_GE(totals[0].seconds, totals[1].seconds);
      }
  }


  TEST(StageTimer, StageOfOneRankAppearsOnAll)
  {
    StageTimer timer;
    const auto stage = timer.add("root only");
    if (is_root())
      StageTimer::Scope timing(stage);
    EXPECT_EQ(timer.totals().size(), is_root() ? 1u : 0u);
    const auto totals = timer.totals(comm);
    ASSERT_EQ(totals.size(), 1u);
    EXPECT_EQ(totals[0].calls, 1u);
  }


  Progress
  state_at(const double time, const unsigned int active_pairs)
  {
    Progress state;
    state.time         = time;
    state.end          = 1;
    state.active_pairs = active_pairs;
    return state;
  }


  const Progress half = state_at(0.5, 1234567);
  const Progress full = state_at(1, 3);


  TEST(Screen, PlainLineForEveryTenth)
  {
    std::ostringstream out;
    Screen screen(comm, false, out, false);
    Progress state;
    state.end = 1;
    for (state.step = 1; state.step <= 1000; ++state.step)
      {
        state.time += 1e-3;
        screen.progress(state);
      }
    EXPECT_EQ(count(out.str(), "\n"), is_root() ? 10u : 0u);
    EXPECT_EQ(count(out.str(), "\r"), 0u);
    EXPECT_EQ(count(out.str(), " 10.0 %"), is_root() ? 1u : 0u);
    EXPECT_EQ(count(out.str(), "100.0 %"), is_root() ? 1u : 0u);
  }


  TEST(Screen, TerminalLineIsRefreshedErasedAndEnded)
  {
    if (!is_root())
      GTEST_SKIP() << "only rank 0 prints";
    std::ostringstream out;
    {
      Screen screen(comm, false, out, true);
      screen.progress(half);
      const std::size_t first_length = out.str().size() - 1;
      screen.progress(half); // too soon to be shown
      EXPECT_EQ(count(out.str(), "\r"), 1u);

      out.str("");
      screen.progress(full);
      const std::string padding = out.str().substr(out.str().find("step 0") + 6);
      EXPECT_EQ(out.str().substr(0, 9), "\r100.0 % ");
      EXPECT_GT(count(padding, " "), 0u);
      EXPECT_EQ(count(padding, " "), count(padding, "\b"));
      EXPECT_EQ(out.str().size() - 1 - count(padding, "\b"), first_length);

      const std::size_t length = first_length - count(padding, " ");
      out.str("");
      screen.message("text");
      EXPECT_EQ(out.str(), "\r" + std::string(length, ' ') + "\rtext\n");

      screen.progress(full);
      out.str("");
    }
    EXPECT_EQ(out.str(), "\n");
  }


  TEST(Screen, HeaderAndClosingTable)
  {
    std::ostringstream out;
    Screen screen(comm, false, out, false);
    screen.header({{"bodies", "2"}, {"time step", "1e-7"}});
    screen.closing({{"predict", 1.5, 10}, {"contact.search", 0.5, 20}}, 2);
    EXPECT_EQ(out.str(),
              !is_root() ? "" :
                           "  bodies     2\n"
                           "  time step  1e-7\n"
                           "\n"
                           "  stage              seconds   percent       calls   slowest/mean\n"
                           "  predict              1.500      75.0          10           1.00\n"
                           "  contact.search       0.500      25.0          20           1.00\n"
                           "  total                2.000     100.0\n");
  }


  TEST(Screen, QuietShowsWarningsOnly)
  {
    std::ostringstream out;
    Screen screen(comm, true, out, true);
    screen.header({{"bodies", "2"}});
    screen.progress(full);
    screen.message("text");
    screen.warning("attention");
    screen.closing({}, 1);
    EXPECT_EQ(out.str(), is_root() ? "Warning: attention\n" : "");
    EXPECT_EQ(screen.warnings(), std::vector<std::string>{"attention"});
  }
} // namespace screen_test
