#pragma once

#include <akmon/contact/cholesky_factor.h>
#include <akmon/contact/coulomb_faces.h>
#include <akmon/contact/delassus.h>
#include <akmon/contact/lu_factor.h>
#include <akmon/contact/mobility.h>
#include <akmon/contact/pair.h>

#include <array>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

namespace akmon
{
  /**
   * Inverse of the Jacobian of the contact problem, the scaled Delassus operator in the free
   * directions of its pairs:
   *
   *     J = E^T (A L + shift E) + curvatures
   *
   * where E are the free directions: the normal of a closed pair, both tangents where it sticks,
   * the tangent of the circle where it slips; L adds the force of slip that follows a normal force
   * (CoulombFace::lift). Where nothing slips J is symmetric and has a Cholesky factor, elsewhere
   * triangular factors with pivoting.
   *
   * A is singular where constraints repeat each other; the shift makes factors regular. A rigid
   * body couples all its pairs by six unknowns, which cost as many iterations at most: it counts on
   * the diagonal only. Pairs that share nodes, directly or through others, are a group with a
   * factor of its own, which is kept, from step to step too, while its free directions are about
   * the same: weights and normals that have changed a little make it no worse.
   *
   * Every rank has the factors of all groups and computes the same with them, so that iterations,
   * and with them solutions, are those of one rank.
   */
  class PairPreconditioner
  {
  public:
    using Vector = std::vector<dealii::Tensor<1, 3>>;

    PairPreconditioner(const ContactNodes &nodes, const Mobility &mobility);

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

    /// Whether factors of an earlier step are in use; the same on all ranks.
    bool
    is_old() const;

    /**
     * What the coming applications are for (collective).
     * @param faces  with the free directions
     * @param shift  added to the unit diagonal
     */
    void
    reinit(const std::vector<CoulombFace> &faces, const double shift);

    /// z close to J^{-1} r in the free directions (collective).
    void
    apply(const Vector &r, Vector &z);

  private:
    // Which pair it is, beyond the step.
    using Key = std::tuple<ContactNodes::Id,
                           unsigned int,
                           unsigned int,
                           bool,
                           bool,
                           std::array<ContactNodes::Id, 3>>;

    // A closed pair of any rank, with the nodes that couple it.
    struct ClosedPair
    {
      ContactNodes::Id slave;
      unsigned int interface, slot;
      bool reversed, of_edges;
      std::array<ContactNodes::Id, 3> others;
      CoulombFace face;
      unsigned int n_nodes;
      std::array<ContactNodes::Id, 7> nodes;

      Key
      key() const
      {
        return {slave, interface, slot, reversed, of_edges, others};
      }
    };

    // The free directions of a pair, in its frame.
    struct Directions
    {
      unsigned int n = 0;
      std::array<dealii::Tensor<1, 3>, 3> e;

      Directions() = default;
      explicit Directions(const CoulombFace &face);
    };

    // Pairs that share nodes, and their factor.
    struct Group
    {
      std::vector<Key> keys; ///< of its pairs, sorted
      std::vector<CoulombFace> faces;
      std::vector<unsigned int> members; ///< numbers of its pairs among the closed ones
      unsigned int n_rows = 0;
      bool symmetric      = true; ///< no force of slip follows a normal force
      CholeskyFactor cholesky;    ///< if so
      LuFactor lu;                ///< if not
      bool valid = false;         ///< whether J could be factorized
      bool old   = false;         ///< whether it was made in an earlier step
    };

    // What a unit force along a direction e of a pair, and the force of slip that follows it, does
    // to a node, s_i N_ik L e, and the motion that is the pair's along e, s_i M_k^{-1} N_ik e.
    struct Entry
    {
      ContactNodes::Id node; ///< invalid: of a rigid body
      unsigned int pair;     ///< its number among the closed ones
      unsigned int row;      ///< of the pair, then of its group
      dealii::Tensor<1, 3> force, increment;
    };

    bool
    is_closed(const unsigned int pair, const std::vector<CoulombFace> &faces) const;
    bool
    still_serve(const std::vector<CoulombFace> &faces);
    void
    gather_closed_pairs(const std::vector<CoulombFace> &faces);
    std::vector<std::vector<unsigned int>>
    divide() const;
    void
    make_groups(const std::vector<std::vector<unsigned int>> &lists);
    bool
    serves(const Group &group, const std::vector<unsigned int> &list) const;
    void
    number_rows();
    void
    gather_entries(const std::vector<bool> &is_new);
    void
    factorize(Group &group,
              const std::vector<Entry>::const_iterator begin,
              const std::vector<Entry>::const_iterator end);

    const ContactNodes &nodes;
    const Mobility &mobility;
    double shift = 0.;
    std::vector<ContactPair *> pairs;
    const Delassus *delassus = nullptr;
    double mass_factor       = 1.;

    std::vector<unsigned int> own;  ///< closed pairs of this rank
    std::vector<ClosedPair> closed; ///< of all ranks, one after another; faces as in the factors
    std::vector<int> n_closed;      ///< of the ranks
    unsigned int first_own = 0;     ///< number of this rank's first pair among the closed ones
    std::vector<std::unique_ptr<Group>> groups;
    std::vector<unsigned int> group_of, first_row; ///< of the closed pairs
    std::vector<Directions> directions;            ///< of the closed pairs
    std::vector<Entry> entries;                    ///< of new groups, by group, node and row
    CholeskyFactor::Entries triplets;              ///< of the group in work
    Vector own_values, all_values;
    Eigen::VectorXd values;
  };
} // namespace akmon
