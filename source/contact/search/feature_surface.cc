#include <akmon/contact/search/feature_surface.h>

#include <algorithm>
#include <utility>

namespace akmon
{
  using namespace dealii;

  void
  FeatureSurface::reinit(const ContactNodes &nodes, std::vector<Face> of_all_ranks)
  {
    faces = std::move(of_all_ranks);
    begin_at.assign(nodes.size() + 1, 0);
    for (Face &face : faces)
      for (unsigned int k = 0; k < 4; ++k)
        {
          face.nodes[k] = nodes.number(face.ids[k]);
          ++begin_at[face.nodes[k] + 1];
        }
    for (unsigned int node = 0; node < nodes.size(); ++node)
      begin_at[node + 1] += begin_at[node];
    face_list.resize(begin_at.back());
    std::vector<unsigned int> next(begin_at.begin(), begin_at.end() - 1);
    for (unsigned int f = 0; f < faces.size(); ++f)
      for (const unsigned int node : faces[f].nodes)
        face_list[next[node]++] = f;
    find_edges();
  }


  void
  FeatureSurface::find_edges()
  {
    struct Side
    {
      std::array<ContactNodes::Id, 2> ids;
      unsigned int face, k;
    };
    std::vector<Side> sides;
    for (unsigned int f = 0; f < faces.size(); ++f)
      for (unsigned int k = 0; k < 4; ++k)
        {
          const auto a = faces[f].ids[k], b = faces[f].ids[(k + 1) % 4];
          sides.push_back({{{std::min(a, b), std::max(a, b)}}, f, k});
        }
    std::stable_sort(sides.begin(), sides.end(), [](const Side &a, const Side &b) {
      return a.ids < b.ids;
    });
    edges.clear();
    for (const Side &side : sides)
      {
        const Face &face = faces[side.face];
        if (edges.empty() || edges.back().ids != side.ids)
          {
            std::array<unsigned int, 2> nodes{{face.nodes[side.k], face.nodes[(side.k + 1) % 4]}};
            if (face.ids[side.k] != side.ids[0])
              std::swap(nodes[0], nodes[1]);
            edges.push_back({side.ids, nodes, {{side.face, side.face}}, 0});
          }
        Edge &edge                     = edges.back();
        edge.faces[edge.n_faces != 0]  = side.face;
        edge.n_faces                   = edge.n_faces == 0 ? 1 : 2;
        faces[side.face].edges[side.k] = edges.size() - 1;
      }
  }


  std::vector<unsigned int>
  FeatureSurface::faces_around(const unsigned int face, const Projection &projection) const
  {
    if (projection.feature == Projection::Feature::face)
      return {face};
    if (projection.feature == Projection::Feature::vertex)
      return faces_at(faces[face].nodes[projection.where]);
    const Edge &edge = edges[faces[face].edges[projection.where]];
    return {edge.faces.begin(), edge.faces.begin() + edge.n_faces};
  }


  Tensor<1, 3>
  FeatureSurface::feature_normal(const ContactNodes::Field &x,
                                 const unsigned int face,
                                 const Projection &projection,
                                 bool &on_rim) const
  {
    on_rim = false;
    if (projection.feature == Projection::Feature::face)
      return segment_normal(segment(x, face), projection.xi, projection.eta);
    Tensor<1, 3> sum;
    const unsigned int node = faces[face].nodes[projection.where];
    for (const unsigned int f : faces_around(face, projection))
      {
        const auto normal = area_vector(segment(x, f));
        sum += normal / normal.norm();
        for (const unsigned int e : faces[f].edges)
          if (projection.feature == Projection::Feature::vertex ?
                edges[e].nodes[0] == node || edges[e].nodes[1] == node :
                e == faces[face].edges[projection.where])
            on_rim = on_rim || edges[e].n_faces == 1;
      }
    return sum / sum.norm();
  }
} // namespace akmon
