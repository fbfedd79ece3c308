#include <akmon/model/curve_cut.h>

#include <gtest/gtest.h>

#include <algorithm>

namespace curve_cut_test
{
  using namespace akmon;

  // A bar of layers of 4 x 4 cells, numbered along it; nodes as the cells come upon them.
  GlobalMesh
  bar(const unsigned int n_layers)
  {
    constexpr unsigned int n = 4;
    GlobalMesh mesh;
    std::map<std::array<unsigned int, 3>, dealii::types::global_dof_index> numbers;
    for (unsigned int k = 0; k < n_layers; ++k)
      for (unsigned int j = 0; j < n; ++j)
        for (unsigned int i = 0; i < n; ++i)
          {
            mesh.cells.emplace_back();
            for (unsigned int v = 0; v < 8; ++v)
              mesh.cells.back()[v] = numbers
                                       .try_emplace({{i + v % 2, j + v / 2 % 2, k + v / 4}},
                                                    numbers.size())
                                       .first->second;
          }
    mesh.body_of_cell.resize(mesh.cells.size());
    mesh.nodes.resize(numbers.size());
    return mesh;
  }


  unsigned int
  n_cells(const CurveCut &cut, const unsigned int rank)
  {
    return cut.first_cell[rank + 1] - cut.first_cell[rank];
  }


  // Three ranks have a layer of ghosts each, the last has none and gets more cells of its own.
  TEST(CurveCut, shares_out_cells_and_ghosts_evenly)
  {
    const CurveCut cut = cut_evenly(bar(150), {}, 4);
    ASSERT_EQ(cut.first_cell.size(), 5u);
    EXPECT_EQ(cut.first_cell.front(), 0u);
    EXPECT_EQ(cut.first_cell.back(), 2400u);
    EXPECT_TRUE(cut.ghost_cells.back().empty());
    for (unsigned int rank = 0; rank < 4; ++rank)
      EXPECT_NEAR(n_cells(cut, rank) + cut.ghost_cells[rank].size(), 615, 5);
    EXPECT_GT(n_cells(cut, 3), n_cells(cut, 0) + 10);
  }


  // Ghosts are the cells of others that touch nodes of the rank, each once.
  TEST(CurveCut, finds_the_ghosts_of_every_rank)
  {
    const GlobalMesh mesh = bar(6);
    const CurveCut cut    = cut_evenly(mesh, {}, 3);
    for (unsigned int rank = 0; rank < 3; ++rank)
      {
        std::vector<dealii::types::global_cell_index> expected;
        for (unsigned int cell = 0; cell < mesh.cells.size(); ++cell)
          if ((cell < cut.first_cell[rank] || cell >= cut.first_cell[rank + 1]) &&
              std::any_of(mesh.cells[cell].begin(), mesh.cells[cell].end(), [&](const auto node) {
                return node >= cut.first_node[rank] && node < cut.first_node[rank + 1];
              }))
            expected.push_back(cell);
        EXPECT_EQ(cut.ghost_cells[rank], expected);
      }
  }


  // Cells of the first layer cost twice what others do: 640 + 16 of work and 16 ghosts for two.
  TEST(CurveCut, counts_what_cells_cost_besides_their_forces)
  {
    ExtraWork extra;
    for (unsigned int cell = 0; cell < 16; ++cell)
      extra[cell] = 1000;
    const CurveCut cut = cut_evenly(bar(40), extra, 2);
    EXPECT_NEAR(n_cells(cut, 0) + 16. + cut.ghost_cells[0].size(), 336, 4);
    EXPECT_NEAR(n_cells(cut, 1), 336, 4);
    EXPECT_LE(cut.most_work, 340000u);
  }


  // Where ghosts are as many as cells, shares stay as they are without counting them, if that is
  // better: no rank has more work than then, and all cells are given out once.
  TEST(CurveCut, leaves_no_cell_out_on_many_ranks)
  {
    for (unsigned int n_ranks = 1; n_ranks < 40; ++n_ranks)
      {
        const CurveCut cut = cut_evenly(bar(2), {}, n_ranks);
        ASSERT_EQ(cut.first_cell.size(), n_ranks + 1);
        EXPECT_TRUE(std::is_sorted(cut.first_cell.begin(), cut.first_cell.end()));
        EXPECT_EQ(cut.first_cell.back(), 32u);
        EXPECT_EQ(cut.first_node.back(), 75u);
        EXPECT_LE(cut.most_work, 32000u);
      }
  }
} // namespace curve_cut_test
