#pragma once

#include <akmon/contact/contact_nodes.h>

#include <deal.II/base/tensor.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace akmon
{
  /**
   * A slave node and its partner, all at configuration n: the row of the gap operator
   * G u = u_s - sum_k N_k u_k (56), the unit normal and the gap, and the contact forces found for
   * it. Against an obstacle the slave is the only node.
   *
   * Or two edges that cross: G u = (1-s) u_a + s u_b - (1-t) u_c - t u_d with the nodes a, b of the
   * slave's edge and c, d of the master's, and the closest points at the parts s and t of them. The
   * normal is that of both edges; a stands for the slave where one node is asked for.
   *
   * Or a point of an edge and one of the inside of a face, G u = (1-s) u_a + s u_b - sum_k N_k u_k
   * with the normal of the face, where a face that is twisted dips over the edge. If the face is
   * the slave's both change sides, sign and normal; a node of the face then stands for the slave.
   *
   * While a gap o = x_s - sum_k N_k x_k is open, opposite forces at both its ends are a couple
   * o x t, and a rigid rotation changes G u. Where that matters the operator is
   *
   *     G u = u_s - sum_k N_k u_k - theta x o,     theta = I^{-1} sum_k r_k x u_k
   *
   * with the mean rotation theta of the segment's corners (of the ends of both edges), r_k their
   * places from their centre and I = sum_k (r_k.r_k 1 - r_k r_k): G vanishes for rigid motions, and
   * forces G^T t have neither a resultant nor a moment, so that angular momentum is conserved
   * exactly.
   *
   * Or a point of a sharp corner or edge of a rigid body and one of a surface (FeatureSearch), the
   * body being the slave, known by the number of the corner or edge among the body's. Or points of
   * two rigid bodies (RigidTouch), known by the number of the touch, in the slot by that of the
   * slave's feature and in the others by that of the point among those of the feature.
   *
   * A rigid body that moves has two contact nodes, one with its centre's motion u_c and one with
   * its rotation theta: it moves by u_c + theta x r at the slave's place r from the centre. The
   * force on the second is the moment r x t. Rotations stand last in the list of nodes.
   */
  struct ContactPair
  {
    /// What meets what, in the order of keys.
    enum class Kind : unsigned char
    {
      node_to_face,  ///< a slave node and a face (SurfaceSearch)
      node_to_shape, ///< a slave node and a rigid body (ObstacleSearch)
      rigid_touch,   ///< two rigid bodies (RigidTouch)
      rigid_feature, ///< a sharp corner or edge of a rigid body and a surface (FeatureSearch)
      edges,         ///< two sharp edges that cross (EdgeSearch)
      dip            ///< an edge and the inside of a face, or a smooth edge, that has joined where
                     ///< it dips between other pairs (EdgeSearch)
    };

    unsigned int interface; ///< number of the contact or obstacle
    Kind kind     = Kind::node_to_face;
    bool reversed = false;     ///< slave and master of the interface change roles
    unsigned int slave;        ///< local number of the (owned) slave node, if it has_slave_node()
    ContactNodes::Id slave_id; ///< of the kind: other kinds may have the same
    std::array<ContactNodes::Id, 3> others{}; ///< of edges: ids of further nodes, for two b, c, d
    unsigned int slot   = 0;     ///< among the pairs of a slave; of a node 0: the closest face
    bool shares_corner  = false; ///< the slave has pairs with several faces, each for itself
    unsigned int search = 0;     ///< that found it: its number, of the slave and of the face there
    unsigned int row    = 0;
    unsigned int face   = 0;
    std::array<double, 2> foot{}; ///< (xi, eta) of the closest point in that face
    unsigned int n_nodes = 1;
    std::array<unsigned int, 7> nodes; ///< contact numbers: slave, then masters, then rotations
    std::array<double, 7> weights;     ///< 1, then -N_k; for rotations as for their body's centre
    unsigned int n_rotations = 0;
    std::array<dealii::Tensor<1, 3>, 2> radii; ///< of the rotations: r; length

    dealii::Tensor<1, 3> normal; ///< of the partner, outward
    double gap;                  ///< n . g_0, negative when penetrating; length
    double depth = 0.;           ///< inside the partner, as the search found it; length
    double size;                 ///< of the cell faces at the slave; length
    double stiffness = 0.;       ///< what penalty springs are a part of; force/length
    dealii::Tensor<1, 3> place;  ///< of the slave; length

    bool levered = false;
    dealii::Tensor<2, 3> lever;               ///< [o x] I^{-1}; 1/length
    std::array<dealii::Tensor<1, 3>, 6> arms; ///< r_k of the points, zero for a slave; length

    dealii::Tensor<1, 3> plane_normal; ///< of the partner if rigid, in its frame
    double plane_offset = 0.;          ///< the plane is plane_normal . X = plane_offset; length

    double reached_gap = 0.;             ///< of rigid bodies, where the step leads; length
    double curvature   = 0.;             ///< second-order part of the gap the step reaches; length
    double change = 0., correction = 0.; ///< what it lacked last in this step, and got; length
    double returns      = 0.;            ///< part of a correction that the next round lacked again
    bool settled        = false;         ///< it lacked nothing that counts
    bool wanders        = false;         ///< the step leads to another face
    bool lost           = false;         ///< the step leads to where there is no partner
    bool entered        = false;         ///< joined in this step: before, the slave was beside it
    double target_gap   = 0.;            ///< gap of which no more may be lost in this step; length
    double normal_force = 0.;            ///< t_n, on the slave along the normal; force
    dealii::Tensor<1, 3> tangential_force; ///< t_tau, on the slave; force
    bool sticks = false;

    dealii::Tensor<1, 3>
    force() const
    {
      return normal_force * normal + tangential_force;
    }

    /// Interface, group, slave, slot, others.
    using Key = std::tuple<unsigned int,
                           unsigned int,
                           ContactNodes::Id,
                           unsigned int,
                           std::array<ContactNodes::Id, 3>>;

    /// What a pair is known by from step to step. Lists of pairs are sorted by it.
    Key
    key() const
    {
      return {interface, group(), slave_id, slot, others};
    }

    /// Where it stands among the pairs of its interface: slaves of both sides, then edges.
    unsigned int
    group() const
    {
      constexpr unsigned int n_of_side = static_cast<unsigned int>(Kind::edges);
      return of_edges() ? 2 * n_of_side :
                          (reversed ? n_of_side : 0) + static_cast<unsigned int>(kind);
    }

    /// Whether it is of a slave node alone.
    bool
    of_node() const
    {
      return kind <= Kind::node_to_shape;
    }

    /// Whether it is of edges of two surfaces, or of one and a face.
    bool
    of_edges() const
    {
      return kind >= Kind::edges;
    }

    /// Whether a node stands for the slave; else a rigid body is it.
    bool
    has_slave_node() const
    {
      return of_node() || of_edges();
    }

    /// Whether the step leads a slave past the edges of its face, where the gap may tell nothing.
    bool
    may_enter() const
    {
      return kind == Kind::node_to_face && (lost || (shares_corner && wanders));
    }

    void
    add_node(const unsigned int node, const double weight)
    {
      nodes[n_nodes]     = node;
      weights[n_nodes++] = weight;
    }

    /// @param radius  r; length
    void
    add_rotation(const unsigned int node, const double weight, const dealii::Tensor<1, 3> &radius)
    {
      radii[n_rotations++] = radius;
      add_node(node, weight);
    }

    /// Number of nodes that are no rotations.
    unsigned int
    n_points() const
    {
      return n_nodes - n_rotations;
    }

    /// G u
    dealii::Tensor<1, 3>
    relative(const ContactNodes::Field &u) const
    {
      dealii::Tensor<1, 3> result;
      for (unsigned int k = 0; k < n_points(); ++k)
        result += weights[k] * u[nodes[k]];
      for (unsigned int k = n_points(); k < n_nodes; ++k)
        result += weights[k] * cross_product_3d(u[nodes[k]], radii[k - n_points()]);
      if (levered)
        {
          dealii::Tensor<1, 3> turn;
          for (unsigned int k = 0; k < n_points(); ++k)
            turn += cross_product_3d(arms[k], u[nodes[k]]);
          result += lever * turn;
        }
      return result;
    }

    /// The part of G^T t at the pair's node number k.
    dealii::Tensor<1, 3>
    at_node(const unsigned int k, const dealii::Tensor<1, 3> &t) const
    {
      return at_node(k, t, turn(t));
    }

    /// The same with turn(t), which is the same for all nodes.
    dealii::Tensor<1, 3>
    at_node(const unsigned int k,
            const dealii::Tensor<1, 3> &t,
            const dealii::Tensor<1, 3> &turn) const
    {
      if (k >= n_points())
        return weights[k] * cross_product_3d(radii[k - n_points()], t);
      if (levered)
        return weights[k] * t + cross_product_3d(turn, arms[k]);
      return weights[k] * t;
    }

    /// What the couple of t and -t at the ends of the gap turns the partner by.
    dealii::Tensor<1, 3>
    turn(const dealii::Tensor<1, 3> &t) const
    {
      return levered ? t * lever : dealii::Tensor<1, 3>();
    }

    /// A bound of the norm of the part of G^T t at the pair's node number k for unit forces t.
    double
    bound_at_node(const unsigned int k) const
    {
      if (k >= n_points())
        return std::abs(weights[k]) * radii[k - n_points()].norm();
      return std::abs(weights[k]) + (levered ? lever.norm() * arms[k].norm() : 0.);
    }

    /// f += G^T t
    void
    distribute(const dealii::Tensor<1, 3> &t, ContactNodes::Field &f) const
    {
      const auto turn_of_t = turn(t);
      for (unsigned int k = 0; k < n_nodes; ++k)
        f.add(nodes[k], at_node(k, t, turn_of_t));
    }

    /// The part of a vector in the contact plane, P_tau v.
    dealii::Tensor<1, 3>
    tangential_part(const dealii::Tensor<1, 3> &v) const
    {
      return v - (normal * v) * normal;
    }
  };


  /// The order of lists of pairs.
  inline constexpr auto by_key = [](const ContactPair &a, const ContactPair &b) {
    return a.key() < b.key();
  };


  /// The pair with a key in a list sorted by them; its end if there is none.
  template <typename Pairs>
  auto
  find_pair(Pairs &pairs, const ContactPair::Key &key)
  {
    const auto found = std::lower_bound(pairs.begin(),
                                        pairs.end(),
                                        key,
                                        [](const ContactPair &pair, const ContactPair::Key &key) {
                                          return pair.key() < key;
                                        });
    return found != pairs.end() && found->key() == key ? found : pairs.end();
  }


  /**
   * Make a pair's operator vanish for rigid motions (see ContactPair).
   * @param corners  whose mean rotation counts, the pair's points from number @p first on; length
   * @param offset   o; length
   */
  void
  set_lever(const std::array<dealii::Tensor<1, 3>, 4> &corners,
            const unsigned int first,
            const dealii::Tensor<1, 3> &offset,
            ContactPair &pair);
} // namespace akmon
