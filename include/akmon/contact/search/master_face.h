#pragma once

#include <akmon/contact/contact_nodes.h>

#include <deal.II/base/types.h>

#include <array>

namespace akmon
{
  /// Contact numbers of a face's corners, counter-clockwise seen from outside.
  using FaceNodes = std::array<unsigned int, 4>;


  /// A face that slaves of this rank may meet.
  struct MasterFace
  {
    FaceNodes nodes;
    double depth, stiffness; ///< as in its message
  };


  /// The same from the rank that owns it.
  struct FaceMessage
  {
    dealii::types::global_cell_index id;
    unsigned int body;
    double depth;     ///< thickness of the cell behind the face; length
    double stiffness; ///< K A^2/V of that cell; force/length
    std::array<ContactNodes::Id, 4> nodes;

    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int)
    {
      archive &id &body &depth &stiffness &nodes;
    }
  };
} // namespace akmon
