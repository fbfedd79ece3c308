#pragma once

#include <akmon/contact/contact.h>
#include <akmon/forces/internal_forces.h>
#include <akmon/model/nodal_state.h>
#include <akmon/output/pvd.h>
#include <akmon/output/vtu_file.h>
#include <akmon/time/fidcd.h>

#include <map>
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
    /// Nodal values as they go into a file, in single precision, ghosted.
    using FieldVector = dealii::LinearAlgebra::distributed::Vector<float>;

    /// What cannot be told at a node from its own state alone.
    struct NodalFields
    {
      explicit NodalFields(const Discretization &discretization);

      FieldVector velocity; ///< length/time
      FieldVector scalars;  ///< contact pressure (force/area), gap (length, of slaves; NaN without
                            ///< partner), status (0 open, 1 slip, 2 stick)
      FieldVector traction; ///< contact's normal and friction force per area
      FieldVector friction; ///< friction force per area
      std::map<dealii::types::global_dof_index, double> bond; ///< strength left, by global number
    };

    void
    fill_velocity(NodalFields &fields) const;
    /// What contact does at owned nodes, of both sides.
    void
    fill_contact_fields(const NodalState &state, NodalFields &fields) const;
    dealii::DataOutBase::Patch<3, 3>
    make_patch(const NodalState &state,
               const NodalFields &fields,
               const CellBatches &batches,
               const std::size_t cell_of_body) const;

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
