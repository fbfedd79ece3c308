#pragma once

#include <deal.II/base/tensor.h>

#include <array>

namespace akmon
{
  /**
   * A slave node and its partner, all at configuration n: the row of the gap operator
   * G u = u_s - sum_k N_k u_k (56), the unit normal and the gap, and the contact forces found for
   * it. Without masters the partner is a fixed obstacle.
   */
  struct ContactPair
  {
    unsigned int interface; ///< number of the contact or obstacle
    unsigned int slave;     ///< owned node
    unsigned int n_masters = 0;
    std::array<unsigned int, 4> masters; ///< contact nodes, see ContactNodes
    std::array<double, 4> N;

    dealii::Tensor<1, 3> normal; ///< of the partner, outward
    double gap;                  ///< n . g_0, negative when penetrating; length
    double size;                 ///< of the cell faces at the slave; length

    double normal_force = 0.;              ///< t_n, on the slave along the normal; force
    dealii::Tensor<1, 3> tangential_force; ///< t_tau, on the slave; force
    bool sticks = false;
  };
} // namespace akmon
