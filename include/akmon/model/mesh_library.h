#pragma once

#include <akmon/model/body_mesh.h>
#include <akmon/model/mesh_file.h>
#include <akmon/model/mesh_shapes.h>

#include <deal.II/base/parameter_handler.h>

#include <string>
#include <variant>

namespace akmon
{
  /// What the mesh of one body is made from: the keys of a body's subsection that describe its
  /// shape.
  struct MeshParameters
  {
    using Shape = std::
      variant<BoxShape, CylinderShape, HollowCylinderShape, SphereShape, FileShape>;

    Shape shape;
    std::string
      named_parts; ///< "name: condition; ..." with conditions in x, y, z of a face's centre

    /// Declare all keys in the subsection the handler stands in, a body's subsection.
    static void
    declare(dealii::ParameterHandler &prm);

    /**
     * Read the keys of the chosen shape from the subsection the handler stands in. `section` is its
     * path
     * ("Bodies/left"). Throws InputError for values that do not make a shape.
     */
    void
    parse(dealii::ParameterHandler &prm, const std::string &section);
  };

  /**
   * The mesh of one body in the body's own frame (see the shapes for where that is), with its
   * parts, among them "all". Throws InputError for an unusable mesh file or part condition;
   * `section` is the path of the body's subsection.
   */
  BodyMesh
  make_body_mesh(const MeshParameters &parameters, const std::string &section);
} // namespace akmon
