#include <akmon/model/curve_cut.h>

#include <algorithm>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    constexpr std::uint64_t work_of_cell = 1000; // extra work is in thousandths


    // A rank's work is that of its cells, of their extra work and of its ghosts, of which there are
    // to be about as many as @p n_ghosts [rank].
    std::vector<types::global_cell_index>
    first_cells(const types::global_cell_index n_cells,
                const ExtraWork &extra_work,
                const std::vector<std::uint64_t> &n_ghosts)
    {
      const unsigned int n_ranks = n_ghosts.size();
      std::uint64_t all          = work_of_cell * n_cells;
      for (const auto &[cell, extra] : extra_work)
        all += extra;
      for (const auto n : n_ghosts)
        all += work_of_cell * n;

      std::vector<types::global_cell_index> first = {0};
      std::uint64_t before                        = work_of_cell * n_ghosts[0];
      auto next_extra                             = extra_work.begin();
      for (types::global_cell_index cell = 0; cell < n_cells; ++cell)
        {
          while (first.size() < n_ranks && before * n_ranks >= all * first.size())
            {
              before += work_of_cell * n_ghosts[first.size()];
              first.push_back(cell);
            }
          before += work_of_cell;
          if (next_extra != extra_work.end() && next_extra->first == cell)
            before += (next_extra++)->second;
        }
      first.resize(n_ranks + 1, n_cells);
      return first;
    }


    // Nodes are numbered as the cells along the curve come upon them.
    void
    number_nodes(const GlobalMesh &mesh, CurveCut &cut)
    {
      types::global_dof_index n_nodes = 0;
      for (unsigned int rank = 0; rank + 1 < cut.first_cell.size(); ++rank)
        {
          cut.first_node.push_back(n_nodes);
          for (auto cell = cut.first_cell[rank]; cell < cut.first_cell[rank + 1]; ++cell)
            for (const auto node : mesh.cells[cell])
              n_nodes = std::max(n_nodes, node + 1);
        }
      cut.first_node.push_back(n_nodes);
    }


    void
    find_ghost_cells(const GlobalMesh &mesh, CurveCut &cut)
    {
      const unsigned int n_ranks = cut.first_cell.size() - 1;
      cut.ghost_cells.resize(n_ranks);
      for (unsigned int rank = 0; rank < n_ranks; ++rank)
        for (auto cell = cut.first_cell[rank]; cell < cut.first_cell[rank + 1]; ++cell)
          for (const auto node : mesh.cells[cell])
            if (node < cut.first_node[rank])
              {
                const auto owner = std::upper_bound(cut.first_node.begin(),
                                                    cut.first_node.end(),
                                                    node) -
                                   cut.first_node.begin() - 1;
                auto &ghosts = cut.ghost_cells[owner];
                if (ghosts.empty() || ghosts.back() != cell)
                  ghosts.push_back(cell);
              }
    }


    CurveCut
    cut_curve(const GlobalMesh &mesh,
              const ExtraWork &extra_work,
              const std::vector<std::uint64_t> &n_ghosts)
    {
      CurveCut cut;
      cut.first_cell = first_cells(mesh.cells.size(), extra_work, n_ghosts);
      number_nodes(mesh, cut);
      find_ghost_cells(mesh, cut);
      for (unsigned int rank = 0; rank < n_ghosts.size(); ++rank)
        {
          std::uint64_t work = work_of_cell * (cut.first_cell[rank + 1] - cut.first_cell[rank] +
                                               cut.ghost_cells[rank].size());
          for (auto extra = extra_work.lower_bound(cut.first_cell[rank]);
               extra != extra_work.end() && extra->first < cut.first_cell[rank + 1];
               ++extra)
            work += extra->second;
          cut.most_work = std::max(cut.most_work, work);
        }
      return cut;
    }
  } // namespace


  CurveCut
  cut_evenly(const GlobalMesh &mesh, const ExtraWork &extra_work, const unsigned int n_ranks)
  {
    constexpr unsigned int n_trials = 3;

    CurveCut best = cut_curve(mesh, extra_work, std::vector<std::uint64_t>(n_ranks, 0));
    CurveCut last = best;
    for (unsigned int trial = 0; trial < n_trials && n_ranks > 1; ++trial)
      {
        std::vector<std::uint64_t> n_ghosts;
        for (const auto &ghosts : last.ghost_cells)
          n_ghosts.push_back(ghosts.size());
        last = cut_curve(mesh, extra_work, n_ghosts);
        if (last.most_work < best.most_work)
          best = last;
      }
    return best;
  }
} // namespace akmon
