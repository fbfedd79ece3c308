#pragma once

#include <akmon/contact/coupled/block_factor.h>
#include <akmon/contact/coupled/coulomb_faces.h>
#include <akmon/contact/coupled/delassus.h>
#include <akmon/contact/coupled/matrix_factor.h>
#include <akmon/contact/mobility.h>
#include <akmon/contact/pair.h>

#include <array>
#include <memory>
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
   * (CoulombFace::lift).
   *
   * A is singular where constraints repeat each other; the shift makes factors regular. A rigid
   * body couples all its pairs by six unknowns, which cost as many iterations at most: it counts on
   * the diagonal only. Pairs that share nodes, directly or through others, are a group with a
   * factor of its own, which is kept, from step to step too, while its free directions are about
   * the same: weights and normals that have changed a little make it no worse. Of an operator that
   * has been assembled all pairs are one group, whose factor is exact and made anew in every step.
   *
   * In the blocks of a group directions that are not free stand last, with rows of the unit matrix.
   */
  class PairPreconditioner
  {
  public:
    using Vector = std::vector<dealii::Tensor<1, 3>>;

    /**
     * The pairs of the coming solutions, sorted by their keys. All are referred to.
     * @param delassus  of these pairs: scales and frames
     */
    void
    set_pairs(const std::vector<ContactPair> &pairs,
              const Delassus &delassus,
              const Mobility &mobility,
              const double mass_factor);

    /// The same of an operator that has been assembled.
    void
    set_matrix(const Delassus &delassus);

    /// Factors made so far are too far from what they are used for.
    void
    forget()
    {
      groups.clear();
    }

    /// Whether apply() gives J^{-1} r to rounding.
    bool
    is_exact() const
    {
      return is_assembled() && groups.front()->valid;
    }

    /// Whether factors made for earlier pairs are in use.
    bool
    is_old() const;

    /**
     * What the coming applications are for.
     * @param faces  with the free directions
     * @param shift  added to the unit diagonal
     */
    void
    reinit(const std::vector<CoulombFace> &faces, const double shift);

    /// Whether reinit() would find factors that serve.
    bool
    is_made_for(const std::vector<CoulombFace> &faces, const double shift) const;

    /// z close to J^{-1} r in the free directions.
    void
    apply(const Vector &r, Vector &z);

  private:
    using Key = ContactPair::Key;

    // The free directions of a pair, in its frame.
    struct Directions
    {
      unsigned int n = 0;
      std::array<dealii::Tensor<1, 3>, 3> e;

      Directions() = default;
      explicit Directions(const CoulombFace &face);
    };

    // A closed pair in a group.
    struct Member
    {
      Key key;
      CoulombFace face;
      unsigned int pair; ///< its number
      unsigned int row;  ///< its first one
      Directions directions;

      // What turning along the circle adds, for direction number j.
      double
      curvature_along(const unsigned int j) const
      {
        return face.tangential == CoulombFace::Tangential::circle && directions.e[j] == face.along ?
                 face.curvature :
                 0.;
      }

      // Replace the free components of a vector.
      template <typename Value>
      void
      replace(const Value &value, dealii::Tensor<1, 3> &v) const
      {
        const auto before = v;
        for (unsigned int j = 0; j < directions.n; ++j)
          v += (value(j) - directions.e[j] * before) * directions.e[j];
      }
    };

    // Pairs that share nodes, and their factor.
    struct Group
    {
      std::vector<Member> members; ///< sorted by key
      unsigned int n_rows = 0;
      MatrixFactor by_rows;   ///< of an operator that has been assembled, or without friction
      BlockFactor by_members; ///< of others, a block row for each member
      bool has_blocks = false;
      bool valid      = false; ///< whether J could be factorized
      bool old        = false; ///< whether it was made for other pairs

      void
      clear()
      {
        members.clear();
        n_rows = 0;
        valid = old = has_blocks = false;
      }
    };

    // What unit forces of a member along its free directions, and the forces of slip that follow
    // them, do to a node, s_i N_ik L e, by component with a column for each direction, and the
    // motions that are the pair's along e, s_i M_k^{-1} N_ik e.
    struct Entry
    {
      unsigned int node;
      unsigned int member;
      std::array<BlockFactor::Row, 3> force;
      std::array<dealii::Tensor<1, 3>, 3> increment;
    };

    bool
    is_assembled() const
    {
      return pairs == nullptr;
    }
    bool
    is_closed(const unsigned int pair, const std::vector<CoulombFace> &faces) const;
    bool
    all_serve(const std::vector<CoulombFace> &faces) const;
    std::vector<std::vector<unsigned int>>
    divide() const;
    bool
    serves(const Group &group,
           const std::vector<unsigned int> &list,
           const std::vector<CoulombFace> &faces) const;
    void
    make_group(const std::vector<unsigned int> &list,
               const std::vector<CoulombFace> &faces,
               Group &group);
    static bool
    is_symmetric(const Group &group);
    void
    collect_entries(const Group &group);
    void
    couple(const Group &group);
    void
    factorize(Group &group);
    void
    factorize_normals(Group &group);
    void
    factorize_full(Group &group);
    void
    apply_by_rows(const Group &group, const Vector &r, Vector &z);
    void
    apply_by_members(const Group &group, const Vector &r, Vector &z);

    double shift                          = 0.;
    const std::vector<ContactPair> *pairs = nullptr; ///< unless the operator has been assembled
    const Delassus *delassus              = nullptr;
    const Mobility *mobility              = nullptr;
    double mass_factor                    = 1.;
    std::vector<unsigned int> closed, now_closed; ///< numbers of the pairs in the groups
    std::vector<std::unique_ptr<Group>> groups;
    // Of the group in work.
    std::vector<Entry> entries;                            ///< by member
    Buckets entries_at;                                    ///< by node
    std::vector<unsigned int> coupled_with, coupling_with; ///< by member: the last one, and where
    std::vector<BlockFactor::Block> diagonal;
    std::vector<BlockFactor::Coupling> couplings;
    BlockFactor::Vector block_values;
    MatrixFactor::Entries lower_triangle;
    Eigen::VectorXd values;
    Eigen::MatrixXd jacobian; ///< of an assembled operator
  };
} // namespace akmon
