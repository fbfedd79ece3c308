#include <akmon/contact/bonds/bonds.h>
#include <akmon/contact/contact.h>
#include <akmon/contact/coupled/coupled_solver.h>

#include <deal.II/base/mpi.h>

#include <algorithm>

// What contact carries from step to step, in checkpoints.

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // A pair's row in a checkpoint. Slave nodes go by their global numbers, which are the same on
    // any number of ranks.
    constexpr std::size_t row_width = 14;


    void
    to_row(const ContactPair &pair, const double slave, double *const row)
    {
      row[0] = pair.interface;
      row[1] = pair.reversed ? 1. : 0.;
      row[2] = slave;
      row[3] = pair.normal_force;
      for (unsigned int d = 0; d < 3; ++d)
        row[4 + d] = pair.tangential_force[d];
      row[7]  = pair.sticks ? 1. : 0.;
      row[8]  = pair.slot;
      row[9]  = pair.curvature;
      row[10] = static_cast<double>(pair.kind);
      for (unsigned int k = 0; k < 3; ++k)
        row[11 + k] = pair.others[k];
    }


    ContactPair
    from_row(const double *const row)
    {
      ContactPair pair{};
      pair.interface    = row[0];
      pair.reversed     = row[1] != 0.;
      pair.normal_force = row[3];
      for (unsigned int d = 0; d < 3; ++d)
        pair.tangential_force[d] = row[4 + d];
      pair.sticks    = row[7] != 0.;
      pair.slot      = row[8];
      pair.curvature = row[9];
      pair.kind      = static_cast<ContactPair::Kind>(row[10]);
      for (unsigned int k = 0; k < 3; ++k)
        pair.others[k] = ContactNodes::Id(row[11 + k]);
      return pair;
    }
  } // namespace


  void
  Contact::save(CheckpointWriter &checkpoint) const
  {
    // The others start from nothing. Edges remain a pair where they would not become one.
    std::vector<const ContactPair *> carrying;
    for (const auto &pair : pairs)
      if (pair.normal_force != 0. || pair.curvature != 0. || !pair.of_node())
        carrying.push_back(&pair);
    checkpoint.table("contact_pairs",
                     carrying.size(),
                     row_width,
                     [&](const std::size_t i, double *const row) {
                       const auto &pair = *carrying[i];
                       to_row(pair,
                              pair.has_slave_node() ? discretization.global_node(pair.slave) :
                                                      pair.slave_id,
                              row);
                     });
    bonds->save(checkpoint);
  }


  void
  Contact::restore(const CheckpointReader &checkpoint)
  {
    const auto &owned        = discretization.partitioner->locally_owned_range();
    const std::size_t n_rows = checkpoint.size("contact_pairs").first;
    const bool first_rank    = Utilities::MPI::this_mpi_process(discretization.communicator()) == 0;
    pairs.clear();
    checkpoint.rows("contact_pairs", 0, n_rows, [&](const std::size_t, const double *const row) {
      ContactPair pair                        = from_row(row);
      const types::global_dof_index first_dof = 3 * row[2];
      if (!pair.has_slave_node())
        {
          pair.slave    = numbers::invalid_unsigned_int;
          pair.slave_id = ContactNodes::Id(row[2]);
        }
      else if (owned.is_element(first_dof))
        {
          pair.slave    = discretization.partitioner->global_to_local(first_dof) / 3;
          pair.slave_id = nodes.id_of_local(pair.slave);
        }
      if (pair.has_slave_node() ? owned.is_element(first_dof) : first_rank)
        pairs.push_back(pair);
    });
    std::sort(pairs.begin(), pairs.end(), by_key);
    bonds->restore(checkpoint);
    forget_shortcuts();
  }


  void
  Contact::forget_shortcuts()
  {
    prepared  = false;
    travelled = 0.;
    for (auto &search : obstacle_searches)
      search.forget_rests();
    coupled->start_afresh();
  }
} // namespace akmon
