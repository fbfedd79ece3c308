#include <akmon/forces/internal_forces.h>

#include <algorithm>
#include <type_traits>

namespace akmon
{
  namespace
  {
    struct CellPlace
    {
      dealii::types::global_cell_index id;
      unsigned int body;
      std::size_t cell; ///< of the body's batches

      bool
      operator<(const CellPlace &other) const
      {
        return id < other.id;
      }
    };


    std::vector<CellPlace>
    cells_in_global_order(const Discretization &discretization,
                          const std::vector<CellBatches> &batches,
                          const bool only_owned)
    {
      std::vector<CellPlace> places;
      for (const auto &of_body : batches)
        for (std::size_t c = 0; c < of_body.n_cells; ++c)
          {
            const auto &cell = discretization.cells[of_body.first_cell + c];
            if (cell.owned || !only_owned)
              places.push_back({cell.id, of_body.body, c});
          }
      std::sort(places.begin(), places.end());
      return places;
    }


    constexpr unsigned int n_hourglass = 12; // forces of a one-point cell


    // Numbers in a row of the table of cells.
    std::size_t
    row_width(const CellBatches &batches)
    {
      return 5 + batches.n_points * batches.n_components +
             (batches.hourglass.empty() ? 0 : n_hourglass);
    }


    // A bit of a batch's lanes as a number.
    template <typename Bits, typename Visitor>
    void
    visit_bit(Bits &bits, const unsigned int lane, const unsigned int i, const Visitor &visitor)
    {
      double value = bits >> lane & 1;
      visitor(i, value);
      if constexpr (!std::is_const_v<Bits>)
        bits = (bits & ~(1u << lane)) | (value > 0. ? 1u << lane : 0u);
    }


    // Calls visitor(number in a row, value) for all that is known of a cell: its Gauss points one
    // after the other and its hourglass forces, behind omega^2, its growth and whether the cell was
    // taken out, is watched and has changed.
    template <typename Batches, typename Visitor>
    void
    visit_cell(Batches &batches, const std::size_t cell, const Visitor &visitor)
    {
      const std::size_t batch = cell / n_lanes, lane = cell % n_lanes;
      const unsigned int n    = batches.n_points * batches.n_components;
      auto *const state       = batches.state_at(batch) + lane;
      auto *const frequencies = &batches.frequencies[batch * 2 * n_lanes] + lane;
      visitor(0, frequencies[0]);
      visitor(1, frequencies[n_lanes]);
      visitor(2, batches.eroded[cell]);
      visit_bit(batches.watched[batch], lane, 3, visitor);
      visit_bit(batches.changed[batch], lane, 4, visitor);
      for (unsigned int i = 0; i < n; ++i)
        visitor(5 + i, state[i * n_lanes]);
      if (batches.hourglass.empty())
        return;
      auto *const forces = &batches.hourglass[batch * n_hourglass * n_lanes] + lane;
      for (unsigned int i = 0; i < n_hourglass; ++i)
        visitor(5 + n + i, forces[i * n_lanes]);
    }


    // The lanes that fill up the last batch are copies of its first cell.
    void
    fill_up(CellBatches &batches)
    {
      std::vector<double> first;
      const std::size_t n = std::size_t(batches.n_batches()) * n_lanes;
      if (n > 0)
        visit_cell(batches, n - n_lanes, [&](const unsigned int, const double x) {
          first.push_back(x);
        });
      for (std::size_t lane = batches.n_cells; lane < n; ++lane)
        {
          visit_cell(batches, lane, [&](const unsigned int i, double &x) { x = first[i]; });
          batches.set_frequency(lane, 0.); // they govern nothing
        }
    }
  } // namespace


  void
  InternalForces::save(CheckpointWriter &checkpoint) const
  {
    std::size_t width = 0;
    for (const auto &batches : body_batches)
      width = std::max(width, row_width(batches));
    const auto places = cells_in_global_order(discretization, body_batches, true);
    checkpoint.table("cells",
                     places.size(),
                     width,
                     [&](const std::size_t row, double *const values) {
                       std::fill(values, values + width, 0.);
                       visit_cell(body_batches[places[row].body],
                                  places[row].cell,
                                  [&](const unsigned int i, const double x) { values[i] = x; });
                     });
    checkpoint.part_of_rank("work", {work, dissipated, hourglass});
    checkpoint.numbers("governing_frequency", {governing_frequency_squared});
  }


  void
  InternalForces::restore(const CheckpointReader &checkpoint)
  {
    const auto places = cells_in_global_order(discretization, body_batches, false);
    for (std::size_t i = 0; i < places.size();)
      {
        std::size_t end = i + 1; // of a stretch of consecutive cells
        while (end < places.size() && places[end].id == places[i].id + (end - i))
          ++end;
        checkpoint.rows("cells",
                        places[i].id,
                        places[i].id + (end - i),
                        [&](const std::size_t id, const double *const values) {
                          const auto &place = places[i + (id - places[i].id)];
                          visit_cell(body_batches[place.body],
                                     place.cell,
                                     [&](const unsigned int k, double &x) { x = values[k]; });
                        });
        i = end;
      }
    n_eroded_cells = 0;
    for (auto &batches : body_batches)
      {
        fill_up(batches);
        for (std::size_t cell = 0; cell < batches.owned.size(); ++cell)
          if (batches.is_eroded(cell))
            erode(batches, cell);
      }
    const auto works            = checkpoint.sum_of_rank("work", discretization.communicator());
    work                        = works.at(0);
    dissipated                  = works.at(1);
    hourglass                   = works.at(2);
    governing_frequency_squared = checkpoint.numbers("governing_frequency").at(0);
  }
} // namespace akmon
