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
    // A pair's row in a checkpoint. Slaves go by their global node numbers, which are the same on
    // any number of ranks; features of rigid bodies are numbered behind all nodes.
    constexpr std::size_t row_width = 14, of_nodes_only = 10; // before there were pairs of edges


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
      row[10] = pair.of_edges ? 1. : 0.;
      for (unsigned int k = 0; k < 3; ++k)
        row[11 + k] = pair.others[k];
    }


    ContactPair
    from_row(const double *const row, const std::size_t width)
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
      if (width == of_nodes_only)
        return pair;
      pair.of_edges = row[10] != 0.;
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
      if (pair.normal_force != 0. || pair.curvature != 0. || pair.of_edges || pair.of_features)
        carrying.push_back(&pair);
    checkpoint.table("contact_pairs",
                     carrying.size(),
                     row_width,
                     [&](const std::size_t i, double *const row) {
                       const auto &pair = *carrying[i];
                       to_row(pair,
                              pair.slave == numbers::invalid_unsigned_int ?
                                double(discretization.n_global_nodes) + pair.slave_id :
                                discretization.global_node(pair.slave),
                              row);
                     });
    bonds->save(checkpoint);
  }


  void
  Contact::restore(const CheckpointReader &checkpoint)
  {
    const auto &owned          = discretization.partitioner->locally_owned_range();
    const auto [n_rows, width] = checkpoint.size("contact_pairs");
    const bool first_rank = Utilities::MPI::this_mpi_process(discretization.communicator()) == 0;
    pairs.clear();
    checkpoint.rows("contact_pairs",
                    0,
                    n_rows,
                    [&, width = width](const std::size_t, const double *const row) {
                      if (row[2] >= discretization.n_global_nodes)
                        {
                          if (!first_rank)
                            return;
                          pairs.push_back(from_row(row, width));
                          pairs.back().slave    = numbers::invalid_unsigned_int;
                          pairs.back().slave_id = ContactNodes::Id(row[2] -
                                                                   discretization.n_global_nodes);
                          return;
                        }
                      const types::global_dof_index first_dof = 3 * row[2];
                      if (!owned.is_element(first_dof))
                        return;
                      pairs.push_back(from_row(row, width));
                      pairs.back().slave = discretization.partitioner->global_to_local(first_dof) /
                                           3;
                      pairs.back().slave_id = nodes.id_of_local(pairs.back().slave);
                    });
    std::sort(pairs.begin(), pairs.end(), [](const ContactPair &a, const ContactPair &b) {
      return a.key() < b.key();
    });
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
