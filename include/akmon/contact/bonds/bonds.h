#pragma once

#include <akmon/checkpoint/checkpoint.h>
#include <akmon/contact/bonds/bond_points.h>
#include <akmon/contact/contact_nodes.h>
#include <akmon/contact/pair.h>
#include <akmon/model/essential_conditions.h>
#include <akmon/model/nodal_state.h>
#include <akmon/output/energy_balance.h>

#include <Eigen/SparseCholesky>
#include <array>
#include <map>
#include <vector>

namespace akmon
{
  /**
   * The bonds of all tied contacts. Unbroken points keep C x as it was at the start, exactly at
   * every level, by forces C^T t that solve C m*^{-1} C^T t = -(C (x + dx_f) - C X) for all points
   * at once; points that fail give a traction on their shrinking strength instead (BondLaw).
   * Contact forces find nodes whose motion the bonds have been taken out of: m*^{-1} becomes
   * m*^{-1} - m*^{-1} C^T (C m*^{-1} C^T)^{-1} C m*^{-1} in the Delassus operator.
   *
   * Every rank knows all points and computes the same: results do not depend on their number.
   */
  class Bonds
  {
  public:
    /// Throws InputError for surfaces that cannot be tied (collective).
    Bonds(const Discretization &discretization,
          const std::vector<SurfaceContact> &contacts,
          const EssentialConditions &conditions);

    /// Whether any point is unbroken; the same on all ranks.
    bool
    exist() const
    {
      return n_unbroken > 0;
    }

    /// Whether the bonds keep a pair's slave in this step, so that it needs no contact.
    bool
    hold(const ContactPair &pair) const;

    /// Whether unbroken points take part in the motion of a contact node.
    bool
    hold_node(const ContactNodes::Id id) const
    {
      return number_of(id) != dealii::numbers::invalid_unsigned_int;
    }

    /// Take up the masses of the nodes, which may have been scaled (collective).
    void
    update_mobilities();

    /// Tell the numbers of contact nodes (collective).
    void
    set_numbers(const ContactNodes &nodes);

    /**
     * Decide which points fail and add what all points do to the increments of the owned nodes
     * (collective).
     * @param dx_free  increments of the step without bonds and contact
     */
    void
    begin_step(const NodalState &state,
               const double effective_mass_factor,
               ContactNodes::Field &dx_free);

    /// Take out of increments of owned nodes what holding points do not let happen (collective).
    void
    project(ContactNodes::Field &increments) const;

    /// The same for increments of any nodes, all others being at rest.
    /// @param ids  of the nodes
    void
    project(const std::vector<ContactNodes::Id> &ids, ContactNodes::Field &increments) const;

    /// Force at an owned node; force.
    struct NodalForce
    {
      unsigned int node; ///< local number
      unsigned int interface;
      dealii::Tensor<1, 3> holding, failing;

      dealii::Tensor<1, 3>
      sum() const
      {
        return holding + failing;
      }
    };

    /**
     * The final forces of the step for given contact forces (collective).
     * @param contact_force  force at an owned node (local number)
     */
    const std::vector<NodalForce> &
    finish_step(const double effective_mass_factor,
                const std::map<unsigned int, dealii::Tensor<1, 3>> &contact_force);

    const std::vector<NodalForce> &
    nodal_forces() const
    {
      return forces;
    }

    /// On the slaves of an interface, at the last level.
    struct Load
    {
      dealii::Tensor<1, 3> normal, tangential; ///< force
      dealii::Tensor<1, 3> moment;             ///< about the origin; force length
    };

    Load
    load_on(const unsigned int interface) const;

    /// Share of the points that are broken, and area and energy of all points of an interface.
    struct Report
    {
      double area = 0., broken_area = 0., energy = 0.;
    };

    Report
    report(const unsigned int interface) const;

    /// The part of the strength of a node's bonds that is left, by area: 1 intact, 0 broken. Of all
    /// nodes with bonds, the same on all ranks, by global number.
    std::map<dealii::types::global_dof_index, double>
    strength_at_nodes() const;

    void
    save(CheckpointWriter &checkpoint) const;

    void
    restore(const CheckpointReader &checkpoint);

  private:
    using Values = std::vector<dealii::Tensor<1, 3>>; ///< by node, or by point

    // What a point still lets not happen: pressed points that fail slide.
    enum class Holds
    {
      all,
      normal,
      nothing
    };

    using Entry = std::pair<unsigned int, double>; ///< number in `nodes`, part in C

    struct Point
    {
      unsigned int interface;
      unsigned int slave; ///< number in `nodes`
      double area;
      std::vector<Entry> row;                         ///< C, sorted
      std::vector<std::array<unsigned int, 4>> faces; ///< of the slave, by number in `nodes`
      std::vector<dealii::Tensor<1, 3>> arms;         ///< r_k by entry; length. Often empty
      dealii::Tensor<2, 3> lever;                     ///< [o x] I^{-1}; 1/length
      dealii::Tensor<1, 3> offset;                    ///< o that is held; length
      dealii::Tensor<1, 3> normal;                    ///< from master to slave
      dealii::Tensor<1, 3> force;                     ///< on the slave side
      WorkLine energy;                                ///< taken so far
      bool broken = false, softening = false;
      Holds holds = Holds::all;   ///< at this level
      dealii::Tensor<1, 3> given; ///< part of the force that failing points give; force
    };

