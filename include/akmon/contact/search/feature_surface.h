#pragma once

#include <akmon/contact/contact_nodes.h>
#include <akmon/contact/search/projection.h>

#include <array>
#include <vector>

namespace akmon
{
  /**
   * Faces of deformable surfaces near the sharp features of a rigid body, on the rank that looks
   * for their pairs, with the edges between them and who is beside whom.
   */
  class FeatureSurface
  {
  public:
    struct Face
    {
      dealii::types::global_cell_index id;
      double depth;                           ///< thickness of the cell behind it; length
      double stiffness;                       ///< K A^2/V of that cell; force/length
      double size;                            ///< least of its edges, initially; length
      std::array<ContactNodes::Id, 4> ids;    ///< of its corners, counter-clockwise from outside
      std::array<unsigned int, 4> nodes;      ///< their contact numbers
      std::array<unsigned int, 4> edges = {}; ///< from corner k to the next one

      template <class Archive>
      void
      serialize(Archive &archive, const unsigned int)
      {
        archive &id &depth &stiffness &size &ids;
      }
    };

    struct Edge
    {
      std::array<ContactNodes::Id, 2> ids; ///< the lower one first
      std::array<unsigned int, 2> nodes;
      std::array<unsigned int, 2> faces;
      unsigned int n_faces; ///< one at the rim
    };

    /// Take up faces, sorted by their ids, whose nodes are known to @p nodes.
    void
    reinit(const ContactNodes &nodes, std::vector<Face> of_all_ranks);

    const std::vector<Face> &
    get_faces() const
    {
      return faces;
    }

    const std::vector<Edge> &
    get_edges() const
    {
      return edges;
    }

    Segment
    segment(const ContactNodes::Field &x, const unsigned int face) const
    {
      const auto &nodes = faces[face].nodes;
      return {{x[nodes[0]], x[nodes[1]], x[nodes[2]], x[nodes[3]]}};
    }

    /// Faces with a contact node.
    std::vector<unsigned int>
    faces_at(const unsigned int node) const
    {
      return {face_list.begin() + begin_at[node], face_list.begin() + begin_at[node + 1]};
    }

    /**
     * Unit normal of the closest feature: of the face itself, or the mean of the faces that share
     * the edge or corner. @param on_rim  whether that is on the rim of the surface
     */
    dealii::Tensor<1, 3>
    feature_normal(const ContactNodes::Field &x,
                   const unsigned int face,
                   const Projection &projection,
                   bool &on_rim) const;

    /// Faces that share the edge or corner of a face that a point is closest to, itself included.
    std::vector<unsigned int>
    faces_around(const unsigned int face, const Projection &projection) const;

  private:
    void
    find_edges();

    std::vector<Face> faces;
    std::vector<Edge> edges;            ///< sorted by ids
    std::vector<unsigned int> begin_at; ///< by contact number: first entry in face_list
    std::vector<unsigned int> face_list;
  };
} // namespace akmon
