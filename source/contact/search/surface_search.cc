#include <akmon/contact/penalty.h>
#include <akmon/contact/search/face_geometry.h>
#include <akmon/contact/search/surface_search.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    std::vector<BoundaryFace>
    select_faces(const Discretization &discretization,
                 const SurfaceContact &contact,
                 const std::string &key,
                 const std::vector<std::string> &surfaces)
    {
      std::set<types::boundary_id> ids;
      for (const auto &surface : surfaces)
        ids.merge(discretization.boundary_ids("Contact/" + contact.name, key, surface));
      return discretization.faces_on(ids);
    }


    double
    face_size(const Discretization &discretization, const BoundaryFace &face)
    {
      return std::sqrt(area_vector(segment_of(face, discretization.reference)).norm());
    }


    // Mean size of the faces of all ranks; zero if there are none.
    double
    mean_size(const Discretization &discretization, const std::vector<BoundaryFace> &faces)
    {
      double sum = 0., n = 0.;
      for (const auto &face : faces)
        if (face.owned)
          {
            sum += face_size(discretization, face);
            n += 1.;
          }
      n = Utilities::MPI::sum(n, discretization.communicator());
      return n > 0. ? Utilities::MPI::sum(sum, discretization.communicator()) / n : 0.;
    }


    BoxGrid::Box
    box_around(const Segment &corners, const double margin)
    {
      BoxGrid::Box box{corners[0], corners[0]};
      for (unsigned int d = 0; d < 3; ++d)
        {
          for (const auto &corner : corners)
            {
              box.lower[d] = std::min(box.lower[d], corner[d]);
              box.upper[d] = std::max(box.upper[d], corner[d]);
            }
          box.lower[d] -= margin;
          box.upper[d] += margin;
        }
      return box;
    }
  } // namespace


  SurfaceSearch::SurfaceSearch(const Discretization &discretization,
                               const SurfaceContact &contact,
                               const unsigned int interface,
                               const unsigned int number,
                               const bool reversed,
                               const bool coupled)
    : discretization(discretization)
    , contact(contact)
    , interface(interface)
    , number(number)
    , reversed(reversed)
    , coupled(coupled)
    , has_friction(contact.friction.static_coefficient > 0.)
    , slave_faces(select_faces(discretization, contact, "Slave", contact.slaves))
    , master_faces(select_faces(discretization, contact, "Master", contact.masters))
  {
    if (reversed)
      std::swap(slave_faces, master_faces);
    least_radius = search_radius = 0.5 * std::max(mean_size(discretization, slave_faces),
                                                  mean_size(discretization, master_faces));
    faces                        = slave_faces;
    faces.insert(faces.end(), master_faces.begin(), master_faces.end());
    collect_slaves();
  }


  void
  SurfaceSearch::collect_slaves()
  {
    std::vector<std::pair<unsigned int, unsigned int>> incidence; // (owned node, slave face)
    for (unsigned int f = 0; f < slave_faces.size(); ++f)
      for (const unsigned int node : slave_faces[f].nodes)
        if (node < discretization.n_owned_nodes)
          incidence.emplace_back(node, f);
    std::sort(incidence.begin(), incidence.end());
    const auto new_slave = [&](const unsigned int node) {
      Slave slave{};
      slave.node       = node;
      slave.size       = std::numeric_limits<double>::max();
      slave.first_face = slave_face_list.size();
      slaves.push_back(slave);
    };
    for (const auto &[node, f] : incidence)
      {
        if (slaves.empty() || slaves.back().node != node)
          new_slave(node);
        slave_face_list.push_back(f);
        for (unsigned int k = 0; k < 4; ++k)
          slaves.back()
            .size = std::min(slaves.back().size,
                             (at_node(discretization.reference, slave_faces[f].nodes[k]) -
                              at_node(discretization.reference, slave_faces[f].nodes[(k + 1) % 4]))
                               .norm());
      }
    new_slave(numbers::invalid_unsigned_int);
    const auto stiffness = penalty_stiffness_of_nodes(discretization, slave_faces);
    for (unsigned int s = 0; s + 1 < slaves.size(); ++s)
      slaves[s].stiffness = stiffness.at(slaves[s].node);
    outwards.resize(slaves.size());
    face_areas.resize(slave_faces.size());
    forget_distances();
  }


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
    std::map<unsigned int, std::vector<FaceMessage>> outgoing;
    const std::vector<unsigned int> only_here = {me};
    for (const auto &face : master_faces)
      if (face.owned)
        {
          const auto corners = segment_of(face, x);
          const auto middle  = middle_of(corners);
          const auto &ranks  = alone ? only_here : regions.at(middle);
          if (ranks.empty())
            continue;
          FaceMessage message{face.id,
                              face.body,
                              face.depth,
                              penalty_stiffness(discretization, face),
                              {}};
          for (unsigned int k = 0; k < 4; ++k)
            message.nodes[k] = nodes.id_of_local(face.nodes[k]);
          for (const unsigned int rank : ranks)
            outgoing[rank].push_back(message);
        }
    last_ids.clear();
    for (const Memory &memory : memories)
      last_ids.push_back(memory.face != numbers::invalid_unsigned_int ? fetched[memory.face].id :
                                                                        numbers::invalid_dof_index);
    fetched = std::move(outgoing[me]);
    outgoing.erase(me);
    for (const auto &[rank, messages] : Utilities::MPI::some_to_some(communicator, outgoing))
      fetched.insert(fetched.end(), messages.begin(), messages.end());
    std::sort(fetched.begin(), fetched.end(), [](const auto &a, const auto &b) {
      return a.id < b.id;
    });

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
    std::vector<BoxGrid::Box> boxes;   // by face
    std::vector<Tensor<1, 3>> normals; // by face
    for (const auto &message : fetched)
      {
        MasterFace face{{}, message.depth, message.stiffness};
        for (unsigned int k = 0; k < 4; ++k)
          face.nodes[k] = nodes.number(message.nodes[k]);
        const Segment corners = segment(x, face);
        boxes.push_back(box_around(corners, search_radius));
        normals.push_back(unit_normal(corners));
        masters.push_back(face);
      }
    number_slaves(nodes);
    collect_faces_at_nodes(nodes.size());
    grid.reinit(std::move(boxes));
    candidates.clear();
    for (unsigned int s = 0; s + 1 < slaves.size(); ++s)
      {
        Slave &slave          = slaves[s];
        slave.first_candidate = candidates.size();
        const auto outward    = slave_normal(x, s);
        const auto point      = x[slave.number];
        grid.visit_holding(point, [&](const unsigned int f) {
          if (may_face(f, normals[f], s, outward) &&
              !(fetched[f].body == discretization.body_of_node[slave.node] &&
                is_in_front_of(x, point, f, normals[f])))
            candidates.push_back({f, 0, 0.});
        });
      }
    slaves.back().first_candidate = candidates.size();
    collect_body_pairs();
    find_last_faces();
    built_radius = search_radius;
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


  void
  SurfaceSearch::collect_faces_at_nodes(const unsigned int n_nodes)
  {
    faces_at_begin.assign(n_nodes + 1, 0);
    for (const MasterFace &face : masters)
      for (const unsigned int node : face.nodes)
        ++faces_at_begin[node + 1];
    for (unsigned int node = 0; node < n_nodes; ++node)
      faces_at_begin[node + 1] += faces_at_begin[node];
    faces_at.resize(faces_at_begin.back());
    std::vector<unsigned int> next(faces_at_begin.begin(), faces_at_begin.end() - 1);
    for (unsigned int f = 0; f < masters.size(); ++f)
      for (const unsigned int node : masters[f].nodes)
        faces_at[next[node]++] = f;
  }


  // What is known does not reach beyond the faces that have been candidates.
  void
  SurfaceSearch::settle_distances(const double moved)
  {
    for (Memory &memory : memories)
      for (double *const distance : {&memory.clear_of, &memory.others_clear_of})
        *distance = std::min(*distance, built_radius - moved);
  }


  void
  SurfaceSearch::find_last_faces()
  {
    for (unsigned int s = 0; s < last_ids.size(); ++s)
      {
        const auto found = std::lower_bound(fetched.begin(),
                                            fetched.end(),
                                            last_ids[s],
                                            [](const FaceMessage &face, const auto id) {
                                              return face.id < id;
                                            });
        memories[s].face = found != fetched.end() && found->id == last_ids[s] ?
                             found - fetched.begin() :
                             numbers::invalid_unsigned_int;
      }
  }


  void
  SurfaceSearch::forget_distances()
  {
    memories.assign(slaves.size(), Memory());
    candidates.clear();
    body_pairs.clear();
    pairs_around.clear();
    for (Slave &slave : slaves)
      slave.first_candidate = 0;
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
                          const Tensor<1, 3> &normal,
                          const unsigned int slave,
                          const Tensor<1, 3> &outward) const
  {
    constexpr double same_way = 0.8; // cosine

    const double product = normal * outward;
    const auto &nodes    = masters[face].nodes;
    return (product <= 0. || product * product <= same_way * same_way * outward.norm_square()) &&
           std::find(nodes.begin(), nodes.end(), slaves[slave].number) == nodes.end();
  }
} // namespace akmon
