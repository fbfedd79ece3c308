#include <akmon/contact/contact.h>
#include <akmon/contact/penalty.h>
#include <akmon/contact/search/face_geometry.h>
#include <akmon/output/history.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

// Contact by penalty springs.

namespace akmon
{
  using namespace dealii;

  double
  penalty_stiffness(const Discretization &discretization, const BoundaryFace &face)
  {
    const auto corners  = segment_of(face, discretization.reference);
    const auto &elastic = discretization.material_of(face.body).elasticity();
    // V = A times the depth
    return (elastic.lambda + 2. / 3. * elastic.mu) * area_vector(corners).norm() / face.depth;
  }


  std::map<unsigned int, double>
  penalty_stiffness_of_nodes(const Discretization &discretization,
                             const std::vector<BoundaryFace> &faces)
  {
    std::map<unsigned int, std::pair<double, unsigned int>> sums;
    for (const auto &face : faces)
      {
        const double of_face = penalty_stiffness(discretization, face);
        for (const unsigned int node : face.nodes)
          if (node < discretization.n_owned_nodes)
            {
              sums[node].first += of_face;
              ++sums[node].second;
            }
      }
    std::map<unsigned int, double> means;
    for (const auto &[node, sum] : sums)
      means[node] = sum.first / sum.second;
    return means;
  }


  double
  Contact::spring(const ContactPair &pair) const
  {
    return solver.penalty_scale * pair.stiffness;
  }


  // t_n = f_s k max(0, -g) of the present gap.
  void
  Contact::penalty_normal()
  {
    for (auto &pair : pairs)
      pair.normal_force = spring(pair) * std::max(0., -pair.gap);
  }


  // The force of the last level less what the slip since then adds, returned to Coulomb's circle.
  void
  Contact::penalty_friction(const NodalState &state)
  {
    for (auto &pair : pairs)
      {
        const double limit = friction_coefficient(pair, state) * pair.normal_force;
        const auto trial   = pair.tangential_force -
                           spring(pair) * pair.tangential_part(pair.relative(dx));
        const auto result     = Coulomb::tangential_force(trial, limit);
        pair.tangential_force = result.force;
        pair.sticks           = result.sticks;
      }
  }


  std::vector<Contact::Work>
  Contact::stored_energies() const
  {
    std::vector<Work> sums(contacts.size() + bodies.size());
    if (stores_energy())
      for (const auto &pair : pairs)
        if (pair.normal_force > 0.)
          {
            sums[pair.interface].normal += 0.5 * pair.normal_force * pair.normal_force /
                                           spring(pair);
            sums[pair.interface].tangential += 0.5 * pair.tangential_force.norm_square() /
                                               spring(pair);
          }
    return sums;
  }


  // K_c = sum_i k_i G_i^T G_i, so that the largest eigenvalue of M^{-1} K_c is that of
  // k^{1/2} G M^{-1} G^T k^{1/2}, which row sums bound as in Delassus::norm_bound().
  PenaltyLimit
  Contact::penalty_limit()
  {
    constexpr double faster = 2.; // than now, at most, within a step
    constexpr double near = 0.02; // of a cell: a step that jumped at every bounce would pump energy

    PenaltyLimit limit;
    if (solver.type != ContactSolver::Type::penalty)
      return limit;
    set_rigid_mobilities();
    std::vector<const ContactPair *> closed;
    for (const auto &pair : pairs)
      if (pair.gap + faster * std::min(0., pair.normal * pair.relative(dx)) <= near * pair.size)
        closed.push_back(&pair);
    const auto coefficient = [&](const ContactPair &pair, const unsigned int k) {
      return pair.bound_at_node(k) * std::sqrt(spring(pair));
    };
    ContactNodes::Field sums;
    nodes.make(sums);
    for (const ContactPair *const pair : closed)
      for (unsigned int k = 0; k < pair->n_nodes; ++k)
        sums.add(pair->nodes[k], Tensor<1, 3>({coefficient(*pair, k), 0., 0.}));
    nodes.add_to_owners(sums);
    nodes.update_ghosts(sums);
    const ContactPair *stiffest = nullptr;
    for (const ContactPair *const pair : closed)
      {
        double row = 0.;
        for (unsigned int k = 0; k < pair->n_nodes; ++k)
          row += coefficient(*pair, k) * sums[pair->nodes[k]][0] *
                 mobility.inverse_mass(pair->nodes[k]);
        if (row > limit.frequency_squared)
          {
            limit.frequency_squared = row;
            stiffest                = pair;
          }
      }
    const double of_rank    = limit.frequency_squared;
    limit.frequency_squared = Utilities::MPI::max(of_rank, discretization.communicator());
    if (stiffest && of_rank == limit.frequency_squared)
      limit.where = "'" + law_of(*stiffest).name + "' near " + place_text(x[stiffest->nodes[0]]);
    return limit;
  }
} // namespace akmon
