#include <akmon/contact/penalty.h>
#include <akmon/contact/search/face_geometry.h>
#include <akmon/contact/search/surface_search.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <map>

// The master faces that a slave may meet before candidates are looked for again.

namespace akmon
{
  using namespace dealii;

  namespace
  {
    Box
    box_around(const Segment &corners, const double margin)
    {
      Box box{corners[0], corners[0]};
      for (const auto &corner : corners)
        box.include(corner);
      box.widen(margin);
      return box;
    }
  } // namespace


  // Where ranks have slaves, with a margin within which the middle is of every face in whose box,
  // widened by the radius, a slave may be, of the neighbours that it may slide to, and of theirs,
  // whose normals count at edges and vertices.
  RankRegions
  SurfaceSearch::regions_of_slaves(const NodalVector &x) const
  {
    const double margin = search_radius +
                          2.5 * largest_diagonal(master_faces, x, discretization.communicator());

    RankRegions regions;
    for (unsigned int s = 0; s + 1 < slaves.size(); ++s)
      regions.add(at_node(x, slaves[s].node), discretization.body_of_node[slaves[s].node]);
    regions.exchange(margin, discretization.communicator());
    return regions;
  }


  std::vector<ContactNodes::Id>
  SurfaceSearch::fetch_master_faces(const ContactNodes &nodes, const NodalVector &x)
  {
    const MPI_Comm communicator = discretization.communicator();
    const unsigned int me       = Utilities::MPI::this_mpi_process(communicator);
    const bool alone            = Utilities::MPI::n_mpi_processes(communicator) == 1;
    RankRegions regions         = alone ? RankRegions() : regions_of_slaves(x);
    std::vector<FaceMessage> arrived;
    std::map<unsigned int, std::vector<FaceMessage>> outgoing;
    const std::vector<unsigned int> only_here = {me};
    for (unsigned int f = 0; f < master_faces.size(); ++f)
      if (const BoundaryFace &face = master_faces[f]; face.owned)
        {
          const auto &ranks = alone ? only_here : regions.at(middle_of(segment_of(face, x)));
          if (ranks.empty())
            continue;
          FaceMessage message{face.id, face.body, face.depth, stiffness_of_masters[f], {}};
          for (unsigned int k = 0; k < 4; ++k)
            message.nodes[k] = nodes.id_of_local(face.nodes[k]);
          for (const unsigned int rank : ranks)
            (rank == me ? arrived : outgoing[rank]).push_back(message);
        }
    for (const auto &[rank, messages] : Utilities::MPI::some_to_some(communicator, outgoing))
      arrived.insert(arrived.end(), messages.begin(), messages.end());
    std::sort(arrived.begin(), arrived.end(), [](const auto &a, const auto &b) {
      return a.id < b.id;
    });
    find_last_faces(arrived);
    fetched = std::move(arrived);

    std::vector<ContactNodes::Id> needed;
    for (const auto &face : fetched)
      needed.insert(needed.end(), face.nodes.begin(), face.nodes.end());
    for (const unsigned int f : slave_face_list)
      for (const unsigned int node : slave_faces[f].nodes)
        if (node >= discretization.n_owned_nodes)
          needed.push_back(nodes.id_of_local(node));
    return needed;
  }


  void
  SurfaceSearch::build_candidates(const ContactNodes &nodes,
                                  const ContactNodes::Field &x,
                                  const double moved)
  {
    settle_distances(moved);
    ++n_configurations;
    masters.clear();
    std::vector<Box> boxes; // by face
    boxes.reserve(fetched.size());
    for (const auto &message : fetched)
      {
        MasterFace face{{}, message.depth, message.stiffness};
        for (unsigned int k = 0; k < 4; ++k)
          face.nodes[k] = nodes.number(message.nodes[k]);
        boxes.push_back(box_around(segment(x, face), search_radius));
        masters.push_back(face);
      }
    number_slaves(nodes);
    corners_at.fill(nodes.size(), 4 * masters.size(), [&](const unsigned int corner) {
      return masters[corner / 4].nodes[corner % 4];
    });
    grid.reinit(std::move(boxes));
    box_masters(x);
    candidates.clear();
    for (unsigned int s = 0; s + 1 < slaves.size(); ++s)
      {
        slaves[s].first_candidate = candidates.size();
        add_candidates_of(x, s);
      }
    slaves.back().first_candidate = candidates.size();
    collect_body_pairs();
    built_radius = search_radius;
  }


  void
  SurfaceSearch::add_candidates_of(const ContactNodes::Field &x, const unsigned int slave)
  {
    const unsigned int body = discretization.body_of_node[slaves[slave].node];
    const auto point        = x[slaves[slave].number];
    const double radius_2   = search_radius * search_radius;
    bool has_outward        = false;
    Tensor<1, 3> outward;
    grid.visit_holding(point, [&](const unsigned int f) {
      const double at_least_2 = boxes_of_masters[f].bound_of_square(components(point));
      if (at_least_2 > radius_2)
        return;
      if (!has_outward)
        outward = slave_normal(x, slave);
      has_outward = true;
      if (may_face(f, slave, outward) && !(fetched[f].body == body && is_in_front_of(point, f)))
        candidates.push_back({f, 0, std::sqrt(at_least_2)});
    });
  }


