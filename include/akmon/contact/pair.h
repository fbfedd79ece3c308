#pragma once

#include <akmon/contact/contact_nodes.h>

#include <deal.II/base/tensor.h>

#include <array>

namespace akmon
{
  /**
   * A slave node and its partner, all at configuration n: the row of the gap operator
   * G u = u_s - sum_k N_k u_k (56), the unit normal and the gap, and the contact forces found for
   * it. Against an obstacle the slave is the only node.
   */
  struct ContactPair
  {
    unsigned int interface; ///< number of the contact or obstacle
    bool reversed = false;  ///< slave and master of the interface change roles
    unsigned int slave;     ///< local number of the (owned) slave node
    ContactNodes::Id slave_id;
    unsigned int n_nodes = 1;
    std::array<unsigned int, 5> nodes; ///< contact numbers: slave, then masters
    std::array<double, 5> weights;     ///< 1, then -N_k

    dealii::Tensor<1, 3> normal; ///< of the partner, outward
    double gap;                  ///< n . g_0, negative when penetrating; length
    double size;                 ///< of the cell faces at the slave; length

    double curvature    = 0.; ///< second-order part of the gap the step reaches; length
    double target_gap   = 0.; ///< gap of which no more may be lost in this step; length
    double normal_force = 0.; ///< t_n, on the slave along the normal; force
    dealii::Tensor<1, 3> tangential_force; ///< t_tau, on the slave; force
    bool sticks = false;

    /// G u
    dealii::Tensor<1, 3>
    relative(const ContactNodes::Field &u) const
    {
      dealii::Tensor<1, 3> result;
      for (unsigned int k = 0; k < n_nodes; ++k)
        result += weights[k] * u[nodes[k]];
      return result;
    }

    /// f += G^T t
    void
    distribute(const dealii::Tensor<1, 3> &t, ContactNodes::Field &f) const
    {
      for (unsigned int k = 0; k < n_nodes; ++k)
        f.add(nodes[k], weights[k] * t);
    }

    /// The part of a vector in the contact plane, P_tau v.
    dealii::Tensor<1, 3>
    tangential_part(const dealii::Tensor<1, 3> &v) const
    {
      return v - (normal * v) * normal;
    }
  };
} // namespace akmon
