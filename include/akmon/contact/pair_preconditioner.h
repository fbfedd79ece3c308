#pragma once

#include <akmon/contact/coulomb_faces.h>
#include <akmon/contact/delassus.h>
#include <akmon/contact/mobility.h>
#include <akmon/contact/pair.h>

#include <Eigen/SparseCholesky>
#include <tuple>
#include <vector>

namespace akmon
{
  /**
   * Inverse of the scaled Delassus operator in the free directions of its pairs: sparse Cholesky
   * factors of A_nn on the pairs whose normal force is free and of the scalar
   * sum_k w_ik w_jk / m*_k, which acts on each component of tangential forces, on those that stick.
   * The latter leaves out that contact planes are turned against each other, and levers. Pairs that
   * slip count with their diagonal. A is singular where constraints repeat each other; a small
   * shift makes the factors regular. A rigid body couples all its pairs by six unknowns, which cost
   * GMRES as many iterations at most: it counts on the diagonal only.
   *
   * Every rank has the factors of all free pairs and computes the same with them, so that
   * iterations, and with them solutions, are those of one rank. All members are collective.
   *
   * Factors are kept as long as they belong to the same pairs and free directions, from step to
   * step too: weights and normals that have changed a little make them no worse.
   */
  class PairPreconditioner
  {
  public:
    using Vector = std::vector<dealii::Tensor<1, 3>>;

    /// @param shift  added to the unit diagonal: above what rounding makes of repeated constraints
    PairPreconditioner(const ContactNodes &nodes, const Mobility &mobility, const double shift);

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
      return (normal.old && !normal.rows.empty()) || (tangential.old && !tangential.rows.empty());
    }

    /// The faces whose free directions the coming applications are for.
    void
    reinit(const std::vector<CoulombFace> &faces);

    /// z close to A^{-1} r in the free directions.
    void
    apply(const Vector &r, Vector &z);

  private:
    // Which pair a row of the operator belongs to, beyond the step; the order of rows.
    struct Key
    {
      unsigned int interface;
      bool reversed;
      ContactNodes::Id slave;
      unsigned int slot;

      std::tuple<unsigned int, bool, ContactNodes::Id, unsigned int>
      values() const
      {
        return {interface, reversed, slave, slot};
      }
    };

    // What the matrix has of a pair: its diagonal without entries.
    struct Row
    {
      Key key;
      double diagonal;
      dealii::Tensor<1, 3> normal;
    };

    // Coefficient s_i w_ik m*_k^{-1/2} of a row at a node.
    struct Entry
    {
      ContactNodes::Id node;
      unsigned int row;
      double coefficient;
    };

    struct Factor
    {
      std::vector<unsigned int> members; ///< numbers of this rank's pairs, in order
      std::vector<Key> keys;             ///< of the members
      std::vector<unsigned int> rows; ///< in the matrix, of the members of one rank after another
      std::vector<int> n_members;     ///< of the ranks
      Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> cholesky;
      bool valid = false, old = false;
    };

    void
    update(Factor &factor, const bool along_normals);
    void
    factorize(Factor &factor, const bool along_normals);
    void
    gather_rows(Factor &factor);
    void
    solve(const Factor &factor, const unsigned int n_columns);

    const ContactNodes &nodes;
    const Mobility &mobility;
    const double shift;
    std::vector<ContactPair *> pairs;
    const Delassus *delassus = nullptr;
    double mass_factor       = 1.;
    std::vector<CoulombFace> faces;
    std::vector<Row> rows;      ///< of the factor in work, of all ranks
    std::vector<Entry> entries; ///< of these rows
    std::vector<Eigen::Triplet<double>> triplets;
    Factor normal, tangential;
    std::vector<dealii::Tensor<1, 3>> values, all_values; ///< of this rank's members, of all rows
    Eigen::MatrixXd vectors;
  };
} // namespace akmon
