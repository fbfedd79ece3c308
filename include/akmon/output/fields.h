#pragma once

#include <akmon/contact/contact.h>
#include <akmon/forces/internal_forces.h>
#include <akmon/model/nodal_state.h>
#include <akmon/output/pvd.h>
#include <akmon/time/fidcd.h>

#include <deal.II/numerics/data_out.h>

#include <string>
#include <vector>

namespace akmon
{
  /// Field files for ParaView: a .vtu per output tick and the .pvd series of them.
  class Fields
  {
  public:
    Fields(const std::string &directory,
           const Discretization &discretization,
           const InternalForces &internal_forces,
           const Contact &contact,
           const Fidcd &integrator,
           const bool deformed);

    /// Write the current level (collective).
    void
    write(const NodalState &state);

    std::size_t
    n_files() const
    {
      return series.size();
    }

    /// The times of the files written so far (collective).
    void
    save(CheckpointWriter &checkpoint) const;

    /// Go on with the series as it was; its files keep their names.
    void
    restore(const CheckpointReader &checkpoint);

  private:
    void
    write_file(const dealii::DataOut<3> &data_out, const std::string &name) const;
    NodalVector
    nodal_velocity() const;
    /**
     * What contact does at owned nodes, of both sides.
     * @param scalars   contact pressure (force/area), gap (length, of slaves; NaN without partner),
     *                  status (0 open, 1 slip, 2 stick)
     * @param traction  normal and friction force per area
     * @param friction  friction force per area
     */
    void
    fill_contact_fields(const NodalState &state,
                        NodalVector &scalars,
                        NodalVector &traction,
                        NodalVector &friction) const;

    const std::string directory;
    const Discretization &discretization;
    const InternalForces &internal_forces;
    const Contact &contact;
    const Fidcd &integrator;
    const bool deformed;
    PvdSeries series;
  };


  /// Mean over the Gauss points of the Cauchy stress (components as in Symmetric3) and of the first
  /// internal variable of a cell.
  struct CellAverage
  {
    Symmetric3<double> stress;
    double plastic_strain;
  };

  CellAverage
  average_over_cell(const CellBatches &batches, const std::size_t cell_of_body);
} // namespace akmon
