#pragma once

#include <akmon/material/material.h>
#include <akmon/model/body.h>
#include <akmon/model/mesh_share.h>
#include <akmon/model/partition.h>

#include <deal.II/base/partitioner.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <array>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace akmon
{
  /// Three components per node: owned nodes first, then the ghost nodes of the cells computed here.
  using NodalVector = dealii::LinearAlgebra::distributed::Vector<double>;

  /// The three components of a nodal vector at a node (local number).
  inline dealii::Tensor<1, 3>
  at_node(const NodalVector &vector, const unsigned int node)
  {
    dealii::Tensor<1, 3> value;
    for (unsigned int d = 0; d < 3; ++d)
      value[d] = vector.local_element(3 * node + d);
    return value;
  }


  /**
   * All bodies as disconnected parts of one mesh of Q1 hexes that is distributed among the ranks:
   * what the time loop needs of deal.II's triangulation and degrees of freedom, which are gone then
   * (see make_global_mesh()). Node numbering, lumped masses, relevant cells, boundary faces.
   *
   * Nodes are numbered along the space-filling curve of the cells, so that global numbers do not
   * depend on the number of ranks. A rank computes every cell that touches one of its nodes, in
   * global cell order; a node's force is then complete without communication and has the same bits
   * on any number of ranks.
   */
  class Discretization
  {
  public:
    /// Throws InputError for unknown materials and meshes that cannot be used.
    /// @param extra_work  that ranks share besides their cells' own
    Discretization(const std::vector<Body> &bodies,
                   const std::vector<Material> &materials,
                   MPI_Comm,
                   const ExtraWork &extra_work = {});

    MPI_Comm
    communicator() const
    {
      return partitioner->get_mpi_communicator();
    }

    const std::vector<Body> &
    get_bodies() const
    {
      return bodies;
    }

    const Material &
    material_of(const unsigned int body) const
    {
      return materials[body_material[body]];
    }

    /// Boundary ids of a named part "BODY:PART" ("BODY": all of it; "all": all bodies); throws
    /// InputError naming section and key.
    std::set<dealii::types::boundary_id>
    boundary_ids(const std::string &section, const std::string &key, const std::string &part) const;

    /// The same of several parts.
    std::set<dealii::types::boundary_id>
    boundary_ids(const std::string &section,
                 const std::string &key,
                 const std::vector<std::string> &parts) const;

    /// Relevant faces (owned and ghost) on the given boundary ids, in global order.
    std::vector<BoundaryFace>
    faces_on(const std::set<dealii::types::boundary_id> &ids) const;

    /// All relevant faces of the boundary, in global order.
    const std::vector<BoundaryFace> &
    boundary_faces() const
    {
      return faces;
    }

    /// Initial places of a cell's corners, deal.II's vertex order; length.
    std::array<dealii::Point<3>, 8>
    corners_of(const RelevantCell &cell) const
    {
      std::array<dealii::Point<3>, 8> corners;
      for (unsigned int v = 0; v < 8; ++v)
        corners[v] = dealii::Point<3>(at_node(reference, cell.nodes[v]));
      return corners;
    }

    /// Volume centroid of a body's coarse mesh in its initial place; length.
    const dealii::Point<3> &
    centre_of(const unsigned int body) const
    {
      return outlines[body].centre;
    }

    /// Number of the body with this name; throws InputError naming section and key.
    unsigned int
    body_index(const std::string &section, const std::string &key, const std::string &name) const;

    /// A nodal vector, all zero.
    NodalVector
    make_vector() const
    {
      return NodalVector(partitioner);
    }

    dealii::types::global_dof_index
    global_node(const unsigned int node) const
    {
      return partitioner->local_to_global(3 * node) / 3;
    }

    /// Make cells heavier by given factors (number in cells) and lump the nodal masses anew
    /// (collective).
    void
    scale_masses(std::vector<double> factors);

    /// Mass of a cell over density times volume.
    double
    mass_factor_of(const std::size_t cell) const
    {
      return mass_factors.empty() ? 1. : mass_factors[cell];
    }

    dealii::types::global_cell_index n_global_cells = 0, n_owned_cells = 0;
    dealii::types::global_dof_index n_global_nodes = 0;
    unsigned int n_owned_nodes                     = 0;
    unsigned int n_nodes                           = 0; ///< owned and ghost

    std::shared_ptr<const dealii::Utilities::MPI::Partitioner> partitioner;

    NodalVector reference;                  ///< initial positions X, ghosted; length
    std::vector<double> mass;               ///< lumped nodal mass m (owned and ghost nodes)
    std::vector<unsigned int> body_of_node; ///< owned and ghost nodes

    std::vector<RelevantCell> cells; ///< by body, then in global order

  private:
    void
    take(MeshShare share, const MPI_Comm communicator);
    void
    lump_masses();

    std::vector<Body> bodies;
    std::vector<Material> materials;
    std::vector<unsigned int> body_material;
    std::vector<BodyOutline> outlines;
    std::vector<BoundaryFace> faces;
    std::vector<double> mass_factors; ///< of relevant cells; empty: all one
  };
} // namespace akmon
