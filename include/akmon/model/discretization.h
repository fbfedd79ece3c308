#pragma once

#include <akmon/material/material.h>
#include <akmon/model/body.h>
#include <akmon/model/partition.h>

#include <deal.II/base/partitioner.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <array>
#include <map>
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


  /// A cell whose forces this rank computes: its own, and ghosts that touch an owned node.
  struct RelevantCell
  {
    std::array<unsigned int, 8> nodes; ///< local numbers, deal.II's vertex order
    unsigned int body;
    bool owned;
    dealii::types::global_cell_index id; ///< in space-filling-curve order, any rank count
    typename dealii::DoFHandler<3>::cell_iterator cell;
  };


  /// A boundary face of a relevant cell.
  struct BoundaryFace
  {
    std::array<unsigned int, 4> nodes; ///< local numbers, counter-clockwise seen from outside
    dealii::types::boundary_id boundary;
    dealii::types::global_cell_index id; ///< 6 * cell id + face number, the same for any rank count
    unsigned int body;
    bool owned;
    double depth; ///< initial thickness of the cell behind the face, volume over area; length
  };


  /**
   * All bodies as disconnected parts of one distributed triangulation with Q1 hexes, and what the
   * time loop needs of it: node numbering, lumped masses, relevant cells, boundary faces.
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
      return triangulation.get_communicator();
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

    /// Relevant faces (owned and ghost) on the given boundary ids, in global order.
    std::vector<BoundaryFace>
    faces_on(const std::set<dealii::types::boundary_id> &ids) const;

    /// Volume centroid of a body's coarse mesh in its initial place; length.
    const dealii::Point<3> &
    centre_of(const unsigned int body) const
    {
      return centres[body];
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

    unsigned int n_owned_nodes = 0;
    unsigned int n_nodes       = 0; ///< owned and ghost

    std::shared_ptr<const dealii::Utilities::MPI::Partitioner> partitioner;

    NodalVector reference;                  ///< initial positions X, ghosted; length
    std::vector<double> mass;               ///< lumped nodal mass m (owned and ghost nodes)
    std::vector<unsigned int> body_of_node; ///< owned and ghost nodes

    std::vector<RelevantCell> cells; ///< by body, then in global order

    dealii::parallel::distributed::Triangulation<3> triangulation;
    dealii::FESystem<3> fe;
    dealii::DoFHandler<3> dof_handler;

  private:
    void
    build_triangulation();
    void
    share_out(const ExtraWork &extra_work);
    dealii::types::global_cell_index
    first_owned_cell() const;
    void
    number_nodes();
    void
    collect_cells();
    void
    collect_faces();
    void
    lump_masses();

    std::vector<Body> bodies;
    std::vector<Material> materials;
    std::vector<unsigned int> body_material;
    std::vector<std::map<std::string, std::set<dealii::types::boundary_id>>> parts; ///< per body
    std::vector<dealii::Point<3>> centres;
    std::vector<BoundaryFace> faces;
    std::vector<double> mass_factors; ///< of relevant cells; empty: all one
  };
} // namespace akmon
