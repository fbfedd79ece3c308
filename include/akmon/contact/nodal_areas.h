#pragma once

#include <akmon/contact/buckets.h>
#include <akmon/model/discretization.h>

#include <vector>

namespace akmon
{
  /// Shares of nodes in the areas of the contact faces around them, a quarter of each, in the
  /// current configuration.
  class NodalAreas
  {
  public:
    /**
     * @param n_owned_nodes  whose areas are asked for
     * @param faces          of contact surfaces, each once, all those around owned nodes among them
     */
    NodalAreas(const unsigned int n_owned_nodes, std::vector<BoundaryFace> faces);

    /**
     * The share of an owned node in the faces that look against a unit vector, projected on the
     * plane across it: a node on an edge has no part of the side that its partner does not touch;
     * length^2.
     */
    double
    facing(const NodalVector &x, const unsigned int node, const dealii::Tensor<1, 3> &normal) const;

    /// A normal force on a node over its share of the area that faces it; force/length^2.
    double
    pressure(const NodalVector &x, const unsigned int node, const dealii::Tensor<1, 3> &force) const
    {
      const double size = force.norm(), area = size > 0. ? facing(x, node, force / size) : 0.;
      return area > 0. ? size / area : 0.;
    }

  private:
    std::vector<BoundaryFace> faces;
    Buckets corners_at; ///< of the faces, 4 f + k, by owned node; and those of all others
  };
} // namespace akmon
