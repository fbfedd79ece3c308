#include <akmon/contact/penalty.h>
#include <akmon/contact/search/edge_search.h>
#include <akmon/contact/search/face_geometry.h>
#include <akmon/contact/search/rank_regions.h>

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/mpi.h>
#include <deal.II/numerics/rtree.h>

#include <boost/iterator/function_output_iterator.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

// Which edges there are, and which of them may meet.

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // The angle by which the surface turns outward from one face to the next, across the edge from
    // the first one's corner k on; negative in valleys.
    double
    turn_between(const Discretization &discretization,
                 const BoundaryFace &first,
                 const BoundaryFace &second,
                 const unsigned int k)
    {
      const auto corners = segment_of(first, discretization.reference);
      const auto along   = corners[(k + 1) % 4] - corners[k];
      const auto a       = area_vector(corners);
      const auto b       = area_vector(segment_of(second, discretization.reference));
      const double sine = cross_product_3d(a, b) * along / along.norm(), cosine = a * b;
      return std::atan2(sine, cosine);
    }


    BoundingBox<3>
    box_of(const Point<3> &a, const Point<3> &b, const double margin)
    {
      BoundingBox<3> box(std::vector<Point<3>>{a, b}); // of a pair of points they would be corners
      box.extend(margin);
      return box;
    }


    void
    number(const ContactNodes &nodes, std::vector<FeatureEdge> &edges)
    {
      for (auto &edge : edges)
        {
          for (unsigned int end = 0; end < 2; ++end)
            edge.nodes[end] = nodes.number(edge.ids[end]);
          for (unsigned int f = 0; f < edge.n_faces; ++f)
            for (unsigned int k = 0; k < 4; ++k)
              edge.corners[f][k] = nodes.number(edge.faces[f][k]);
        }
      std::sort(edges.begin(), edges.end(), [](const FeatureEdge &a, const FeatureEdge &b) {
        return a.ids < b.ids;
      });
    }
  } // namespace


  EdgeSearch::EdgeSearch(const Discretization &discretization,
                         const SurfaceContact &contact,
                         const SurfaceSearch &surfaces,
                         const unsigned int interface)
    : discretization(discretization)
    , interface(interface)
    , one_surface(is_one_surface(discretization, contact))
    , has_friction(contact.friction.static_coefficient > 0.)
    , rim_tolerance(contact.rim_tolerance)
  {
    const auto faces = discretization.faces_on(
      discretization.boundary_ids("Contact/" + contact.name, "Slave", "all"));
    const auto edges = edges_of(discretization, faces);
    own_slaves       = sharp_edges(edges, surfaces.get_slave_faces(), contact.edge_angle);
    own_masters      = one_surface ? own_slaves :
                                     sharp_edges(edges, surfaces.get_master_faces(), contact.edge_angle);
    const auto total = [&](const std::vector<OwnEdge> &own) {
      return Utilities::MPI::sum(own.size(), discretization.communicator());
    };
    exist                 = total(own_slaves) > 0 && total(own_masters) > 0;
    unsigned int n_narrow = 0;
    for (const auto *const own : {&own_slaves, &own_masters})
      for (const auto &edge : *own)
        n_narrow += edge.edge.narrow[0] + edge.edge.narrow[1];
    has_narrow_faces = exist && Utilities::MPI::sum(n_narrow, discretization.communicator()) > 0;
  }


  // The edges with an owned node of all boundary faces, both faces' of an edge side by side.
  std::vector<EdgeSearch::FaceEdge>
  EdgeSearch::edges_of(const Discretization &discretization, const std::vector<BoundaryFace> &faces)
  {
    std::vector<FaceEdge> edges;
    for (const auto &face : faces)
      for (unsigned int k = 0; k < 4; ++k)
        {
          FaceEdge edge{{{face.nodes[k], face.nodes[(k + 1) % 4]}}, &face, k};
          if (edge.nodes[0] >= discretization.n_owned_nodes &&
              edge.nodes[1] >= discretization.n_owned_nodes)
            continue;
          if (discretization.global_node(edge.nodes[1]) < discretization.global_node(edge.nodes[0]))
            std::swap(edge.nodes[0], edge.nodes[1]);
          edges.push_back(edge);
        }
    std::stable_sort(edges.begin(), edges.end(), [](const FaceEdge &a, const FaceEdge &b) {
      return a.nodes < b.nodes;
    });
    return edges;
  }


  // An edge between two faces; of none on the surface if it is no part of it.
  EdgeSearch::OwnEdge
  EdgeSearch::edge_between(const FaceEdge &first,
                           const FaceEdge &second,
                           const std::set<types::global_cell_index> &surface) const
  {
    OwnEdge edge{};
    edge.nodes      = first.nodes;
    edge.edge.angle = turn_between(discretization, *first.face, *second.face, first.k);
    edge.edge.size = edge.edge.depth = edge.edge.stiffness = std::numeric_limits<double>::max();
    for (const auto &side : {first, second})
      if (surface.count(side.face->id) > 0)
        {
          const auto &face                = *side.face;
          edge.edge.body                  = face.body;
          edge.edge.size                  = std::min(edge.edge.size,
                                    least_edge(segment_of(face, discretization.reference)));
          edge.edge.depth                 = std::min(edge.edge.depth, face.depth);
          edge.edge.stiffness             = std::min(edge.edge.stiffness,
                                         penalty_stiffness(discretization, face));
          edge.faces[edge.edge.n_faces++] = face.nodes;
        }
    return edge;
  }


  // Those of the edges that are sharp and belong to one of some faces, and the others of narrow
  // faces. Edges belong to the owner of their first node.
  std::vector<EdgeSearch::OwnEdge>
  EdgeSearch::sharp_edges(const std::vector<FaceEdge> &edges,
                          const std::vector<BoundaryFace> &surface,
                          const double least_angle) const
  {
    std::set<types::global_cell_index> on_surface;
    for (const auto &face : surface)
      on_surface.insert(face.id);
    NodalVector n_at_node = discretization.make_vector(), ways = discretization.make_vector();
    std::vector<OwnEdge> result, others;
    for (auto begin = edges.begin(); begin != edges.end();)
      {
        auto end = begin;
        while (end != edges.end() && end->nodes == begin->nodes)
          ++end;
        const auto first = begin;
        begin            = end;
        if (end - first != 2)
          continue; // of a fold that touches itself
        OwnEdge edge = edge_between(first[0], first[1], on_surface);
        if (edge.edge.n_faces == 0)
          continue;
        const bool is_own = edge.nodes[0] < discretization.n_owned_nodes;
        edge.edge.sharp   = edge.edge.angle >= least_angle;
        if (!edge.edge.sharp)
          {
            if (is_own && edge.edge.angle > -least_angle)
              others.push_back(edge);
            continue;
          }
        auto way = at_node(discretization.reference, edge.nodes[1]) -
                   at_node(discretization.reference, edge.nodes[0]);
        way /= way.norm();
        for (unsigned int end = 0; end < 2; ++end)
          if (const unsigned int node = edge.nodes[end]; node < discretization.n_owned_nodes)
            {
              n_at_node.local_element(3 * node) += 1.;
              for (unsigned int d = 0; d < 3; ++d)
                ways.local_element(3 * node + d) += (end == 0 ? 1. : -1.) * way[d];
            }
        if (is_own)
          result.push_back(edge);
      }
    n_at_node.update_ghost_values();
    ways.update_ghost_values();
    // Two edges that turn as sharply as the surface does meet in a corner.
    const double straight = 2. * std::sin(0.5 * least_angle);
    for (auto &edge : result)
      for (unsigned int end = 0; end < 2; ++end)
        edge.edge.end[end] = n_at_node.local_element(3 * edge.nodes[end]) != 2. ||
                             at_node(ways, edge.nodes[end]).norm() > straight;
    add_edges_of_narrow_faces(n_at_node, others, result);
    return result;
  }


  // To the sharp ones, by how many of these there are at the nodes. They end there.
  void
  EdgeSearch::add_edges_of_narrow_faces(const NodalVector &n_at_node,
                                        const std::vector<OwnEdge> &others,
                                        std::vector<OwnEdge> &edges)
  {
    const auto is_at_sharp_edge = [&](const unsigned int node) {
      return n_at_node.local_element(3 * node) > 0.;
    };
    const auto find_narrow_faces = [&](OwnEdge &edge) {
      for (unsigned int f = 0; f < edge.edge.n_faces; ++f)
        edge.edge.narrow[f] = std::all_of(edge.faces[f].begin(),
                                          edge.faces[f].end(),
                                          is_at_sharp_edge);
    };
    for (auto &edge : edges)
      find_narrow_faces(edge);
    for (OwnEdge edge : others)
      {
        find_narrow_faces(edge);
        for (unsigned int end = 0; end < 2; ++end)
          edge.edge.end[end] = is_at_sharp_edge(edge.nodes[end]);
        if (edge.edge.narrow[0] || edge.edge.narrow[1])
          edges.push_back(edge);
      }
  }


  // With the ids that the nodes have got.
  std::vector<FeatureEdge>
  EdgeSearch::named(const std::vector<OwnEdge> &own, const ContactNodes &nodes) const
  {
    std::vector<FeatureEdge> edges;
    for (const auto &edge : own)
      {
        edges.push_back(edge.edge);
        edges.back().first = edge.nodes[0];
        for (unsigned int end = 0; end < 2; ++end)
          edges.back().ids[end] = nodes.id_of_local(edge.nodes[end]);
        for (unsigned int f = 0; f < edge.edge.n_faces; ++f)
          for (unsigned int k = 0; k < 4; ++k)
            edges.back().faces[f][k] = nodes.id_of_local(edge.faces[f][k]);
      }
    return edges;
  }


  // How far the edges of a face over an edge may be beyond the radius of its ends.
  double
  EdgeSearch::margin_of_faces(const NodalVector &x) const
  {
    double widest = 0.;
    for (const auto *const own : {&own_slaves, &own_masters})
      for (const auto &edge : *own)
        for (unsigned int f = 0; f < edge.edge.n_faces; ++f)
          for (const unsigned int node : edge.faces[f])
            widest = std::max(widest, (at_node(x, node) - at_node(x, edge.nodes[0])).norm());
    return 2. * Utilities::MPI::max(widest, discretization.communicator());
  }


  std::vector<ContactNodes::Id>
  EdgeSearch::fetch_edges(const ContactNodes &nodes, const NodalVector &x, const double radius)
  {
    if (!exist)
      return {};
    const MPI_Comm communicator = discretization.communicator();
    const unsigned int me       = Utilities::MPI::this_mpi_process(communicator);
    slaves                      = named(own_slaves, nodes);
    const auto own              = named(own_masters, nodes);
    double longest              = 0.;
    for (const auto &edge : own_masters)
      longest = std::max(longest, (at_node(x, edge.nodes[1]) - at_node(x, edge.nodes[0])).norm());
    RankRegions regions;
    for (unsigned int i = 0; i < slaves.size(); ++i)
      for (const unsigned int node : own_slaves[i].nodes)
        regions.add(at_node(x, node), slaves[i].body);
    double margin = radius + 0.5 * Utilities::MPI::max(longest, communicator);
    if (has_narrow_faces)
      margin += margin_of_faces(x);
    regions.exchange(margin, communicator);

    std::map<unsigned int, std::vector<FeatureEdge>> outgoing;
    for (unsigned int i = 0; i < own.size(); ++i)
      {
        const auto a = at_node(x, own_masters[i].nodes[0]), b = at_node(x, own_masters[i].nodes[1]);
        for (const unsigned int rank : regions.at(0.5 * (a + b)))
          outgoing[rank].push_back(own[i]);
      }
    masters = std::move(outgoing[me]);
    outgoing.erase(me);
    for (const auto &[rank, edges] : Utilities::MPI::some_to_some(communicator, outgoing))
      masters.insert(masters.end(), edges.begin(), edges.end());

    std::vector<ContactNodes::Id> needed;
    for (const auto *const side : {&slaves, &masters})
      for (const auto &edge : *side)
        {
          needed.insert(needed.end(), edge.ids.begin(), edge.ids.end());
          for (unsigned int f = 0; f < edge.n_faces; ++f)
            needed.insert(needed.end(), edge.faces[f].begin(), edge.faces[f].end());
        }
    return needed;
  }


  // Each narrow face once, sorted by ids. Which of its edges are here does not matter.
  std::vector<EdgeSearch::EdgeFace>
  EdgeSearch::faces_of(const ContactNodes &nodes, const std::vector<FeatureEdge> &edges)
  {
    std::vector<EdgeFace> faces;
    for (const auto &edge : edges)
      for (unsigned int f = 0; f < edge.n_faces; ++f)
        {
          if (!edge.narrow[f])
            continue;
          EdgeFace face;
          face.ids    = edge.faces[f];
          face.nodes  = edge.corners[f];
          face.lowest = std::min_element(face.ids.begin(), face.ids.end()) - face.ids.begin();
          const unsigned int lowest = face.nodes[face.lowest];
          face.local                = lowest < nodes.n_owned() ? nodes.local_node(lowest) :
                                                                 numbers::invalid_unsigned_int;
          faces.push_back(face);
        }
    std::sort(faces.begin(), faces.end(), [](const EdgeFace &a, const EdgeFace &b) {
      return a.ids < b.ids;
    });
    faces.erase(std::unique(faces.begin(),
                            faces.end(),
                            [](const EdgeFace &a, const EdgeFace &b) { return a.ids == b.ids; }),
                faces.end());
    return faces;
  }


  void
  EdgeSearch::build_candidates(const ContactNodes &nodes,
                               const ContactNodes::Field &x,
                               const double radius)
  {
    candidates.clear();
    line_candidates.clear();
    dip_candidates.clear();
    if (!exist)
      return;
    akmon::number(nodes, slaves);
    akmon::number(nodes, masters);
    std::vector<std::pair<BoundingBox<3>, unsigned int>> boxes;
    for (unsigned int i = 0; i < masters.size(); ++i)
      boxes.emplace_back(box_of(Point<3>(x[masters[i].nodes[0]]),
                                Point<3>(x[masters[i].nodes[1]]),
                                radius),
                         i);
    const auto tree = pack_rtree(boxes);
    for (unsigned int i = 0; i < slaves.size(); ++i)
      {
        const auto &slave = slaves[i];
        const auto box    = box_of(Point<3>(x[slave.nodes[0]]), Point<3>(x[slave.nodes[1]]), 0.);
        tree.query(boost::geometry::index::intersects(box),
                   boost::make_function_output_iterator([&](const auto &entry) {
                     const auto &master = masters[entry.second];
                     const bool touch   = slave.ids[0] == master.ids[0] ||
                                        slave.ids[0] == master.ids[1] ||
                                        slave.ids[1] == master.ids[0] ||
                                        slave.ids[1] == master.ids[1];
                     if (!touch && (!one_surface || slave.ids < master.ids))
                       (slave.sharp && master.sharp ? candidates : line_candidates)
                         .push_back({{i, entry.second}});
                   }));
      }
    std::sort(candidates.begin(), candidates.end());
    std::sort(line_candidates.begin(), line_candidates.end());
    if (has_narrow_faces)
      build_dip_candidates(nodes, x, radius);
  }
} // namespace akmon
