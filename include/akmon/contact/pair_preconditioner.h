#pragma once

#include <akmon/contact/coulomb_faces.h>
#include <akmon/contact/delassus.h>
#include <akmon/contact/mobility.h>
#include <akmon/contact/pair.h>

#include <Eigen/SparseCholesky>
#include <array>
#include <tuple>
#include <utility>
#include <vector>

namespace akmon
{
  /**
   * Inverse of the scaled Delassus operator in the free directions of its pairs, as far as this
   * rank knows it: a sparse Cholesky factor of
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
   * the diagonal only. Factors are kept, from step to step too, while the free directions are about
   * the same: weights and normals that have changed a little make them no worse.
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
    is_old() const
    {
      return old && n_rows > 0;
    }

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

    // A pair of the factor with its free directions.
    struct Member
    {
      Key key;
      unsigned int pair; ///< its number at present, if there still is one
      CoulombFace face;
      unsigned int first_row, n_rows;
      std::array<dealii::Tensor<1, 3>, 3> directions; ///< of its rows, in the pair's frame
    };

    // What a unit force along a row does to a node: s_i N_ik e.
    struct Entry
    {
      unsigned int node, row;
      dealii::Tensor<1, 3> force;
    };

    void
    find_members_again();
    bool
    still_serves(const std::vector<CoulombFace> &faces) const;
    void
    make_members(const std::vector<CoulombFace> &faces);
    void
    make_entries();
    void
    factorize();

    const Mobility &mobility;
    double shift = 0.;
    std::vector<ContactPair *> pairs;
    const Delassus *delassus = nullptr;
    double mass_factor       = 1.;

    std::vector<std::pair<Key, unsigned int>> present; ///< keys and numbers of the pairs, sorted
    std::vector<Member> members;
    std::vector<unsigned int> member_of_pair;
    unsigned int n_rows = 0;
    std::vector<Entry> entries; ///< sorted by node
    std::vector<Eigen::Triplet<double>> triplets;
    Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> cholesky;
    bool valid = false; ///< whether there is a factor
    bool old   = false; ///< whether it was made in an earlier step
    Eigen::VectorXd values;
  };
} // namespace akmon
