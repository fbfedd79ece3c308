#include <akmon/forces/cell_batches.h>

#include <algorithm>

namespace akmon
{
  CellBatches::CellBatches(const Discretization &discretization, const unsigned int body)
    : body(body)
  {
    const auto &cells    = discretization.cells;
    const auto first     = std::lower_bound(cells.begin(),
                                        cells.end(),
                                        body,
                                        [](const auto &c, auto b) { return c.body < b; });
    const auto last      = std::upper_bound(first, cells.end(), body, [](auto b, const auto &c) {
      return b < c.body;
    });
    first_cell           = first - cells.begin();
    n_cells              = last - first;
    const bool one_point = discretization.get_bodies()[body].integration ==
                           CellIntegration::one_point;
    n_points     = one_point ? 1 : n_gauss_points;
    n_components = Symmetric3<double>::n_components +
                   std::visit([](const auto
                                   &law) { return std::decay_t<decltype(law)>::n_internals; },
                              discretization.material_of(body).law);

    const unsigned int n_batches = (n_cells + n_lanes - 1) / n_lanes;
    node_offsets.resize(std::size_t(n_batches) * 8 * n_lanes);
    owned.resize(std::size_t(n_batches) * n_lanes, 0.);
    state.resize(n_batches * batch_stride(), 0.);
    hourglass.resize(one_point ? n_batches * hourglass_stride : 0, 0.);
    eroded.resize(std::size_t(n_batches) * n_lanes, 0.);
    has_eroded.resize(n_batches, 0);
    frequencies.resize(std::size_t(n_batches) * 2 * n_lanes, 0.);
    watched.resize(n_batches, 0);
    changed.resize(n_batches, 0);
    for (unsigned int batch = 0; batch < n_batches; ++batch)
      {
        const std::size_t begin = std::size_t(batch) * n_lanes;
        n_used_lanes.push_back(std::min<std::size_t>(n_lanes, n_cells - begin));
        for (unsigned int lane = 0; lane < n_lanes; ++lane)
          {
            const bool used  = lane < n_used_lanes.back();
            const auto &cell = cells[first_cell + begin + (used ? lane : 0)];
            for (unsigned int v = 0; v < 8; ++v)
              node_offsets[(std::size_t(batch) * 8 + v) * n_lanes + lane] = 3 * cell.nodes[v];
            owned[begin + lane] = used && cell.owned ? 1. : 0.;
          }
      }
  }


  void
  CellBatches::erode(const std::size_t cell)
  {
    const std::size_t batch = cell / n_lanes, lane = cell % n_lanes;
    for (unsigned int i = 0; i < n_points * n_components; ++i)
      state_at(batch)[i * n_lanes + lane] = 0.;
    if (!hourglass.empty())
      for (unsigned int i = 0; i < 12; ++i)
        hourglass[(batch * 12 + i) * n_lanes + lane] = 0.;
    set_frequency(cell, 0.);
    owned[cell]  = 0.;
    eroded[cell] = 1.;
    watched[batch] &= ~(1u << lane);
    has_eroded[batch] = 1;
  }
} // namespace akmon
