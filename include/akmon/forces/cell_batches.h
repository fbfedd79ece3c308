#pragma once

#include <akmon/model/discretization.h>
#include <akmon/simd.h>

#include <boost/align/aligned_allocator.hpp>

#include <cstdint>
#include <vector>

namespace akmon
{
  using LaneArray = std::vector<double,
                                boost::alignment::aligned_allocator<double, lane_alignment>>;


  /**
   * The cells of one body in batches of n_lanes, in global cell order, with the state of their
   * quadrature points: [batch][q][component][lane], components xx, yy, zz, xy, xz, yz of the Cauchy
   * stress and then the law's internal variables. The last batch is filled up with copies of its
   * first cell, which are computed but never used.
   */
  struct CellBatches
  {
    static_assert(n_lanes <= 8, "watched and changed have eight bits");

    static constexpr unsigned int n_gauss_points = 8; ///< of a fully integrated cell

    /// Node numbers [node][lane] of a batch, times three: offsets into nodal vectors.
    using NodeOffsets = std::uint32_t[8][n_lanes];

    CellBatches(const Discretization &discretization, const unsigned int body);

    unsigned int
    n_batches() const
    {
      return n_used_lanes.size();
    }

    const NodeOffsets &
    nodes(const unsigned int batch) const
    {
      return *reinterpret_cast<const NodeOffsets *>(&node_offsets[batch * 8 * n_lanes]);
    }

    /// Number of a lane's cell in Discretization::cells.
    std::size_t
    index_of(const unsigned int batch, const unsigned int lane) const
    {
      return first_cell + std::size_t(batch) * n_lanes + (lane < n_used_lanes[batch] ? lane : 0);
    }

    double *
    state_at(const unsigned int batch)
    {
      return &state[batch * batch_stride()];
    }

    const double *
    state_at(const unsigned int batch) const
    {
      return &state[batch * batch_stride()];
    }

    static constexpr std::size_t hourglass_stride = 12 * n_lanes; ///< of a batch

    double *
    hourglass_at(const unsigned int batch)
    {
      return &hourglass[batch * hourglass_stride];
    }

    /// Bound of a cell's omega^2; 1/time^2.
    double
    frequency_bound(const std::size_t cell) const
    {
      return frequencies[frequency_index(cell)] * frequency_growth(cell);
    }

    /// What the bound has grown by since omega^2 was computed last.
    double
    frequency_growth(const std::size_t cell) const
    {
      return frequencies[frequency_index(cell) + n_lanes];
    }

    /// Set a cell's omega^2 as just computed; 1/time^2.
    void
    set_frequency(const std::size_t cell, const double omega_squared)
    {
      frequencies[frequency_index(cell)]           = omega_squared;
      frequencies[frequency_index(cell) + n_lanes] = 1.;
    }

    /// Whether a cell of the body was taken out.
    bool
    is_eroded(const std::size_t cell) const
    {
      return eroded[cell] != 0.;
    }

    /// Let the estimate of the assembled frequency rest on a cell's strain.
    void
    watch(const std::size_t cell)
    {
      if (!is_eroded(cell))
        watched[cell / n_lanes] |= 1u << cell % n_lanes;
    }

    /// Which lanes of a batch are watched.
    Lanes::batch_bool_type
    watched_lanes(const unsigned int batch) const
    {
      alignas(lane_alignment) double lanes[n_lanes];
      for (unsigned int lane = 0; lane < n_lanes; ++lane)
        lanes[lane] = watched[batch] >> lane & 1;
      return Lanes::load_aligned(lanes) > Lanes(0.);
    }

    /// Take a cell out: it has no stress and no frequency any more, and no part in sums.
    void
    erode(const std::size_t cell);

    std::size_t
    batch_stride() const
    {
      return std::size_t(n_points) * n_components * n_lanes;
    }

    static std::size_t
    frequency_index(const std::size_t cell)
    {
      return cell / n_lanes * 2 * n_lanes + cell % n_lanes;
    }

    unsigned int body;
    unsigned int n_points;     ///< quadrature points of a cell, 8 or 1
    unsigned int n_components; ///< 6 + number of internal variables
    std::size_t first_cell;    ///< in Discretization::cells
    std::size_t n_cells;
    std::vector<std::uint32_t> node_offsets;
    std::vector<std::uint8_t> n_used_lanes; ///< per batch
    LaneArray owned;                        ///< [batch][lane], 1 for cells this rank owns, else 0
    LaneArray state;
    LaneArray hourglass; ///< forces Q [batch][pattern][component][lane] of one-point cells; force
    std::vector<std::uint8_t> has_eroded; ///< per batch
    LaneArray eroded; ///< [batch][lane], 1 for cells that were taken out, else 0
    LaneArray
      frequencies; ///< [batch][2][lane]: omega^2 as last computed, bound of its growth since
    std::vector<std::uint8_t>
      watched; ///< per batch, a bit per lane: cells of the last estimate of AssembledFrequency
    std::vector<std::uint8_t> changed; ///< the same: cells that changed since its last full one
  };
} // namespace akmon
