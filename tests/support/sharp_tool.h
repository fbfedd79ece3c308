#pragma once

#include <akmon/contact/search/face_geometry.h>

#include <cmath>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "support/kept_run.h"
#include "support/triangles.h"

// A slab 1 x 1 x 1/2 with its top at z = 0 and faces 1/4 wide, and rigid tools for it.

namespace akmon::test
{
  inline constexpr double h = 0.25, start_gap = 0.001;

  inline const std::string slab = R"(
subsection Time
  set End  = 0.05
  set Step = 2e-4
end
subsection Materials
  set Names = soft
  subsection soft
    set Density         = 1000
    set Young's modulus = 1e6
    set Poisson's ratio = 0.3
  end
end
subsection Bodies
  set Names = slab
  subsection slab
    set Material = soft
    set Shape    = box
    set Position = 0, 0, -0.25
    subsection Box
      set Size  = 1, 1, 0.5
      set Cells = 4, 4, 2
    end
  end
end
subsection Obstacles
  set Names = tool
  subsection tool
    set Surfaces = slab:all
  end
end
subsection Prescribed motion
  set Names = base
  subsection base
    set Type     = displacement
    set Surfaces = slab:z-
  end
end
)";

  using List = std::vector<std::string>;


  // A case without the section that holds the slab.
  inline std::string
  without_base(const std::string &text)
  {
    const auto begin = text.find("subsection Prescribed motion"),
               end   = text.find("\nend\n", begin) + 5;
    return text.substr(0, begin) + text.substr(end);
  }


  // The tip of a steep pyramid at the origin of its frame, looking down.
  inline TriangleMesh
  pyramid()
  {
    TriangleMesh mesh;
    mesh.vertices  = {Vector({0., 0., 0.}),
                      Vector({-0.1, -0.1, 0.3}),
                      Vector({0.1, -0.1, 0.3}),
                      Vector({0.1, 0.1, 0.3}),
                      Vector({-0.1, 0.1, 0.3})};
    mesh.triangles = {{{0, 2, 1}}, {{0, 3, 2}}, {{0, 4, 3}}, {{0, 1, 4}}, {{1, 2, 3}}, {{1, 3, 4}}};
    return mesh;
  }


  // A tool whose lowest corner or edge is to begin a little above the slab.
  struct Tool
  {
    std::string name;
    List shape; ///< keys of its section; none: the pyramid
    double x, y;
  };


  class ToolCase
  {
  public:
    ToolCase(const Tool &tool, const List &more, const std::string &text = slab)
      : file(scratch.path + "/slab.prm")
    {
      std::ofstream(file) << text;
      std::ofstream(scratch.path + "/tip.stl") << ascii_stl(pyramid());
      if (tool.shape.empty())
        overrides = {"Obstacles/tool/Shape=file",
                     "Obstacles/tool/File/Name=" + scratch.path + "/tip.stl"};
      for (const auto &key : tool.shape)
        overrides.push_back("Obstacles/tool/" + key);
      overrides.insert(overrides.end(), more.begin(), more.end());
      double lowest = 1e300;
      for (const auto &corner : corners({}))
        lowest = std::min(lowest, corner[2]);
      overrides.push_back("Obstacles/tool/Point=" + shortest_text(tool.x) + ", " +
                          shortest_text(tool.y) + ", " + shortest_text(start_gap - lowest));
    }

    // Places of its corners, displaced.
    std::vector<Vector>
    corners(const Vector &displacement) const
    {
      const auto obstacle = Case::read(file, overrides).obstacles[0];
      std::vector<Vector> places;
      for (const auto &vertex : obstacle.shape->sharp_features(0.35).vertices)
        places.push_back(obstacle.start.place + displacement +
                         obstacle.start.orientation.matrix() * vertex.place);
      return places;
    }

    // Many points of its edges, displaced.
    std::vector<Vector>
    edge_points(const Vector &displacement) const
    {
      constexpr unsigned int n = 2000;
      const auto obstacle      = Case::read(file, overrides).obstacles[0];
      const auto R             = obstacle.start.orientation.matrix();
      std::vector<Vector> places;
      for (const auto &edge : obstacle.shape->sharp_features(0.35).edges)
        for (unsigned int i = 0; i <= n; ++i)
          places.push_back(obstacle.start.place + displacement +
                           R *
                             ((1. - i / double(n)) * edge.ends[0] + i / double(n) * edge.ends[1]));
      return places;
    }

    KeptRun
    run(const List &more) const
    {
      List all = overrides;
      all.insert(all.end(), more.begin(), more.end());
      return run_and_keep(file, all);
    }

    const ScratchDirectory scratch;
    const std::string file;
    List overrides;
  };


  // How deep a point is below the top of the slab, straight down; negative above it and beside it.
  inline double
  depth_below_top(const Simulation &simulation, const Vector &p)
  {
    const auto &model = simulation.model();
    double depth      = -1.;
    for (const auto &face : model.faces_on(model.boundary_ids("", "", "slab:z+")))
      {
        const Segment corners = segment_of(face, simulation.current_state().x);
        // Newton for (xi, eta) above which the point is.
        double xi = 0., eta = 0.;
        Vector r;
        for (unsigned int i = 0; i < 20; ++i)
          {
            const double N[4] = {0.25 * (1. - xi) * (1. - eta),
                                 0.25 * (1. + xi) * (1. - eta),
                                 0.25 * (1. + xi) * (1. + eta),
                                 0.25 * (1. - xi) * (1. + eta)};
            r                 = -p;
            for (unsigned int k = 0; k < 4; ++k)
              r += N[k] * corners[k];
            const auto a     = 0.25 * ((1. - eta) * (corners[1] - corners[0]) +
                                   (1. + eta) * (corners[2] - corners[3]));
            const auto b     = 0.25 * ((1. - xi) * (corners[3] - corners[0]) +
                                   (1. + xi) * (corners[2] - corners[1]));
            const double det = a[0] * b[1] - a[1] * b[0];
            xi -= (r[0] * b[1] - r[1] * b[0]) / det;
            eta -= (a[0] * r[1] - a[1] * r[0]) / det;
          }
        if (std::abs(xi) <= 1. + 1e-12 && std::abs(eta) <= 1. + 1e-12)
          depth = std::max(depth, r[2]);
      }
    return depth;
  }
} // namespace akmon::test
