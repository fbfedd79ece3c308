#pragma once

#include <akmon/contact/contact_nodes.h>
#include <akmon/contact/contact_parameters.h>
#include <akmon/contact/coupled/delassus.h>
#include <akmon/contact/coupled/pair_preconditioner.h>
#include <akmon/contact/coupled/semismooth_newton.h>
#include <akmon/contact/mobility.h>
#include <akmon/contact/pair.h>

#include <array>
#include <vector>

namespace akmon
{
  class Bonds;

  /// A pair of any rank that may close in the step, with all that its island has to know.
  struct ClosingPair
  {
    ContactPair pair;
    std::array<ContactNodes::Id, 7> ids;                   ///< of its nodes
    std::array<dealii::SymmetricTensor<2, 3>, 7> mobility; ///< W of its nodes; 1/mass
    double friction;                                       ///< mu
    dealii::Tensor<1, 3> free_motion;                      ///< G dx_f; length
    bool is_bonded;                                        ///< bonds hold a node of it
    unsigned int rank, number;                             ///< where it comes from
  };

  /**
   * Contact pairs that share nodes, directly or through others, and with them a problem that no
   * other pair takes part in: (72)-(75) for their forces, in a numbering of their nodes of its own.
   * Constraints may repeat each other: a small compliance makes forces unique.
   */
  class ContactIsland
  {
  public:
    using Newton = SemismoothNewton<Delassus, PairPreconditioner>;

    /**
     * Begin with the forces that the pairs have. Factors of earlier pairs are kept.
     * @param members          sorted by key
     * @param first_common_id  of nodes of rigid bodies
     * @param bonds            that hold any of the nodes, if there are such
     */
    void
    reinit(const std::vector<const ClosingPair *> &members,
           const ContactNodes::Id first_common_id,
           const Bonds *bonds,
           const double effective_mass_factor);

    /**
     * Find forces for the free motions and target gaps of the same members.
     * @param tolerance  relative to the cell size
     */
    void
    solve(const std::vector<const ClosingPair *> &members,
          const ContactSolver &parameters,
          const double tolerance,
          Newton &newton);

    /// Whether the last solution is for the target gaps of the same members.
    bool
    is_solved_for(const std::vector<const ClosingPair *> &members) const;

    /// With the forces of the last solution.
    const std::vector<ContactPair> &
    get_pairs() const
    {
      return pairs;
    }

    /// Of the last solution.
    const Newton::Result &
    get_result() const
    {
      return result;
    }

  private:
    void
    number_nodes(const std::vector<const ClosingPair *> &members,
                 const ContactNodes::Id first_common_id);
    void
    start_elsewhere(const unsigned int limit, Newton &newton);
    double
    largest_overlap();
    void
    let_slip(const unsigned int limit, Newton &newton);
    void
    solve_one_by_one();

    std::vector<ContactPair> pairs; ///< their nodes are numbers of the island
    std::vector<ContactNodes::Id> ids;
    Mobility mobility;
    Delassus delassus;
    PairPreconditioner preconditioner;
    unsigned int iterations_when_new = 0; ///< that fresh factors took
    FrictionalProblem problem;            ///< in tau_i = t_i/s_i
    Delassus::Vector tau;
    std::vector<CoulombFace> faces;
    Newton::Result result{};
  };
} // namespace akmon
