#include <akmon/contact/bonds/bonds.h>
#include <akmon/output/fields.h>

#include <cmath>
#include <cstdio>
#include <limits>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    std::string
    file_name(const std::size_t number)
    {
      char name[32];
      std::snprintf(name, sizeof(name), "fields_%05zu.vtu", number);
      return name;
    }


    // In the order of Fields::make_patch().
    PatchValues
    patch_values()
    {
      PatchValues values;
      const auto add = [&](const std::string &name, const unsigned int n_components) {
        const unsigned int first = values.names.size();
        values.names.insert(values.names.end(), n_components, name);
        if (n_components > 1)
          values.groups.emplace_back(first,
                                     first + n_components - 1,
                                     name,
                                     n_components == 3 ?
                                       DataComponentInterpretation::component_is_part_of_vector :
                                       DataComponentInterpretation::component_is_part_of_tensor);
      };
      for (const char *const name :
           {"displacement", "velocity", "contact_traction", "contact_friction"})
        add(name, 3);
      for (const char *const name : {"contact_pressure", "gap", "contact_status", "bond"})
        add(name, 1);
      add("cauchy_stress", 9);
      for (const char *const name : {"von_mises", "plastic_strain", "body", "rank", "eroded"})
        add(name, 1);
      return values;
    }
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


  Fields::NodalFields::NodalFields(const Discretization &discretization)
    : velocity(discretization.partitioner)
    , scalars(discretization.partitioner)
    , traction(discretization.partitioner)
    , friction(discretization.partitioner)
  {
  }


  void
  Fields::write(const NodalState &state)
  {
    // What a rank has of patches, a kilobyte each, at a time.
    constexpr std::size_t cells_of_piece = 16384;

    NodalFields fields(discretization);
    fields.bond = contact.get_bonds().strength_at_nodes();
    fill_velocity(fields);
    fill_contact_fields(state, fields);
    for (FieldVector *const vector :
         {&fields.velocity, &fields.scalars, &fields.traction, &fields.friction})
      vector->update_ghost_values();

    DataOutBase::VtkFlags flags;
    flags.time               = state.time;
    flags.cycle              = state.step;
    flags.compression_level  = DataOutBase::VtkFlags::ZlibCompressionLevel::best_speed;
    const std::string name   = file_name(series.size());
    const PatchValues values = patch_values();
    VtuFile file(directory + "/" + name, values, flags, discretization.communicator());

    std::size_t n_pieces = Utilities::MPI::max((discretization.n_owned_cells + cells_of_piece - 1) /
                                                 cells_of_piece,
                                               discretization.communicator());
    std::vector<DataOutBase::Patch<3, 3>> patches;
    const auto add_piece = [&]() {
      file.add(patches);
      patches.clear();
      --n_pieces;
    };
    for (const auto &batches : internal_forces.batches())
      for (std::size_t c = 0; c < batches.n_cells; ++c)
        if (discretization.cells[batches.first_cell + c].owned)
          {
            patches.push_back(make_patch(state, fields, batches, c));
            patches.back().patch_index = patches.size() - 1;
            if (patches.size() == cells_of_piece)
              add_piece();
          }
    while (n_pieces > 0) // others may have more
      add_piece();
    file.finish();
    series.add(state.time, name);
  }


  // Values in the order of patch_values(), at the cell's corners.
  DataOutBase::Patch<3, 3>
  Fields::make_patch(const NodalState &state,
                     const NodalFields &fields,
                     const CellBatches &batches,
                     const std::size_t cell_of_body) const
  {
    const auto &cell   = discretization.cells[batches.first_cell + cell_of_body];
    const auto average = average_over_cell(batches, cell_of_body);
    const auto &s      = average.stress;
    const std::array<double, 14> of_cell{
      {s[0],
       s[3],
       s[4],
       s[3],
       s[1],
       s[5],
       s[4],
       s[5],
       s[2],
       std::sqrt(equivalent_stress_squared(s)),
       average.plastic_strain,
       double(cell.body),
       double(Utilities::MPI::this_mpi_process(discretization.communicator())),
       batches.is_eroded(cell_of_body) ? 1. : 0.}};
    const std::array<const FieldVector *, 4> of_nodes{
      {&fields.velocity, &fields.traction, &fields.friction, &fields.scalars}};

    DataOutBase::Patch<3, 3> patch;
    patch.reference_cell = ReferenceCells::Hexahedron;
    patch.n_subdivisions = 1;
    patch.data.reinit(3 + 3 * of_nodes.size() + 1 + of_cell.size(), 8);
    for (unsigned int v = 0; v < 8; ++v)
      {
        const unsigned int node = cell.nodes[v];
        const auto X = at_node(discretization.reference, node), x = at_node(state.x, node);
        patch.vertices[v] = Point<3>(deformed ? x : X);
        unsigned int row  = 0;
        for (unsigned int d = 0; d < 3; ++d)
          patch.data(row++, v) = x[d] - X[d];
        for (const auto *const vector : of_nodes)
          for (unsigned int d = 0; d < 3; ++d)
            patch.data(row++, v) = vector->local_element(3 * node + d);
        const auto bond      = fields.bond.find(discretization.global_node(node));
        patch.data(row++, v) = bond != fields.bond.end() ? bond->second : 0.;
        for (const double value : of_cell)
          patch.data(row++, v) = value;
      }
    return patch;
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


  void
  Fields::fill_velocity(NodalFields &fields) const
  {
    for (unsigned int node = 0; node < discretization.n_owned_nodes; ++node)
      {
        const auto v = integrator.velocity(node);
        for (unsigned int d = 0; d < 3; ++d)
          fields.velocity.local_element(3 * node + d) = v[d];
      }
  }


  // Forces of all interfaces at an owned node over its share of the area that faces the normal
  // force.
  void
  Fields::fill_contact_fields(const NodalState &state, NodalFields &fields) const
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
        fields.scalars.local_element(3 * node)     = pressure;
        fields.scalars.local_element(3 * node + 2) = sticks ? 2. : 1.;
        for (unsigned int d = 0; pressure > 0. && d < 3; ++d)
          {
            fields.traction.local_element(3 * node + d) = (normal[d] + tangential[d]) *
                                                          (pressure / size);
            fields.friction.local_element(3 * node + d) = tangential[d] * (pressure / size);
          }
      }

    for (unsigned int node = 0; node < discretization.n_owned_nodes; ++node)
      fields.scalars.local_element(3 * node + 1) = std::numeric_limits<double>::quiet_NaN();
    for (const auto &pair : contact.get_pairs())
      {
        if (!pair.has_slave_node())
          continue;
        float &gap = fields.scalars.local_element(3 * pair.slave + 1);
        if (pair.of_node() && !(gap < pair.gap))
          gap = pair.gap;
        if (pair.normal_force > 0.) // a slave's own pair counts before those it is a master of
          fields.scalars.local_element(3 * pair.slave + 2) = pair.sticks ? 2. : 1.;
      }
  }
} // namespace akmon
