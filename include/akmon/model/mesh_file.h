#pragma once

#include <akmon/model/body_mesh.h>

#include <deal.II/base/parameter_handler.h>

#include <string>

namespace akmon
{
  /**
   * A hexahedral mesh read from a file: Gmsh (.msh), Abaqus (.inp), legacy VTK (.vtk) or UCD (.ucd,
   * .inp). Every boundary id found names a part by its number; the frame is the file's.
   */
  struct FileShape
  {
    std::string name; ///< path of the file
    double scale;     ///< coordinates are the file's times this factor

    static void
    declare(dealii::ParameterHandler &prm);

    /// Throws InputError, naming `section`.
    void
    parse(dealii::ParameterHandler &prm, const std::string &section);

    /// Not known before the file is read, which has them all.
    double
    n_cells() const
    {
      return 0.;
    }

    /**
     * Read the mesh. Throws InputError, naming `section`, if the file is absent, unreadable, not of
     * its format, empty, holds other cells than hexahedra, or cells that are turned inside out.
     */
    BodyMesh
    make(const std::string &section) const;
  };
} // namespace akmon
