#pragma once

#include <akmon/contact/contact_parameters.h>
#include <akmon/contact/search/projection.h>
#include <akmon/model/discretization.h>

#include <array>
#include <utility>
#include <vector>

namespace akmon
{
  /// A face of a tied surface with its nodes' global numbers and initial places.
  struct TiedFace
  {
    std::array<dealii::types::global_dof_index, 4> nodes; ///< counter-clockwise from outside
    Segment corners;                                      ///< length
  };


  /**
   * A point of a bond: what a slave node stands for of the bonded area, in every slave face the
   * quarter next to the node as far as it lies on the master. The bond holds the means of both
   * surfaces over this area together,
   *
   *     C u = (1/A) int_A (sum_j N_j u_j  -  sum_k N_k u_k) dA = 0 ,
   *
   * a mortar method with constant multipliers per point. Masters get what the traction integrates
   * to, so that constant tractions are transferred exactly between any two meshes.
   */
  struct BondPoint
  {
    dealii::types::global_dof_index slave;                               ///< global node number
    double area = 0.;                                                    ///< A; length^2
    std::vector<std::pair<dealii::types::global_dof_index, double>> row; ///< C, by node, sorted
    std::vector<unsigned int> faces; ///< of the slave node, in the list of slave faces
  };


  /// The owned faces of all ranks on some boundary parts, in global order (collective).
  std::vector<TiedFace>
  tied_faces(const Discretization &discretization,
             const std::string &section,
             const std::string &key,
             const std::vector<std::string> &surfaces);

  /**
   * The points of a bond in the order of their slaves' numbers.
   * @param distance  how far apart surfaces may be, over the size of the slave face
   */
  std::vector<BondPoint>
  bond_points(const std::vector<TiedFace> &slaves,
              const std::vector<TiedFace> &masters,
              const double distance);
} // namespace akmon