    // A direction in which a point holds.
    struct Row
    {
      unsigned int point;
      dealii::Tensor<1, 3> direction;

      bool
      operator==(const Row &other) const
      {
        return point == other.point && direction == other.direction;
      }
    };

    // Cholesky factors of C W C^T in some directions of some points, W = P/m.
    struct System
    {
      std::vector<Row> rows;
      Eigen::SparseMatrix<double> matrix; ///< its lower half
      Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> cholesky;
      bool valid = false;
    };

    // A value per node from what its owner says (collective).
    template <typename Value>
    Values
    gather(const Value &value_at_own) const;
    unsigned int
    number_of(const ContactNodes::Id id) const;
    void
    take_out_motion_of_points(Values &u) const;
    void
    number_nodes(const std::vector<std::vector<TiedFace>> &faces);
    void
    count_unbroken();
    void
    mark_held();
    void
    factorize(System &system, const std::vector<Row> &rows) const;
    Eigen::VectorXd
    solve(const System &system, const Eigen::VectorXd &b) const;
    dealii::Tensor<1, 3>
    offset_at(const Point &point, const Values &positions) const;
    dealii::Tensor<1, 3>
    relative(const Point &point, const Values &u) const;
    // Calls visitor(entry, part) with the parts of C^T t.
    template <typename Visitor>
    static void
    visit_parts(const Point &point, const dealii::Tensor<1, 3> &t, const Visitor &visitor);
    void
    add_response(const Point &point, const dealii::Tensor<1, 3> &force, Values &u) const;
    void
    update_normals(const Values &positions);
    void
    turn_offsets(const Values &positions, const Values &increments);
    void
    follow_slip(const Values &positions);
    void
    set_levers(const Values &positions);
    bool
    let_fail(const System &system, const Eigen::VectorXd &t);
    double
    strength_left(const Point &point) const;
    void
    fail(Point &point, const dealii::Tensor<1, 3> &trial, const double r);
    Eigen::VectorXd
    hold_points(const System &system, const Values &reached) const;
    std::vector<Row>
    holding_rows() const;
    const System &
    system_now();
    void
    collect_forces();

    struct Own
    {
      unsigned int node;       ///< number in `nodes`
      unsigned int local_node; ///< of the discretization
      unsigned int number;     ///< contact number
    };

    const Discretization &discretization;
    const std::vector<SurfaceContact> &contacts;
    const EssentialConditions &conditions;
    std::vector<Point> points;                          ///< by interface and slave
    std::vector<dealii::types::global_dof_index> nodes; ///< of all tied surfaces, sorted
    std::vector<ContactNodes::Id> ids;                  ///< of the nodes, sorted too
    std::vector<dealii::SymmetricTensor<2, 3>> W;       ///< by node; 1/mass
    std::vector<Own> own;
    std::vector<int> counts, first_of_rank;           ///< of values of the ranks in a gather
    std::vector<unsigned int> order;                  ///< node of the values in rank order
    std::map<unsigned int, unsigned int> number_here; ///< by local node, of own nodes
    std::vector<unsigned int> uses;                   ///< by node: of unbroken points
    std::vector<bool> held, held_slaves;              ///< by node: by points that hold
    std::vector<unsigned int> unbroken;
    unsigned int n_unbroken = 0;

    System full, reduced;
    const System *active = nullptr; ///< of what holds in this step
    double mass_factor   = 1.;
    Values x, before;               ///< by node: positions; last increments
    Values free;                    ///< by node: reached without bonds and contact
    std::vector<NodalForce> forces; ///< by own node
  };


  template <typename Visitor>
  void
  Bonds::visit_parts(const Point &point, const dealii::Tensor<1, 3> &t, const Visitor &visitor)
  {
    const auto turn = t * point.lever;
    for (std::size_t k = 0; k < point.row.size(); ++k)
      if (point.arms.empty())
        visitor(point.row[k], point.row[k].second * t);
      else
        visitor(point.row[k], point.row[k].second * t + cross_product_3d(turn, point.arms[k]));
  }


  template <typename Value>
  Bonds::Values
  Bonds::gather(const Value &value_at_own) const
  {
    std::vector<double> here(3 * own.size()), all(3 * nodes.size());
    for (std::size_t i = 0; i < own.size(); ++i)
      {
        const dealii::Tensor<1, 3> value = value_at_own(own[i]);
        for (unsigned int d = 0; d < 3; ++d)
          here[3 * i + d] = value[d];
      }
    MPI_Allgatherv(here.data(),
                   here.size(),
                   MPI_DOUBLE,
                   all.data(),
                   counts.data(),
                   first_of_rank.data(),
                   MPI_DOUBLE,
                   discretization.communicator());
    Values result(nodes.size());
    for (std::size_t i = 0; i < order.size(); ++i)
      for (unsigned int d = 0; d < 3; ++d)
        result[order[i]][d] = all[3 * i + d];
    return result;
  }
} // namespace akmon
