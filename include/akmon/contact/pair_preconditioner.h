#pragma once

#include <akmon/contact/coulomb_faces.h>
#include <akmon/contact/delassus.h>
#include <akmon/contact/mobility.h>
#include <akmon/contact/pair.h>

#include <Eigen/SparseCholesky>
#include <utility>
#include <vector>

namespace akmon
{
  /**
   * Inverse of the scaled Delassus operator in the free directions of its pairs, as far as this
   * rank knows it: sparse Cholesky factors of the rank's own block, of A_nn on the pairs whose
   * normal force is free and of the scalar sum_k w_ik w_jk / m*_k, which acts on each component of
   * tangential forces, on those that stick. The latter leaves out that contact planes are turned
   * against each other, and levers. Pairs that slip count with their diagonal. A is singular where
   * constraints repeat each other; a small shift makes the factors regular. A rigid body couples
   * all its pairs by six unknowns, which cost conjugate gradients as many iterations at most: it
   * counts on the diagonal only.
   *
   * Factors are kept as long as they belong to the same pairs and free directions, from step to
   * step too: weights and normals that have changed a little make them no worse.
   */
  class PairPreconditioner
  {
  public:
    using Vector = std::vector<dealii::Tensor<1, 3>>;

    /// @param shift  added to the unit diagonal: above what rounding makes of repeated constraints
    PairPreconditioner(const Mobility &mobility, const double shift);

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
      return (normal.old && !normal.members.empty()) ||
             (tangential.old && !tangential.members.empty());
    }

    /// The faces whose free directions the coming applications are for.
    void
    reinit(const std::vector<CoulombFace> &faces);

    /// z close to A^{-1} r in the free directions.
    void
    apply(const Vector &r, Vector &z);

  private:
    using Key = decltype(std::declval<const ContactPair &>().key());

    struct Factor
    {
      std::vector<unsigned int> members; ///< numbers of the pairs, in order
      std::vector<Key> keys;
      Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> cholesky;
      bool valid = false, old = false;
    };

    void
    update(Factor &factor, const bool along_normals);
    void
    factorize(Factor &factor, const bool along_normals);

    const Mobility &mobility;
    const double shift;
    std::vector<ContactPair *> pairs;
    const Delassus *delassus = nullptr;
    double mass_factor       = 1.;

    // Coefficients s_i w_ik m*_k^{-1/2} of the pairs, sorted by node.
    struct Entry
    {
      unsigned int node, pair;
      double coefficient;
    };
    std::vector<Entry> entries;
    std::vector<double> rigid_share; ///< by pair: what rigid bodies add to the unit diagonal
    std::vector<CoulombFace> faces;
    std::vector<unsigned int> row_of_pair; ///< in the factor in work
    std::vector<Eigen::Triplet<double>> triplets;
    Factor normal, tangential;
    Eigen::VectorXd values;
    Eigen::MatrixX3d vectors;
  };
} // namespace akmon
