#pragma once

#include <akmon/checkpoint/checkpoint.h>
#include <akmon/forces/cell_batches.h>

#include <limits>
#include <string>
#include <vector>

namespace akmon
{
  /// A cell that cannot be computed any further.
  struct CellFault
  {
    dealii::types::global_cell_index
      cell = std::numeric_limits<dealii::types::global_cell_index>::max();
    std::string body;
    dealii::Point<3> place;    ///< a corner of the cell, length
    bool not_a_number = false; ///< a node's place is none; else the cell is inverted

    bool
    occurred() const
    {
      return cell != std::numeric_limits<dealii::types::global_cell_index>::max();
    }
  };


  /**
   * Stress update and internal forces of all cells in one pass over their batches, and the
   * frequency bound of the cells in their current shape.
   */
  class InternalForces
  {
  public:
    explicit InternalForces(const Discretization &discretization);

    /// Compute the frequencies of all cells in the initial configuration.
    void
    calibrate_initially();

    /**
     * Update the stresses from configuration n to n+1 and subtract the internal forces at n+1.
     * @param x      x_{n+1}, ghosted
     * @param dx     dx_n = x_{n+1} - x_n, ghosted
     * @param force  complete at owned nodes; ghost entries are partial and must not be read
     * @param dt     of the step, time; only viscous hourglass control looks at it
     */
    void
    update(const NodalVector &x,
           const NodalVector &dx,
           NodalVector &force,
           const double dt = std::numeric_limits<double>::infinity());

    /// Largest omega^2 of this rank's cells in the configuration of the last update (or the initial
    /// one).
    double
    largest_frequency_squared() const
    {
      return frequency_squared;
    }

    /// Largest growth of a bound of omega^2: in the last update, among the watched cells; and since
    /// it was last computed, among those that are not watched but beyond the threshold.
    struct Growth
    {
      double watched = 1., elsewhere = 1.;
    };

    const Growth &
    growth() const
    {
      return growth_of_bounds;
    }

    /// Largest bound of omega^2 of this rank's cells now; 1/time^2.
    double
    largest_cell_bound() const;

    /// Compute omega^2 anew where its bound is beyond a limit and may be too large by more than a
    /// factor; mark these cells as changed.
    void
    tighten_bounds(const NodalVector &x, const double limit, const double factor);

    /// omega^2 beyond which cells matter to growth(), 1/time^2; infinite at first.
    double watch_threshold = std::numeric_limits<double>::infinity();

    /// The same in the initial configuration.
    double
    largest_initial_frequency_squared() const
    {
      return initial_frequency_squared;
    }

    /// The omega_max^2 of all ranks that sets the step: cells far below it need no tight bound;
    /// 1/time^2.
    void
    govern(const double largest_of_all_ranks)
    {
      governing_frequency_squared = largest_of_all_ranks;
    }

    /// The cell (index in Discretization::cells) that limits this rank's time step now.
    std::size_t
    limiting_cell_now() const;

    /**
     * Take out the cells of bodies that erode whose omega^2 is beyond a limit, and find the largest
     * of the others anew. The same cells on every rank that computes them.
     */
    void
    erode_beyond(const double frequency_squared_limit);

    /// Cells this rank owns that were taken out so far.
    unsigned long
    n_eroded() const
    {
      return n_eroded_cells;
    }

    /// The cell (index in Discretization::cells) that limits the time step, in the initial
    /// configuration.
    std::size_t
    limiting_cell() const
    {
      return initially_limiting_cell;
    }

    /// The inverted or non-finite cell the last update met, if any.
    const CellFault &
    fault() const
    {
      return cell_fault;
    }

    /// Stress work done so far on the cells this rank owns, elastic and plastic together; energy.
    double
    internal_work() const
    {
      return work;
    }

    /// Plastic part of internal_work(); energy.
    double
    plastic_work() const
    {
      return dissipated;
    }

    /// Work done so far against the hourglass control of the one-point cells this rank owns;
    /// energy.
    double
    hourglass_work() const
    {
      return hourglass;
    }

    const std::vector<CellBatches> &
    batches() const
    {
      return body_batches;
    }

    std::vector<CellBatches> &
    batches()
    {
      return body_batches;
    }

    /// Stresses, internal variables and frequencies of all cells in global order, and the works
    /// (collective).
    void
    save(CheckpointWriter &checkpoint) const;

    /// Take them back, those of ghost cells too.
    void
    restore(const CheckpointReader &checkpoint);

  private:
    double
    calibrate(const NodalVector &x, CellBatches &batches, const std::vector<std::size_t> &wanted);
    Lanes::batch_bool_type
    bound_frequency(const Lanes &strain_squared,
                    CellBatches &batches,
                    const unsigned int batch,
                    Lanes &largest,
                    Lanes &growth_of_watched,
                    Lanes &growth_elsewhere) const;
    void
    remove_invalid(const NodalVector &x,
                   CellBatches &batches,
                   const unsigned int batch,
                   const Lanes::batch_bool_type &valid);
    void
    erode(CellBatches &batches, const std::size_t cell);
    void
    report_fault(const NodalVector &x,
                 const CellBatches &batches,
                 unsigned int batch,
                 unsigned int lane,
                 const bool not_a_number);

    template <CellIntegration integration, typename Law>
    void
    update_body(const Law &law,
                const NodalVector &x,
                const NodalVector &dx,
                const double dt,
                CellBatches &batches,
                NodalVector &force);

    const Discretization &discretization;
    std::vector<CellBatches> body_batches;
    std::vector<std::size_t> to_calibrate; ///< cells of the body in work with too loose bounds
    double frequency_squared           = 0.;
    double initial_frequency_squared   = 0.;
    double governing_frequency_squared = 0.;
    Growth growth_of_bounds;
    std::size_t initially_limiting_cell = 0;
    unsigned long n_eroded_cells        = 0;
    double work                         = 0.;
    double dissipated                   = 0.;
    double hourglass                    = 0.;
    CellFault cell_fault;
  };
} // namespace akmon
