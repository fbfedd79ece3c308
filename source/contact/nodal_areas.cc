#include <akmon/contact/nodal_areas.h>
#include <akmon/contact/search/projection.h>
#include <akmon/model/nodal_state.h>

#include <algorithm>
#include <utility>

namespace akmon
{
  using namespace dealii;

  NodalAreas::NodalAreas(const unsigned int n_owned_nodes, std::vector<BoundaryFace> all_faces)
    : faces(std::move(all_faces))
  {
    corners_at.fill(n_owned_nodes + 1, 4 * faces.size(), [&](const unsigned int corner) {
      return std::min(faces[corner / 4].nodes[corner % 4], n_owned_nodes);
    });
  }


  double
  NodalAreas::facing(const NodalVector &x,
                     const unsigned int node,
                     const Tensor<1, 3> &normal) const
  {
    double area = 0.;
    for (const unsigned int corner : corners_at[node])
      {
        Segment corners;
        for (unsigned int k = 0; k < 4; ++k)
          corners[k] = at_node(x, faces[corner / 4].nodes[k]);
        area += 0.25 * std::max(0., -(area_vector(corners) * normal));
      }
    return area;
  }
} // namespace akmon
