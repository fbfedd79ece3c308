#pragma once

#include <akmon/contact/contact_nodes.h>
#include <akmon/contact/search/normal_cone.h>
#include <akmon/contact/search/projection.h>

#include <deal.II/base/tensor.h>
#include <deal.II/base/types.h>

#include <boost/container/small_vector.hpp>

#include <array>

namespace akmon
{
  /// What SurfaceSearch keeps of slaves, of the faces around them, and of what it has found.
  namespace surface_search
  {
    /// A node of the slave surface that this rank owns.
    struct Slave
    {
      unsigned int node;   ///< local number
      unsigned int number; ///< contact number
      ContactNodes::Id id;
      double size;                  ///< least edge of its faces, initially; length
      double stiffness;             ///< mean of its faces' K A^2/V; force/length
      unsigned int first_face;      ///< in slave_face_list
      unsigned int first_candidate; ///< in candidates
    };


    /// A body with slaves and one that has candidates of theirs, or twice the same.
    struct BodyPair
    {
      unsigned int of_slaves, of_faces;
      double increment = 0.; ///< the largest of a node in this step; length
      double approach  = 0.; ///< by how much they come closer in this step at most; length
      double travelled = 0.; ///< the same since the last build; length
    };


    /// A face that a slave may meet.
    struct Candidate
    {
      unsigned int face, pair; ///< in masters; of their bodies
      double clear_of;         ///< no closer, plus what that pair has travelled; length
    };


    /// A pair of bodies that a slave has candidates in.
    struct PairAround
    {
      unsigned int slave, pair;
    };


    /// A slave that may be within its reach of a face.
    struct Look
    {
      unsigned int slave;
      double reach; ///< length
    };


    /// A candidate that may be within the reach of a slave.
    struct Near
    {
      unsigned int node, candidate; ///< contact number; in candidates
    };


    /// A face beside a slave's partner that rises from it.
    struct ValleyFace
    {
      unsigned int shared, number; ///< the first node they share, in the partner; in masters
    };


    /// What earlier searches have found out about a slave, less what its surroundings may have come
    /// closer since.
    struct Memory
    {
      unsigned int face      = dealii::numbers::invalid_unsigned_int; ///< the last partner's
      bool was_outside       = false; ///< of that face, and further than the reach
      double clear_of        = 0.;    ///< no face is closer; length
      double others_clear_of = 0.;    ///< no other face is closer; length
      double refused = 0.; ///< distance of another body's closest face that is no partner; length
      unsigned long search = 0;     ///< number of the one that found the foot
      std::array<double, 2> foot{}; ///< (xi, eta) of the closest point in that face
    };


    /// Of a slave face, in the configuration that was looked at last when it was asked for.
    struct FaceArea
    {
      unsigned long look = 0; ///< number of that configuration
      dealii::Tensor<1, 3> vector;
    };


    /// The closest feature of a slave.
    struct Partner
    {
      unsigned int face; ///< in masters
      Projection projection;
      dealii::Tensor<1, 3> normal; ///< outward, of the closest feature
      double gap;                  ///< along the normal; length
    };


    /// An edge or vertex of the surface.
    struct Feature
    {
      boost::container::small_vector<unsigned int, 8> faces; ///< that share it
      NormalCone normals;                                    ///< of these
      dealii::Tensor<1, 3> mean;                             ///< of the normals
      bool on_rim = false;                                   ///< of the surface
    };
  } // namespace surface_search
} // namespace akmon
