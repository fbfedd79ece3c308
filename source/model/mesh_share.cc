#include <akmon/model/curve_cut.h>
#include <akmon/model/mesh_share.h>

#include <algorithm>
#include <type_traits>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // The four local corner numbers of a right-handed cell's face, counter-clockwise seen from
    // outside.
    constexpr std::array<std::array<unsigned int, 4>, 6> outward_corners = {{{{0, 4, 6, 2}},
                                                                             {{1, 3, 7, 5}},
                                                                             {{0, 1, 5, 4}},
                                                                             {{2, 6, 7, 3}},
                                                                             {{0, 2, 3, 1}},
                                                                             {{4, 5, 7, 6}}}};


    // The parts of the ranks.
    class Partition
    {
    public:
      Partition(const GlobalMesh &mesh, const ExtraWork &extra_work, const unsigned int n_ranks)
        : mesh(mesh)
        , cut(cut_evenly(mesh, extra_work, n_ranks))
      {
      }

      MeshShare
      share_of(const unsigned int rank) const
      {
        MeshShare share;
        share.n_global_cells = mesh.cells.size();
        share.n_owned_cells  = cut.first_cell[rank + 1] - cut.first_cell[rank];
        share.n_global_nodes = mesh.nodes.size();
        share.first_node     = cut.first_node[rank];
        share.n_owned_nodes  = cut.first_node[rank + 1] - cut.first_node[rank];
        const auto cells     = cells_of(rank);
        add_nodes(cells, share);
        for (const auto id : cells)
          {
            RelevantCell cell{{}, mesh.body_of_cell[id], owns(rank, id), id};
            for (unsigned int v = 0; v < 8; ++v)
              cell.nodes[v] = local_number(mesh.cells[id][v], share);
            share.cells.push_back(cell);
          }
        add_faces(rank, share);
        return share;
      }

    private:
      bool
      owns(const unsigned int rank, const types::global_cell_index cell) const
      {
        return cut.first_cell[rank] <= cell && cell < cut.first_cell[rank + 1];
      }

      // By body, then in global order: a rank's ghosts are all behind its own cells on the curve,
      // as lower ranks own the nodes they share.
      std::vector<types::global_cell_index>
      cells_of(const unsigned int rank) const
      {
        std::vector<types::global_cell_index> cells;
        cells.reserve(cut.first_cell[rank + 1] - cut.first_cell[rank] +
                      cut.ghost_cells[rank].size());
        for (auto cell = cut.first_cell[rank]; cell < cut.first_cell[rank + 1]; ++cell)
          cells.push_back(cell);
        cells.insert(cells.end(), cut.ghost_cells[rank].begin(), cut.ghost_cells[rank].end());
        std::stable_sort(cells.begin(), cells.end(), [&](const auto a, const auto b) {
          return mesh.body_of_cell[a] < mesh.body_of_cell[b];
        });
        return cells;
      }

      void
      add_nodes(const std::vector<types::global_cell_index> &cells, MeshShare &share) const
      {
        const auto first = share.first_node, end = share.first_node + share.n_owned_nodes;
        auto &ghosts = share.ghost_nodes;
        for (const auto cell : cells)
          for (const auto node : mesh.cells[cell])
            if (node < first || node >= end)
              ghosts.push_back(node);
        std::sort(ghosts.begin(), ghosts.end());
        ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());

        share.cells.reserve(cells.size());
        share.nodes.reserve(share.n_owned_nodes + ghosts.size());
        share.nodes.assign(mesh.nodes.begin() + first, mesh.nodes.begin() + end);
        for (const auto node : ghosts)
          share.nodes.push_back(mesh.nodes[node]);
      }

      static unsigned int
      local_number(const types::global_dof_index node, const MeshShare &share)
      {
        if (node >= share.first_node && node < share.first_node + share.n_owned_nodes)
          return node - share.first_node;
        const auto &ghosts = share.ghost_nodes;
        return share.n_owned_nodes +
               (std::lower_bound(ghosts.begin(), ghosts.end(), node) - ghosts.begin());
      }

      void
      add_faces(const unsigned int rank, MeshShare &share) const
      {
        for (unsigned int c = 0; c < share.cells.size(); ++c)
          {
            const auto &cell = share.cells[c];
            auto face        = std::lower_bound(mesh.faces.begin(),
                                         mesh.faces.end(),
                                         cell.id,
                                         [](const auto &f, const auto id) { return f.cell < id; });
            for (; face != mesh.faces.end() && face->cell == cell.id; ++face)
              {
                BoundaryFace entry{{},
                                   face->boundary,
                                   6 * cell.id + face->number,
                                   cell.body,
                                   owns(rank, cell.id),
                                   face->depth,
                                   c};
                for (unsigned int v = 0; v < 4; ++v)
                  entry.nodes[v] = cell.nodes[outward_corners[face->number][v]];
                share.faces.push_back(entry);
              }
          }
        std::sort(share.faces.begin(), share.faces.end(), [](const auto &a, const auto &b) {
          return a.id < b.id;
        });
      }

      const GlobalMesh &mesh;
      const CurveCut cut;
    };


    // Visit the arrays of a share.
    template <typename Visitor>
    void
    visit_arrays(MeshShare &share, const Visitor &visit)
    {
      visit(share.ghost_nodes);
      visit(share.nodes);
      visit(share.cells);
      visit(share.faces);
    }


    template <typename T>
    std::size_t
    bytes_of(const std::vector<T> &array)
    {
      return array.size() * sizeof(T);
    }


    void
    send(MeshShare share, const unsigned int rank, const MPI_Comm communicator)
    {
      std::vector<std::uint64_t> numbers = {share.n_global_cells,
                                            share.n_owned_cells,
                                            share.n_global_nodes,
                                            share.first_node,
                                            share.n_owned_nodes};
      visit_arrays(share, [&](const auto &array) { numbers.push_back(array.size()); });
      MPI_Send(numbers.data(), numbers.size(), MPI_UINT64_T, rank, 0, communicator);
      visit_arrays(share, [&](const auto &array) {
        const auto type = Utilities::MPI::create_mpi_data_type_n_bytes(bytes_of(array));
        MPI_Send(array.data(), 1, *type, rank, 0, communicator);
      });
    }


    MeshShare
    receive(const MPI_Comm communicator)
    {
      std::array<std::uint64_t, 9> numbers;
      MPI_Recv(numbers.data(), numbers.size(), MPI_UINT64_T, 0, 0, communicator, MPI_STATUS_IGNORE);
      MeshShare share;
      share.n_global_cells = numbers[0];
      share.n_owned_cells  = numbers[1];
      share.n_global_nodes = numbers[2];
      share.first_node     = numbers[3];
      share.n_owned_nodes  = numbers[4];
      std::size_t next     = 5;
      visit_arrays(share, [&](auto &array) {
        array.resize(numbers[next++]);
        const auto type = Utilities::MPI::create_mpi_data_type_n_bytes(bytes_of(array));
        MPI_Recv(array.data(), 1, *type, 0, 0, communicator, MPI_STATUS_IGNORE);
      });
      return share;
    }
  } // namespace


  MeshShare
  share_out(GlobalMesh mesh, const ExtraWork &extra_work, const MPI_Comm communicator)
  {
    static_assert(std::is_trivially_copyable_v<RelevantCell> &&
                  std::is_trivially_copyable_v<BoundaryFace>);
    if (Utilities::MPI::this_mpi_process(communicator) != 0)
      return receive(communicator);
    const unsigned int n_ranks = Utilities::MPI::n_mpi_processes(communicator);
    const Partition partition(mesh, extra_work, n_ranks);
    for (unsigned int rank = 1; rank < n_ranks; ++rank)
      send(partition.share_of(rank), rank, communicator);
    return partition.share_of(0);
  }
} // namespace akmon
