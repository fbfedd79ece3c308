#include <akmon/contact/penalty.h>
#include <akmon/contact/search/face_geometry.h>
#include <akmon/contact/search/feature_search.h>

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/mpi.h>
#include <deal.II/numerics/rtree.h>

#include <boost/iterator/function_output_iterator.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

// Which faces the sharp features of rigid bodies may meet.

namespace akmon
{
  using namespace dealii;

  namespace
  {
    BoundingBox<3>
    bounding_box(const Segment &corners, const double margin)
    {
      const std::vector<Point<3>> points{Point<3>(corners[0]),
                                         Point<3>(corners[1]),
                                         Point<3>(corners[2]),
                                         Point<3>(corners[3])};
      BoundingBox<3> box(points);
      box.extend(margin);
      return box;
    }
  } // namespace


  FeatureSearch::FeatureSearch(const Discretization &discretization,
                               const RigidBody &body,
                               const std::vector<BoundaryFace> &faces,
                               const unsigned int interface)
    : discretization(discretization)
    , body(body)
    , surface_faces(faces)
    , interface(interface)
    , features(body.parameters().shape->sharp_features(body.parameters().edge_angle))
  {
    if (features.vertices.empty() && features.edges.empty())
      return;
    // The largest face's, which does not depend on the order of a sum.
    double largest = 0.;
    for (const auto &face : faces)
      largest = std::max(largest, area_vector(segment_of(face, discretization.reference)).norm());
    least_radius = search_radius = 0.5 *
                                   std::sqrt(
                                     Utilities::MPI::max(largest, discretization.communicator()));
  }


  FeatureSearch::Line
  FeatureSearch::line_of(const Pose &pose, const unsigned int edge) const
  {
    const auto R     = pose.orientation.matrix();
    const auto &line = features.edges[edge];
    return {pose.place + R * line.ends[0],
            R * (line.ends[1] - line.ends[0]),
            {{R * line.normals[0], R * line.normals[1]}}};
  }


  // Lower and upper corner in space.
  std::array<Tensor<1, 3>, 2>
  FeatureSearch::box_of_features(const double margin) const
  {
    const Pose pose = body.pose();
    const auto R    = pose.orientation.matrix();
    std::array<Tensor<1, 3>, 2> box;
    for (unsigned int d = 0; d < 3; ++d)
      {
        box[0][d] = std::numeric_limits<double>::max();
        box[1][d] = std::numeric_limits<double>::lowest();
      }
    for (const auto &vertex : features.vertices)
      {
        const auto x = pose.place + R * vertex.place;
        for (unsigned int d = 0; d < 3; ++d)
          {
            box[0][d] = std::min(box[0][d], x[d] - margin);
            box[1][d] = std::max(box[1][d], x[d] + margin);
          }
      }
    return box;
  }


  std::vector<ContactNodes::Id>
  FeatureSearch::fetch_faces(const ContactNodes &nodes, const NodalVector &x)
  {
    if (!exists())
      return {};
    // Neighbours of the faces within the radius come along: their normals count.
    const auto box = box_of_features(
      search_radius + largest_diagonal(surface_faces, x, discretization.communicator()));
    std::vector<FeatureSurface::Face> near;
    for (const auto &face : surface_faces)
      {
        if (!face.owned)
          continue;
        const auto corners = segment_of(face, x);
        bool overlaps      = true;
        for (unsigned int d = 0; d < 3; ++d)
          {
            const auto [low, high] = std::minmax(
              {corners[0][d], corners[1][d], corners[2][d], corners[3][d]});
            overlaps = overlaps && low <= box[1][d] && high >= box[0][d];
          }
        if (!overlaps)
          continue;
        near.push_back({face.id,
                        face.depth,
                        penalty_stiffness(discretization, face),
                        least_edge(segment_of(face, discretization.reference)),
                        {},
                        {}});
        for (unsigned int k = 0; k < 4; ++k)
          near.back().ids[k] = nodes.id_of_local(face.nodes[k]);
      }
    fetched.clear();
    for (const auto &of_rank : Utilities::MPI::gather(discretization.communicator(), near))
      fetched.insert(fetched.end(), of_rank.begin(), of_rank.end());
    std::sort(fetched.begin(), fetched.end(), [](const auto &a, const auto &b) {
      return a.id < b.id;
    });
    std::vector<ContactNodes::Id> needed;
    for (const auto &face : fetched)
      needed.insert(needed.end(), face.ids.begin(), face.ids.end());
    return needed;
  }


  void
  FeatureSearch::build_candidates(const ContactNodes &nodes, const ContactNodes::Field &x)
  {
    faces_of_corners.clear();
    faces_of_edges.clear();
    edges_of_edges.clear();
    if (fetched.empty())
      return;
    surface.reinit(nodes, std::move(fetched));
    fetched.clear();
    std::vector<std::pair<BoundingBox<3>, unsigned int>> boxes;
    for (unsigned int f = 0; f < surface.get_faces().size(); ++f)
      boxes.emplace_back(bounding_box(surface.segment(x, f), search_radius), f);
    const auto tree  = pack_rtree(boxes);
    const auto visit = [&](const Tensor<1, 3> &a, const Tensor<1, 3> &u, const auto &take) {
      const BoundingBox<3> box(std::vector<Point<3>>{Point<3>(a), Point<3>(a + u)});
      tree.query(boost::geometry::index::intersects(box),
                 boost::make_function_output_iterator(
                   [&](const auto &entry) { take(entry.second); }));
    };
    const Pose pose = body.pose();
    const auto R    = pose.orientation.matrix();
    for (unsigned int i = 0; i < features.vertices.size(); ++i)
      visit(pose.place + R * features.vertices[i].place, Tensor<1, 3>(), [&](const auto f) {
        faces_of_corners.push_back({{i, f}});
      });
    for (unsigned int i = 0; i < features.edges.size(); ++i)
      {
        const Line line = line_of(pose, i);
        visit(line.a, line.u, [&](const auto f) {
          const auto corners = surface.segment(x, f);
          if (line.distance(middle_of(corners)) > half_width(corners) + search_radius)
            return;
          faces_of_edges.push_back({{i, f}});
          for (const unsigned int e : surface.get_faces()[f].edges)
            edges_of_edges.push_back({{i, e}});
        });
      }
    for (Candidates *const list : {&faces_of_corners, &faces_of_edges, &edges_of_edges})
      {
        std::sort(list->begin(), list->end());
        list->erase(std::unique(list->begin(), list->end()), list->end());
      }
  }
} // namespace akmon
