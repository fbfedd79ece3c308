#include <akmon/model/mesh_size.h>
#include <akmon/parameters.h>

#include <cmath>
#include <cstdio>
#include <unistd.h>

namespace akmon
{
  void
  refuse_too_large_meshes(const std::vector<Body> &bodies)
  {
    // All ranks may be on this machine.
    constexpr double bytes_per_cell = 1000.;
    const double memory = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE));
    double needed = 0., most = 0.;
    const Body *largest = nullptr;
    for (const auto &body : bodies)
      {
        const double coarse = std::visit([](const auto &shape) { return shape.n_cells(); },
                                         body.mesh.shape);
        const double cells  = coarse * std::pow(8., body.refinement);
        needed += bytes_per_cell * cells;
        if (cells > most)
          {
            most    = cells;
            largest = &body;
          }
      }
    if (!(needed > memory))
      return;
    char text[160];
    std::snprintf(
      text,
      sizeof(text),
      "its mesh has %.3g cells; all meshes need about %.3g GB, this machine has %.3g GB",
      most,
      needed / 1e9,
      memory / 1e9);
    throw InputError("[Bodies/" + largest->section_name() + "]: " + text);
  }
} // namespace akmon
