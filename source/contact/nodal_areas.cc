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
    , begin(n_owned_nodes + 1, 0)
  {
    for (const auto &face : faces)
      for (const unsigned int node : face.nodes)
        if (node < n_owned_nodes)
          ++begin[node + 1];
    for (unsigned int node = 0; node < n_owned_nodes; ++node)
      begin[node + 1] += begin[node];
    faces_at.resize(begin.back());
    std::vector<unsigned int> next(begin.begin(), begin.end() - 1);
    for (unsigned int f = 0; f < faces.size(); ++f)
      for (const unsigned int node : faces[f].nodes)
        if (node < n_owned_nodes)
          faces_at[next[node]++] = f;
  }


  double
  NodalAreas::facing(const NodalVector &x,
                     const unsigned int node,
                     const Tensor<1, 3> &normal) const
  {
    double area = 0.;
    for (unsigned int i = begin[node]; i < begin[node + 1]; ++i)
      {
        Segment corners;
        for (unsigned int k = 0; k < 4; ++k)
          corners[k] = at_node(x, faces[faces_at[i]].nodes[k]);
        area += 0.25 * std::max(0., -(area_vector(corners) * normal));
      }
    return area;
  }
} // namespace akmon
