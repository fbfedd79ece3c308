#pragma once

#include <akmon/contact/contact_nodes.h>
#include <akmon/contact/pair.h>

#include <deal.II/base/symmetric_tensor.h>

#include <array>
#include <vector>

namespace akmon
{
  /// A pair of any rank that may close in the step, with all that its island has to know.
  struct ClosingPair
  {
    const ContactPair *pair;                               ///< referred to
    std::array<ContactNodes::Id, 7> ids;                   ///< of its nodes
    std::array<dealii::SymmetricTensor<2, 3>, 7> mobility; ///< W of its nodes; 1/mass
    double friction;                                       ///< mu
    dealii::Tensor<1, 3> free_motion;                      ///< G dx_f; length
    bool is_bonded;                                        ///< bonds hold a node of it
    unsigned int rank, number;                             ///< where it comes from
  };


  /// The same, to be sent to other ranks.
  struct SentPair
  {
    ContactPair pair;
    ClosingPair closing;
  };


  /// Of an island, sorted by key.
  using ClosingPairs = std::vector<const ClosingPair *>;


  /// What a solution finds for a pair: t_n and t_tau on its slave; force.
  struct PairForce
  {
    double normal;
    dealii::Tensor<1, 3> tangential;
    bool sticks;
  };
} // namespace akmon
