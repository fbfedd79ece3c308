#pragma once

#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "support/rigid_depth.h"

// Cases of free rigid bodies among themselves and fixed ones.

namespace akmon::test
{
  /// A rigid body of a case.
  struct RigidPart
  {
    std::string name, shape;        ///< cylinder, torus, box or plane
    std::vector<double> dimensions; ///< of curves_of()
    std::string place;              ///< keys of its section
    std::string start;              ///< keys of the section Free; empty: it is fixed
  };


  inline std::string
  join_numbers(const std::vector<double> &numbers)
  {
    std::string text;
    for (const double number : numbers)
      text += (text.empty() ? "" : ", ") + shortest_text(number);
    return text;
  }


  inline std::string
  section_of(const RigidPart &part, const std::vector<RigidPart> &all, const double friction)
  {
    std::string others;
    for (const auto &other : all)
      if (other.name != part.name && !(other.start.empty() && part.start.empty()))
        others += (others.empty() ? "" : ", ") + other.name;
    const auto &a    = part.dimensions;
    std::string text = "subsection " + part.name + "\n set Shape = " + part.shape +
                       "\n set Obstacles = " + others +
                       "\n set Friction coefficient = " + shortest_text(friction) + "\n" +
                       part.place;
    if (part.shape == "cylinder")
      text += "subsection Cylinder\n set Radius = " + shortest_text(a[0]) +
              "\n set Length = " + shortest_text(a[1]) + "\nend\n";
    if (part.shape == "torus")
      text += "subsection Torus\n set Radius = " + shortest_text(a[0]) +
              "\n set Tube radius = " + shortest_text(a[1]) + "\nend\n";
    if (part.shape == "box")
      text += "subsection Box\n set Size = " + join_numbers(a) + "\nend\n";
    if (!part.start.empty())
      text += "set Motion = free\nsubsection Free\n set Density = 1000\n" + part.start + "end\n";
    return text + "end\n";
  }


  /// A file with rigid bodies that may all hit each other. Every case needs a deformable body: a
  /// light cell that flies by itself and touches nothing.
  class RigidCase
  {
  public:
    RigidCase(const std::vector<RigidPart> &parts,
              const double friction,
              const double end,
              const double gravity)
      : file(scratch.path + "/case.prm")
      , parts(parts)
    {
      std::string names, sections;
      for (const auto &part : parts)
        {
          names += (names.empty() ? "" : ", ") + part.name;
          sections += section_of(part, parts, friction);
        }
      std::ofstream(file) << "subsection Time\n set End = " << end << "\n set Step = 1e-3\nend\n"
                          << "subsection Materials\n set Names = soft\n subsection soft\n"
                          << "  set Density = 1e-3\n  set Young's modulus = 1\n"
                          << "  set Poisson's ratio = 0.3\n end\nend\n"
                          << "subsection Bodies\n set Names = cell\n subsection cell\n"
                          << "  set Material = soft\n  set Shape = box\n"
                          << "  set Position = 0, 0, 50\n end\nend\n"
                          << "subsection Body force\n set Acceleration = 0; 0; "
                          << shortest_text(-gravity) << "\nend\n"
                          << "subsection Obstacles\n set Names = " << names << "\n"
                          << sections << "end\nsubsection Output\n set Fields interval = 0\n"
                          << " set History steps = 1\nend\n";
    }

    /// See deepest_penetration().
    double
    deepest(const Table &history) const
    {
      const auto obstacles = Case::read(file, {}).obstacles;
      std::vector<RigidSample> samples;
      for (std::size_t i = 0; i < parts.size(); ++i)
        samples.push_back({obstacles[i], curves_of(parts[i].shape, parts[i].dimensions)});
      return deepest_penetration(history, samples);
    }

    const ScratchDirectory scratch;
    const std::string file;

  private:
    const std::vector<RigidPart> parts;
  };
} // namespace akmon::test
