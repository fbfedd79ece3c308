#include <akmon/contact/coupled/elimination_fronts.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "support/report.h"

// The order and the fronts of sparse matrices against an elimination row by row.

namespace elimination_fronts_test
{
  using akmon::EliminationFronts;
  using akmon::test::report;
  using Edges = std::vector<EliminationFronts::Edge>;

  // By position: the rows behind it that each one changes when they are eliminated one by one.
  std::vector<std::set<unsigned int>>
  eliminate(const unsigned int n, const Edges &edges, const std::vector<unsigned int> &positions)
  {
    std::vector<std::set<unsigned int>> changed(n);
    for (const auto &[a, b] : edges)
      changed[std::min(positions[a], positions[b])].insert(std::max(positions[a], positions[b]));
    for (unsigned int i = 0; i < n; ++i)
      if (!changed[i].empty())
        for (const unsigned int j : changed[i])
          if (const unsigned int first = *changed[i].begin(); j != first)
            changed[first].insert(j);
    return changed;
  }


  std::size_t
  n_entries(const EliminationFronts &fronts)
  {
    std::size_t n = 0;
    for (const auto &front : fronts.get_fronts())
      n += front.n_pivots() * (front.n_pivots() - 1) / 2 + front.n_pivots() * front.n_below;
    return n;
  }


  // Points of a square, each coupled with those around it, some with none.
  Edges
  edges_of_square(const unsigned int m)
  {
    Edges edges;
    for (unsigned int a = 0; a < m * m; ++a)
      for (unsigned int b = 0; b < a; ++b)
        if (a % 13 != 5 && b % 13 != 5 && a / m - b / m <= 1 && a % m + 1 >= b % m &&
            b % m + 1 >= a % m)
          edges.push_back({{a, b}});
    return edges;
  }


  TEST(EliminationFronts, hold_all_that_an_elimination_changes)
  {
    for (const unsigned int m : {1U, 3U, 15U, 7U})
      {
        const unsigned int n = m * m;
        const Edges edges    = edges_of_square(m);
        EliminationFronts fronts;
        fronts.reinit(n, edges);
        const auto changed = eliminate(n, edges, fronts.get_positions());
        unsigned int next  = 0;
        for (const auto &front : fronts.get_fronts())
          {
            ASSERT_EQ(front.first, next);
            next             = front.end;
            const auto below = fronts.below(front);
            for (unsigned int i = front.first; i < front.end; ++i)
              for (const unsigned int j : changed[i])
                EXPECT_TRUE(j < front.end || std::binary_search(below.begin(), below.end(), j));
          }
        EXPECT_EQ(next, n);
        std::set<unsigned int> positions(fronts.get_positions().begin(),
                                         fronts.get_positions().end());
        EXPECT_EQ(positions.size(), n);
      }
  }


  TEST(EliminationFronts, come_behind_their_children)
  {
    EliminationFronts fronts;
    fronts.reinit(400, edges_of_square(20));
    std::vector<std::size_t> open;
    std::set<unsigned int> edges;
    for (std::size_t f = 0; f < fronts.get_fronts().size(); ++f)
      {
        const auto &front = fronts.get_fronts()[f];
        const auto below  = fronts.below(front);
        ASSERT_LE(front.n_children, open.size());
        for (unsigned int c = 0; c < front.n_children; ++c, open.pop_back())
          for (const unsigned int i : fronts.below(fronts.get_fronts()[open.back()]))
            EXPECT_TRUE((i >= front.first && i < front.end) ||
                        std::binary_search(below.begin(), below.end(), i));
        if (front.n_below > 0)
          open.push_back(f);
        edges.insert(fronts.edges_of(f).begin(), fronts.edges_of(f).end());
      }
    EXPECT_TRUE(open.empty());
    EXPECT_EQ(edges.size(), edges_of_square(20).size());
  }


  // With the zeros among them: of a chain, numbered at random, no more than as many again as are
  // in the matrix; of a square less than row by row (27000).
  TEST(EliminationFronts, have_few_entries)
  {
    const unsigned int n = 101;
    Edges chain;
    for (unsigned int i = 0; i + 1 < n; ++i)
      chain.push_back({{(37 * i) % n, (37 * (i + 1)) % n}});
    EliminationFronts fronts;
    fronts.reinit(n, chain);
    report("entries of a chain of 101", n_entries(fronts));
    EXPECT_LT(n_entries(fronts), 2.1 * n);
    fronts.reinit(900, edges_of_square(30));
    report("entries of a square of 900", n_entries(fronts));
    EXPECT_LT(n_entries(fronts), 18000);
  }


  TEST(EliminationFronts, change_with_the_matrix)
  {
    EliminationFronts fronts, new_fronts;
    fronts.reinit(3, {{{0, 1}}});
    fronts.reinit(3, {{{0, 1}}});
    fronts.reinit(3, {{{0, 2}}});
    new_fronts.reinit(3, {{{0, 2}}});
    EXPECT_EQ(fronts.get_positions(), new_fronts.get_positions());
    EXPECT_EQ(n_entries(fronts), n_entries(new_fronts));
  }
} // namespace elimination_fronts_test
