#include <akmon/exit_status.h>
#include <akmon/output/directory.h>
#include <akmon/output/fields.h>

#include <deal.II/fe/mapping_q1.h>
#include <deal.II/fe/mapping_q1_eulerian.h>

#include <cmath>
#include <cstdio>
#include <limits>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // The mean Cauchy stress of each cell as a tensor field.
    class StressField : public DataPostprocessorTensor<3>
    {
    public:
      explicit StressField(const std::vector<Symmetric3<double>> &stresses)
        : DataPostprocessorTensor<3>("cauchy_stress", update_values)
        , stresses(stresses)
      {
      }

      void
      evaluate_vector_field(const DataPostprocessorInputs::Vector<3> &inputs,
                            std::vector<Vector<double>> &computed) const override
      {
        const auto &s = stresses[inputs.get_cell<3>()->active_cell_index()];
        for (auto &values : computed)
          {
            const double full[3][3] = {{s[0], s[3], s[4]}, {s[3], s[1], s[5]}, {s[4], s[5], s[2]}};
            for (unsigned int i = 0; i < 3; ++i)
              for (unsigned int j = 0; j < 3; ++j)
                values[Tensor<2, 3>::component_to_unrolled_index(TableIndices<2>(i, j))] = full[i]
                                                                                               [j];
          }
      }

    private:
      const std::vector<Symmetric3<double>> &stresses;
    };


    std::string
    file_name(const std::size_t number)
    {
      char name[32];
      std::snprintf(name, sizeof(name), "fields_%05zu.vtu", number);
      return name;
    }


    const std::vector<DataComponentInterpretation::DataComponentInterpretation> as_vector(
      3,
      DataComponentInterpretation::component_is_part_of_vector);
  } // namespace


  CellAverage
  average_over_cell(const CellBatches &batches, const std::size_t cell_of_body)
  {
    CellAverage average{{{0., 0., 0., 0., 0., 0.}}, 0.};
    const double *const state = batches.state_at(cell_of_body / n_lanes) + cell_of_body % n_lanes;
    for (unsigned int q = 0; q < batches.n_points; ++q)
      {
        const double *const point = state + std::size_t(q) * batches.n_components * n_lanes;
        for (unsigned int c = 0; c < 6; ++c)
          average.stress[c] += point[c * n_lanes] / batches.n_points;
        if (batches.n_components > 6)
          average.plastic_strain += point[6 * n_lanes] / batches.n_points;
      }
    return average;
  }


  Fields::Fields(const std::string &directory,
                 const Discretization &discretization,
                 const InternalForces &internal_forces,
                 const Contact &contact,
                 const Fidcd &integrator,
                 const bool deformed)
    : directory(directory)
    , discretization(discretization)
    , internal_forces(internal_forces)
    , contact(contact)
    , integrator(integrator)
    , deformed(deformed)
    , series(directory + "/fields.pvd", discretization.communicator())
  {
  }


  void
  Fields::write(const NodalState &state)
  {
    const auto &triangulation = discretization.triangulation;
    const auto &dof_handler   = discretization.dof_handler;
    NodalVector displacement  = state.x;
    displacement -= discretization.reference;
    NodalVector velocity = nodal_velocity(), scalars = discretization.make_vector(),
                traction = discretization.make_vector(), friction = discretization.make_vector();
    fill_contact_fields(state, scalars, traction, friction);
    for (NodalVector *const vector : {&displacement, &velocity, &scalars, &traction, &friction})
      vector->update_ghost_values();

    const unsigned int n = triangulation.n_active_cells();
    std::vector<Symmetric3<double>> stresses(n, {{0., 0., 0., 0., 0., 0.}});
    Vector<float> von_mises(n), plastic_strain(n), body(n), rank(n), eroded(n);
    for (const auto &batches : internal_forces.batches())
      for (std::size_t c = 0; c < batches.n_cells; ++c)
        {
          const auto &relevant = discretization.cells[batches.first_cell + c];
          const auto i = DoFHandler<3>::active_cell_iterator(relevant.cell)->active_cell_index();
          const auto average = average_over_cell(batches, c);
          stresses[i]        = average.stress;
          von_mises[i]       = std::sqrt(equivalent_stress_squared(average.stress));
          plastic_strain[i]  = average.plastic_strain;
          body[i]            = relevant.body;
          eroded[i]          = batches.is_eroded(c) ? 1. : 0.;
          rank[i]            = relevant.cell->subdomain_id();
        }

    const StressField stress_field(stresses);
    DataOut<3> data_out;
    DataOutBase::VtkFlags flags;
    flags.time              = state.time;
    flags.cycle             = state.step;
    flags.compression_level = DataOutBase::VtkFlags::ZlibCompressionLevel::best_speed;
    data_out.set_flags(flags);
    data_out.attach_dof_handler(dof_handler);
    data_out.add_data_vector(dof_handler,
                             displacement,
                             std::vector<std::string>(3, "displacement"),
                             as_vector);
    data_out.add_data_vector(dof_handler,
                             velocity,
                             std::vector<std::string>(3, "velocity"),
                             as_vector);
    data_out.add_data_vector(dof_handler,
                             traction,
                             std::vector<std::string>(3, "contact_traction"),
                             as_vector);
    data_out.add_data_vector(dof_handler,
                             friction,
                             std::vector<std::string>(3, "contact_friction"),
                             as_vector);
    data_out.add_data_vector(dof_handler,
                             scalars,
                             std::vector<std::string>{"contact_pressure", "gap", "contact_status"});
    data_out.add_data_vector(displacement, stress_field);
    data_out.add_data_vector(von_mises, "von_mises", DataOut<3>::type_cell_data);
    data_out.add_data_vector(plastic_strain, "plastic_strain", DataOut<3>::type_cell_data);
    data_out.add_data_vector(body, "body", DataOut<3>::type_cell_data);
    data_out.add_data_vector(rank, "rank", DataOut<3>::type_cell_data);
    data_out.add_data_vector(eroded, "eroded", DataOut<3>::type_cell_data);
    if (deformed)
      data_out.build_patches(MappingQ1Eulerian<3, NodalVector>(dof_handler, displacement), 1);
    else
      data_out.build_patches(MappingQ1<3>(), 1);

    const std::string name = file_name(series.size());
    write_file(data_out, name);
    series.add(state.time, name);
  }


  // The operating system knows why a file cannot be created; MPI tells only that it could not
  // write.
  void
  Fields::write_file(const DataOut<3> &data_out, const std::string &name) const
  {
    const std::string path = directory + "/" + name;
    run_on_root(discretization.communicator(), [&]() { replace_file(path, ""); });
    std::string failure;
    try
      {
        data_out.write_vtu_in_parallel(path, discretization.communicator());
      }
    catch (const ExceptionBase &)
      {
        failure = "cannot write '" + path + "'; is the disk full?";
      }
    for (const auto &of_rank : Utilities::MPI::all_gather(discretization.communicator(), failure))
      if (!of_rank.empty())
        throw RunError(ExitStatus::output_failed, of_rank);
  }


  void
  Fields::save(CheckpointWriter &checkpoint) const
  {
    checkpoint.numbers("field_times", series.times());
  }


  void
  Fields::restore(const CheckpointReader &checkpoint)
  {
    std::vector<std::pair<double, std::string>> earlier;
    for (const double time : checkpoint.numbers("field_times"))
      earlier.emplace_back(time, file_name(earlier.size()));
    series.continue_from(earlier);
  }


  NodalVector
  Fields::nodal_velocity() const
  {
    NodalVector velocity = discretization.make_vector();
    for (unsigned int node = 0; node < discretization.n_owned_nodes; ++node)
      {
        const auto v = integrator.velocity(node);
        for (unsigned int d = 0; d < 3; ++d)
          velocity.local_element(3 * node + d) = v[d];
      }
    return velocity;
  }


  // Forces of all interfaces at an owned node over its share of the area that faces the normal
  // force.
  void
  Fields::fill_contact_fields(const NodalState &state,
                              NodalVector &scalars,
                              NodalVector &traction,
                              NodalVector &friction) const
  {
    const auto &areas  = contact.nodal_areas();
    const auto &forces = contact.nodal_forces();
    for (auto first = forces.begin(); first != forces.end();)
      {
        const unsigned int node = first->node;
        Tensor<1, 3> normal, tangential;
        bool sticks = false;
        for (; first != forces.end() && first->node == node; ++first)
          {
            normal += first->normal;
            tangential += first->tangential;
            sticks = sticks || first->sticks;
          }
        const double size = normal.norm(), pressure = areas.pressure(state.x, node, normal);
        scalars.local_element(3 * node)     = pressure;
        scalars.local_element(3 * node + 2) = sticks ? 2. : 1.;
        for (unsigned int d = 0; pressure > 0. && d < 3; ++d)
          {
            traction.local_element(3 * node + d) = (normal[d] + tangential[d]) * (pressure / size);
            friction.local_element(3 * node + d) = tangential[d] * (pressure / size);
          }
      }

    for (unsigned int node = 0; node < discretization.n_owned_nodes; ++node)
      scalars.local_element(3 * node + 1) = std::numeric_limits<double>::quiet_NaN();
    for (const auto &pair : contact.get_pairs())
      {
        if (pair.slave == numbers::invalid_unsigned_int) // of rigid bodies
          continue;
        double &gap = scalars.local_element(3 * pair.slave + 1);
        if (!pair.of_edges && !(gap < pair.gap))
          gap = pair.gap;
        if (pair.normal_force > 0.) // a slave's own pair counts before those it is a master of
          scalars.local_element(3 * pair.slave + 2) = pair.sticks ? 2. : 1.;
      }
  }
} // namespace akmon