  void
  SurfaceSearch::number_slaves(const ContactNodes &nodes)
  {
    for (unsigned int s = 0; s + 1 < slaves.size(); ++s)
      {
        slaves[s].id     = nodes.id_of_local(slaves[s].node);
        slaves[s].number = nodes.number(slaves[s].id);
      }
    nodes_of_slave_faces.resize(slave_face_list.size());
    for (unsigned int i = 0; i < slave_face_list.size(); ++i)
      for (unsigned int k = 0; k < 4; ++k)
        nodes_of_slave_faces[i][k] = nodes.number(
          nodes.id_of_local(slave_faces[slave_face_list[i]].nodes[k]));
  }


  // What is known does not reach beyond the faces that have been candidates.
  void
  SurfaceSearch::settle_distances(const double moved)
  {
    for (Memory &memory : memories)
      for (double *const distance : {&memory.clear_of, &memory.others_clear_of})
        *distance = std::min(*distance, built_radius - moved);
  }


  // The partners of the last search, in the order of the faces that are fetched now. Both lists are
  // sorted by id.
  void
  SurfaceSearch::find_last_faces(const std::vector<FaceMessage> &arrived)
  {
    std::vector<unsigned int> now(fetched.size(), numbers::invalid_unsigned_int);
    auto next = arrived.begin();
    for (unsigned int f = 0; f < fetched.size(); ++f)
      {
        while (next != arrived.end() && next->id < fetched[f].id)
          ++next;
        if (next != arrived.end() && next->id == fetched[f].id)
          now[f] = next - arrived.begin();
      }
    for (Memory &memory : memories)
      if (memory.face != numbers::invalid_unsigned_int)
        memory.face = now[memory.face];
  }


  // @param known  by the body of the slaves: numbers of its pairs
  unsigned int
  SurfaceSearch::number_of_pair(const unsigned int of_slaves,
                                const unsigned int of_faces,
                                std::vector<std::vector<unsigned int>> &known)
  {
    for (const unsigned int number : known[of_slaves])
      if (body_pairs[number].of_faces == of_faces)
        return number;
    known[of_slaves].push_back(body_pairs.size());
    body_pairs.push_back({of_slaves, of_faces});
    return known[of_slaves].back();
  }


  void
  SurfaceSearch::collect_body_pairs()
  {
    body_pairs.clear();
    pairs_around.clear();
    std::vector<std::vector<unsigned int>> known(discretization.get_bodies().size());
    for (unsigned int s = 0; s + 1 < slaves.size(); ++s)
      {
        const std::size_t first = pairs_around.size();
        const unsigned int body = discretization.body_of_node[slaves[s].node];
        for (unsigned int i = slaves[s].first_candidate; i < slaves[s + 1].first_candidate; ++i)
          {
            const unsigned int pair = number_of_pair(body, fetched[candidates[i].face].body, known);
            candidates[i].pair      = pair;
            if (std::none_of(pairs_around.begin() + first,
                             pairs_around.end(),
                             [&](const PairAround &around) { return around.pair == pair; }))
              pairs_around.push_back({s, pair});
          }
      }
  }


  void
  SurfaceSearch::collect_neighbours(std::vector<std::array<unsigned int, 2>> &bodies) const
  {
    for (const BodyPair &pair : body_pairs)
      bodies.push_back({{pair.of_slaves, pair.of_faces}});
  }


  // Whether a face can come to look at a slave before the candidates are built anew. On a surface
  // in contact with itself most faces nearby are the slave's own neighbours: they look the same
  // way, and no motion within the radius turns them round.
  bool
  SurfaceSearch::may_face(const unsigned int face,
                          const unsigned int slave,
                          const Tensor<1, 3> &outward) const
  {
    constexpr double same_way = 0.8; // cosine

    const double product = FaceBox<double>::dot(boxes_of_masters[face].edges[2],
                                                components(outward));
    const auto &nodes    = masters[face].nodes;
    return (fetched[face].body != discretization.body_of_node[slaves[slave].node] ||
            product <= 0. || product * product <= same_way * same_way * outward.norm_square()) &&
           std::find(nodes.begin(), nodes.end(), slaves[slave].number) == nodes.end();
  }


  // Whether a node of a body is in the cell behind one of the body's own faces, or further back: a
  // cell that is pressed flat must not be taken for a body in contact with itself.
  bool
  SurfaceSearch::is_in_front_of(const Tensor<1, 3> &point, const unsigned int face) const
  {
    constexpr double part = 0.25, beside = 0.5;

    const FaceBox<double> &box = boxes_of_masters[face];
    const auto from_middle     = FaceBox<double>::difference(components(point), box.middle);
    if (FaceBox<double>::dot(box.edges[2], from_middle) >= -part * masters[face].depth)
      return false;
    const double beyond_0 = box.beyond(from_middle, 0), beyond_1 = box.beyond(from_middle, 1);
    return beyond_0 * beyond_0 + beyond_1 * beyond_1 <= beside * beside * box.area;
  }
} // namespace akmon
