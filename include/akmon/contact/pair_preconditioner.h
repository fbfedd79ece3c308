#pragma once

#include <akmon/contact/cholesky_factor.h>
#include <akmon/contact/coulomb_faces.h>
#include <akmon/contact/delassus.h>
#include <akmon/contact/mobility.h>
#include <akmon/contact/pair.h>

#include <array>
#include <limits>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

namespace akmon
{
  /**
   * Inverse of the scaled Delassus operator in the free directions of its pairs, as far as this
   * rank knows it: Cholesky factors of
   *
   *     S = E^T (A + shift) E + curvatures
   *
   * of the rank's own pairs, where E are their free directions: the normal of a closed pair, both
   * tangents where it sticks, the tangent of the circle where it slips. The Jacobian of the contact
   * problem is S + E^T A (L - E): forces of slip follow normal forces. On a flat interface that
   * rest acts on normal forces only and makes tangential motion only, its square is nothing, and
   * GMRES needs two iterations.
   *
   * A is singular where constraints repeat each other; the shift makes factors regular. A rigid
   * body couples all its pairs by six unknowns, which cost as many iterations at most: it counts on
   * the diagonal only. Pairs that share nodes, directly or through others, are a group with a
   * factor of its own, which is kept, from step to step too, while its free directions are about
   * the same: weights and normals that have changed a little make it no worse.
   */
  class PairPreconditioner
  {
  public:
    using Vector = std::vector<dealii::Tensor<1, 3>>;

    explicit PairPreconditioner(const Mobility &mobility);

    /**
     * The pairs of the coming solutions.
     * @param delassus  of these pairs: scales and frames; referred to
     */
    void
    set_pairs(const std::vector<ContactPair *> &pairs,
              const Delassus &delassus,
              const double mass_factor);

    /// Factors made so far are too far from what they are used for.
    void
    forget();

    /// Whether factors of an earlier step are in use.
    bool
    is_old() const;

    /**
     * What the coming applications are for.
     * @param faces  with the free directions
     * @param shift  added to the unit diagonal
     */
    void
    reinit(const std::vector<CoulombFace> &faces, const double shift);

    /// z close to S^{-1} r in the free directions.
    void
    apply(const Vector &r, Vector &z);

  private:
    // Which pair a row of the operator belongs to, beyond the step.
    struct Key
    {
      unsigned int interface, slot;
      bool reversed;
      ContactNodes::Id slave;

      bool
      operator<(const Key &other) const
      {
        return std::tie(slave, interface, slot, reversed) <
               std::tie(other.slave, other.interface, other.slot, other.reversed);
      }
    };

    // A pair of a factor with its free directions.
    struct Member
    {
      Key key;
      unsigned int pair; ///< its number at present, if there still is one
      CoulombFace face;
      unsigned int first_row, n_rows;
      std::array<dealii::Tensor<1, 3>, 3> directions; ///< of its rows, in the pair's frame
    };

    // Pairs that share nodes, and their factor.
    struct Group
    {
      std::vector<Member> members; ///< sorted by key
      unsigned int n_rows = 0;
      CholeskyFactor cholesky;
      bool valid = false; ///< whether S was positive definite
      bool old   = false; ///< whether it was made in an earlier step
    };

    // What a unit force along a row does to a node: s_i N_ik e.
    struct Entry
    {
      unsigned int node, row;
      dealii::Tensor<1, 3> force;
    };

    static constexpr unsigned int none = std::numeric_limits<unsigned int>::max();

    bool
    is_closed(const unsigned int pair, const std::vector<CoulombFace> &faces) const;
    bool
    still_serve(const std::vector<CoulombFace> &faces) const;
    void
    divide(const std::vector<CoulombFace> &faces);
    unsigned int
    root_of(unsigned int pair);
    bool
    serves(const Group &group,
           const std::vector<unsigned int> &list,
           const std::vector<CoulombFace> &faces) const;
    std::unique_ptr<Group>
    make_group(const std::vector<unsigned int> &list, const std::vector<CoulombFace> &faces);
    void
    make_entries(const Group &group);
    void
    factorize(Group &group);
    void
    find_places();

    const Mobility &mobility;
    double shift = 0.;
    std::vector<ContactPair *> pairs;
    const Delassus *delassus = nullptr;
    double mass_factor       = 1.;

    // Where a pair is a member.
    struct Place
    {
      unsigned int group, member;
    };

    std::vector<std::pair<Key, unsigned int>> present; ///< keys and numbers of the pairs, sorted
    std::vector<std::unique_ptr<Group>> groups;
    std::vector<Place> places;                    ///< by pair
    std::vector<unsigned int> parents;            ///< by pair, while they are divided
    std::vector<unsigned int> pair_at_node;       ///< by contact number, while they are divided
    std::vector<std::vector<unsigned int>> lists; ///< pairs of the groups
    std::vector<Entry> entries;                   ///< of the group in work, sorted by node
    CholeskyFactor::Entries triplets;             ///< of the group in work
    Eigen::VectorXd values, solution;
  };
} // namespace akmon
