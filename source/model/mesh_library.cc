#include <akmon/model/mesh_description.h>
#include <akmon/model/mesh_library.h>

#include <deal.II/base/patterns.h>

namespace akmon
{
  namespace
  {
    template <typename Shape>
    void
    declare_shape(dealii::ParameterHandler &prm, const std::string &subsection)
    {
      prm.enter_subsection(subsection);
      Shape::declare(prm);
      prm.leave_subsection();
    }


    template <typename Shape>
    Shape
    parse_shape(dealii::ParameterHandler &prm,
                const std::string &subsection,
                const std::string &section)
    {
      Shape shape;
      prm.enter_subsection(subsection);
      shape.parse(prm, section + "/" + subsection);
      prm.leave_subsection();
      return shape;
    }


    const std::string box             = "Box";
    const std::string cylinder        = "Cylinder";
    const std::string hollow_cylinder = "Hollow cylinder";
    const std::string sphere          = "Sphere";
    const std::string file            = "File";
  } // namespace


  void
  MeshParameters::declare(dealii::ParameterHandler &prm)
  {
    prm.declare_entry("Shape",
                      "box",
                      dealii::Patterns::Selection("box|cylinder|hollow cylinder|sphere|file"),
                      "The shape of the body; the subsection of that name describes it.");
    prm.declare_entry(
      "Named parts",
      "",
      dealii::Patterns::Anything(),
      "Further parts of the boundary as 'name: condition; name2: condition2', each the "
      "faces at whose centre (x, y, z) in the body's own frame [length] the condition "
      "holds, for example 'tip: z < 0.1; half: (x > 0) && (z > 1)'.");
    declare_shape<BoxShape>(prm, box);
    declare_shape<CylinderShape>(prm, cylinder);
    declare_shape<HollowCylinderShape>(prm, hollow_cylinder);
    declare_shape<SphereShape>(prm, sphere);
    declare_shape<FileShape>(prm, file);
  }


  void
  MeshParameters::parse(dealii::ParameterHandler &prm, const std::string &section)
  {
    named_parts              = prm.get("Named parts");
    const std::string chosen = prm.get("Shape");
    if (chosen == "box")
      shape = parse_shape<BoxShape>(prm, box, section);
    else if (chosen == "cylinder")
      shape = parse_shape<CylinderShape>(prm, cylinder, section);
    else if (chosen == "hollow cylinder")
      shape = parse_shape<HollowCylinderShape>(prm, hollow_cylinder, section);
    else if (chosen == "sphere")
      shape = parse_shape<SphereShape>(prm, sphere, section);
    else
      shape = parse_shape<FileShape>(prm, file, section);
  }


  BodyMesh
  make_body_mesh(const MeshParameters &parameters, const std::string &section)
  {
    BodyMesh mesh = std::visit([&](const auto &shape) { return shape.make(section); },
                               parameters.shape);
    add_named_parts(mesh, parameters.named_parts, section);
    for (const auto &face : mesh.faces.boundary_quads)
      mesh.parts["all"].insert(face.boundary_id);
    return mesh;
  }
} // namespace akmon
