#pragma once

#include <akmon/model/body_mesh.h>

#include <deal.II/grid/tria.h>

#include <functional>
#include <string>
#include <vector>

namespace akmon
{
  using MeshFace = dealii::Triangulation<3>::face_iterator;

  /// Whether all vertices of the face have exactly this coordinate.
  bool
  on_plane(const MeshFace &face, const unsigned int direction, const double coordinate);

  /// Give every boundary face the id that `classify` finds for it.
  void
  set_boundary_ids(dealii::Triangulation<3> &triangulation,
                   const std::function<dealii::types::boundary_id(const MeshFace &)> &classify);

  /// Vertices, cells and all boundary faces with their ids of an unrefined triangulation; no parts
  /// yet.
  BodyMesh
  describe_mesh(const dealii::Triangulation<3> &triangulation);

  /// As above, with names: the faces with boundary id i are the part names[i].
  BodyMesh
  describe_mesh(const dealii::Triangulation<3> &triangulation,
                const std::vector<std::string> &names);

  /**
   * Add the parts of a list "name: condition; name2: condition2": the faces at whose centre the
   * muParser condition in x, y, z holds. Matched faces get ids of their own where needed; existing
   * parts keep naming the faces they named. Throws InputError, naming `section` and the key "Named
   * parts", for an entry without name, with a name that is taken, with a condition that cannot be
   * read or that no face meets.
   */
  void
  add_named_parts(BodyMesh &mesh, const std::string &list, const std::string &section);
} // namespace akmon
