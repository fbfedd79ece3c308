#include <akmon/model/mesh_description.h>
#include <akmon/parameters.h>

#include <deal.II/base/numbers.h>
#include <deal.II/base/utilities.h>
#include <deal.II/grid/grid_tools.h>

#include <muParser.h>

namespace akmon
{
  namespace
  {
    const std::string key = "Named parts";

    /// For every face of the mesh: does the condition hold at its centre?
    std::vector<bool>
    faces_where(const BodyMesh &mesh, const std::string &condition)
    {
      dealii::Point<3> center;
      mu::Parser parser;
      parser.DefineVar("x", &center[0]);
      parser.DefineVar("y", &center[1]);
      parser.DefineVar("z", &center[2]);
      parser.DefineConst("pi", dealii::numbers::PI);
      parser.SetExpr(condition);

      std::vector<bool> matches;
      for (const auto &face : mesh.faces.boundary_quads)
        {
          center = dealii::Point<3>();
          for (const unsigned int v : face.vertices)
            center += 0.25 * mesh.vertices[v];
          matches.push_back(parser.Eval() != 0);
        }
      return matches;
    }


    /**
     * Give the matched faces ids that no other face has, and return these ids. An id with matched
     * and other faces is split: the new id joins all parts and the curved surface of the old one.
     */
    std::set<dealii::types::boundary_id>
    separate(BodyMesh &mesh, const std::vector<bool> &matches)
    {
      auto &faces = mesh.faces.boundary_quads;
      std::set<dealii::types::boundary_id> matched_ids, other_ids;
      for (unsigned int f = 0; f < faces.size(); ++f)
        (matches[f] ? matched_ids : other_ids).insert(faces[f].boundary_id);

      dealii::types::boundary_id next_id = 0;
      for (const auto &face : faces)
        next_id = std::max(next_id, face.boundary_id + 1);

      std::set<dealii::types::boundary_id> ids;
      for (const auto id : matched_ids)
        {
          if (other_ids.count(id) == 0)
            {
              ids.insert(id);
              continue;
            }
          for (unsigned int f = 0; f < faces.size(); ++f)
            if (matches[f] && faces[f].boundary_id == id)
              faces[f].boundary_id = next_id;
          for (auto &[name, part] : mesh.parts)
            if (part.count(id) == 1)
              part.insert(next_id);
          if (const auto surface = mesh.curved.find(id); surface != mesh.curved.end())
            mesh.curved.emplace(next_id, surface->second);
          ids.insert(next_id++);
        }
      return ids;
    }
  } // namespace


  bool
  on_plane(const MeshFace &face, const unsigned int direction, const double coordinate)
  {
    for (const unsigned int v : face->vertex_indices())
      if (face->vertex(v)[direction] != coordinate)
        return false;
    return true;
  }


  void
  set_boundary_ids(dealii::Triangulation<3> &triangulation,
                   const std::function<dealii::types::boundary_id(const MeshFace &)> &classify)
  {
    for (const auto &face : triangulation.active_face_iterators())
      if (face->at_boundary())
        face->set_boundary_id(classify(face));
  }


  BodyMesh
  describe_mesh(const dealii::Triangulation<3> &triangulation)
  {
    BodyMesh mesh;
    std::tie(mesh.vertices,
             mesh.cells,
             std::ignore) = dealii::GridTools::get_coarse_mesh_description(triangulation);
    for (auto &cell : mesh.cells)
      {
        cell.material_id = 0;
        cell.manifold_id = dealii::numbers::flat_manifold_id;
      }

    for (const auto &cell : triangulation.active_cell_iterators())
      for (const auto &face : cell->face_iterators())
        if (face->at_boundary())
          {
            dealii::CellData<2> data;
            for (const unsigned int v : face->vertex_indices())
              data.vertices[v] = face->vertex_index(v);
            data.boundary_id = face->boundary_id();
            mesh.faces.boundary_quads.push_back(data);
          }
    return mesh;
  }


  BodyMesh
  describe_mesh(const dealii::Triangulation<3> &triangulation,
                const std::vector<std::string> &names)
  {
    BodyMesh mesh = describe_mesh(triangulation);
    for (unsigned int id = 0; id < names.size(); ++id)
      mesh.parts[names[id]].insert(id);
    return mesh;
  }


  void
  add_named_parts(BodyMesh &mesh, const std::string &list, const std::string &section)
  {
    for (const auto &entry : split_list(list, ';'))
      {
        const auto colon       = entry.find(':');
        const std::string name = dealii::Utilities::trim(entry.substr(0, colon));
        if (colon == std::string::npos || name.empty() || name.find(',') != std::string::npos)
          throw InputError(section,
                           key,
                           entry,
                           "allowed is 'name: condition', no comma in the name");
        if (name == "all" || mesh.parts.count(name) == 1)
          throw InputError(section, key, entry, "the name '" + name + "' is taken already");

        std::vector<bool> matches;
        try
          {
            matches = faces_where(mesh, entry.substr(colon + 1));
          }
        catch (const mu::Parser::exception_type &error)
          {
            throw InputError(section, key, entry, "cannot read the condition: " + error.GetMsg());
          }
        const auto ids = separate(mesh, matches);
        if (ids.empty())
          throw InputError(section, key, entry, "no boundary face has its centre there");
        mesh.parts[name] = ids;
      }
  }
} // namespace akmon
