#include <akmon/model/nodal_state.h>

namespace akmon
{
  namespace
  {
    void
    save_vector(const std::string &name, const NodalVector &vector, CheckpointWriter &checkpoint)
    {
      checkpoint.table(name,
                       vector.locally_owned_size() / 3,
                       3,
                       [&](const std::size_t node, double *const values) {
                         for (unsigned int d = 0; d < 3; ++d)
                           values[d] = vector.local_element(3 * node + d);
                       });
    }


    void
    restore_vector(const std::string &name, NodalVector &vector, const CheckpointReader &checkpoint)
    {
      const std::size_t first = vector.get_partitioner()->local_range().first / 3;
      checkpoint.rows(name,
                      first,
                      first + vector.locally_owned_size() / 3,
                      [&](const std::size_t node, const double *const values) {
                        for (unsigned int d = 0; d < 3; ++d)
                          vector.local_element(3 * (node - first) + d) = values[d];
                      });
      vector.update_ghost_values();
    }
  } // namespace


  void
  NodalState::save(CheckpointWriter &checkpoint) const
  {
    checkpoint.integer("step", step);
    checkpoint.numbers("time", {time, dt, dt_next});
    save_vector("x", x, checkpoint);
    save_vector("dx", dx, checkpoint);
    save_vector("dx_next", dx_next, checkpoint);
  }


  void
  NodalState::restore(const CheckpointReader &checkpoint)
  {
    step             = checkpoint.integer("step");
    const auto times = checkpoint.numbers("time");
    time             = times.at(0);
    dt               = times.at(1);
    dt_next          = times.at(2);
    restore_vector("x", x, checkpoint);
    restore_vector("dx", dx, checkpoint);
    restore_vector("dx_next", dx_next, checkpoint);
  }
} // namespace akmon
