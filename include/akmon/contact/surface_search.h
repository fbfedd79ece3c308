#pragma once

#include <akmon/contact/contact_nodes.h>
#include <akmon/contact/contact_parameters.h>
#include <akmon/contact/pair.h>
#include <akmon/contact/projection.h>

#include <vector>

namespace akmon
{
  /**
   * Finds the partner of every slave node of one contact. In two stages: candidates (bounding
   * boxes, across ranks, valid while nothing has moved further than half the search radius) and
   * pairs (closest feature among the candidates, every step).
   *
   * A node's pair belongs to the node's owner, who gets the master faces it may meet, and their
   * neighbours, from the other ranks.
   */
  class SurfaceSearch
  {
  public:
    /**
     * Throws InputError for unknown surfaces.
     * @param reversed  the contact's masters are the slaves of this search and the other way round
     * @param follow_curvature  pairs tell what their linear gap misses while segments turn
     */
    SurfaceSearch(const Discretization &discretization,
                  const SurfaceContact &contact,
                  const unsigned int interface,
                  const bool reversed,
                  const bool follow_curvature);

    /// Distance over which partners are looked for; length. The same on all ranks.
    double
    radius() const
    {
      return search_radius;
    }

    /// Get the master faces near this rank's slaves from their owners (collective). Returns their
    /// nodes.
    std::vector<ContactNodes::Id>
    fetch_master_faces(const ContactNodes &nodes, const NodalVector &x);

    /// For every slave the faces within the radius, from boxes around the faces at positions @p x.
    void
    build_candidates(const ContactNodes &nodes,
                     const NodalVector &positions,
                     const ContactNodes::Field &x);

    /**
     * Append the pairs of this rank's slaves in configuration @p x, in the order of global node
     * numbers.
     * @param positions  the same configuration as a nodal vector
     * @param x_ahead    x + dx, with the increment dx that led here
     */
    void
    find_pairs(const NodalVector &positions,
               const ContactNodes::Field &x,
               const ContactNodes::Field &x_ahead,
               const ContactNodes::Field &dx,
               std::vector<ContactPair> &pairs) const;

    /// Owned and ghost faces of both surfaces.
    const std::vector<BoundaryFace> &
    surface_faces() const
    {
      return faces;
    }

  private:
    struct Slave
    {
      unsigned int node;   ///< local number
      unsigned int number; ///< contact number
      ContactNodes::Id id;
      double size;                  ///< least edge of its faces, initially; length
      unsigned int first_face;      ///< in slave_face_list
      unsigned int first_candidate; ///< in candidates
    };

    struct FaceMessage
    {
      dealii::types::global_cell_index id;
      unsigned int body;
      double depth; ///< thickness of the cell behind the face; length
      std::array<ContactNodes::Id, 4> nodes;

      template <class Archive>
      void
      serialize(Archive &archive, const unsigned int)
      {
        archive &id &body &depth &nodes;
      }
    };

    struct MasterFace
    {
      unsigned int body;
      double depth;
      std::array<unsigned int, 4> nodes; ///< contact numbers
    };

    struct Partner
    {
      unsigned int face; ///< in masters
      Projection projection;
      dealii::Tensor<1, 3> normal; ///< outward, of the closest feature
      double gap;                  ///< along the normal; length
    };

    void
    collect_slaves();
    std::vector<std::array<double, 6>>
    slave_boxes_of_all_ranks(const NodalVector &x) const;
    Segment
    segment(const ContactNodes::Field &x, const MasterFace &face) const;
    dealii::Tensor<1, 3>
    slave_normal(const NodalVector &positions, const unsigned int slave) const;
    bool
    closest_segment(const ContactNodes::Field &x,
                    const unsigned int slave,
                    const dealii::Tensor<1, 3> &outward,
                    Partner &partner) const;
    bool
    may_face(const ContactNodes::Field &x,
             const MasterFace &face,
             const unsigned int slave_number,
             const dealii::Tensor<1, 3> &outward) const;
    bool
    locate(const ContactNodes::Field &x,
           const unsigned int slave,
           const dealii::Tensor<1, 3> &outward,
           Partner &partner) const;
    double
    curvature(const ContactNodes::Field &x_ahead,
              const ContactNodes::Field &dx,
              const unsigned int slave,
              const dealii::Tensor<1, 3> &outward,
              const ContactPair &pair) const;
    void
    snap_to_closest_node(const ContactNodes::Field &x,
                         const dealii::Tensor<1, 3> &slave,
                         Partner &partner) const;
    dealii::Tensor<1, 3>
    feature_normal(const ContactNodes::Field &x, const Partner &partner, bool &on_rim) const;
    unsigned int
    faces_sharing(const unsigned int node_a, const unsigned int node_b) const;

    const Discretization &discretization;
    const SurfaceContact &contact;
    const unsigned int interface;
    const bool reversed;
    const bool follow_curvature;
    double search_radius;
    std::vector<BoundaryFace> slave_faces, master_faces, faces; ///< relevant faces

    std::vector<Slave> slaves; ///< and one past the end
    std::vector<unsigned int> slave_face_list, candidates;
    std::vector<FaceMessage> fetched;         ///< sorted by id
    std::vector<MasterFace> masters;          ///< in the same order
    std::vector<unsigned int> faces_at_begin; ///< by contact number: first entry in faces_at
    std::vector<unsigned int> faces_at;
  };
} // namespace akmon
