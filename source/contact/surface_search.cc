#include <akmon/contact/penalty.h>
#include <akmon/contact/surface_search.h>

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/mpi.h>
#include <deal.II/numerics/rtree.h>

#include <boost/iterator/function_output_iterator.hpp>

#include <algorithm>
#include <cmath>

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
      Segment corners;
      for (unsigned int k = 0; k < 4; ++k)
        corners[k] = at_node(discretization.reference, face.nodes[k]);
      return std::sqrt(area_vector(corners).norm());
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


    // Whether a node of a body is in the cell behind one of the body's own faces, or further back:
    // a cell that is pressed flat must not be taken for a body in contact with itself.
    bool
    lies_behind(const Tensor<1, 3> &point, const Segment &corners, const double depth)
    {
      constexpr double part = 0.25, beside = 0.5;

      const auto area     = area_vector(corners);
      const auto normal   = area / area.norm();
      const auto offset   = project(point, corners).offset;
      const double behind = -(normal * offset);
      return behind > part * depth &&
             (offset + behind * normal).norm() <= beside * std::sqrt(area.norm());
    }


    BoundingBox<3>
    box_around(const std::vector<Point<3>> &points, const double margin)
    {
      BoundingBox<3> box(points);
      box.extend(margin);
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
  }


  // Per rank the box around its slaves, lower corner and upper corner, widened so that it meets
  // every face within the radius of a slave and the neighbours of such faces (whose normals count
  // at edges and vertices). Empty (upper below lower) for ranks without slaves.
  std::vector<std::array<double, 6>>
  SurfaceSearch::slave_boxes_of_all_ranks(const NodalVector &x) const
  {
    double largest_diagonal = 0.;
    for (const auto &face : master_faces)
      for (unsigned int k = 0; k < 2; ++k)
        largest_diagonal = std::max(largest_diagonal,
                                    (at_node(x, face.nodes[k]) - at_node(x, face.nodes[k + 2]))
                                      .norm());
    const double margin = search_radius +
                          Utilities::MPI::max(largest_diagonal, discretization.communicator());

    std::vector<Point<3>> points;
    for (unsigned int s = 0; s + 1 < slaves.size(); ++s)
      points.emplace_back(at_node(x, slaves[s].node));
    std::array<double, 6> box = {{1., 1., 1., 0., 0., 0.}};
    if (!points.empty())
      {
        const auto corners = box_around(points, margin).get_boundary_points();
        for (unsigned int d = 0; d < 3; ++d)
          {
            box[d]     = corners.first[d];
            box[3 + d] = corners.second[d];
          }
      }
    return Utilities::MPI::all_gather(discretization.communicator(), box);
  }


  std::vector<ContactNodes::Id>
  SurfaceSearch::fetch_master_faces(const ContactNodes &nodes, const NodalVector &x)
  {
    const MPI_Comm communicator = discretization.communicator();
    const unsigned int me       = Utilities::MPI::this_mpi_process(communicator);
    const auto slave_boxes      = slave_boxes_of_all_ranks(x);

    std::map<unsigned int, std::vector<FaceMessage>> outgoing;
    for (const auto &face : master_faces)
      if (face.owned)
        {
          std::vector<Point<3>> points;
          FaceMessage message{face.id,
                              face.body,
                              face.depth,
                              penalty_stiffness(discretization, face),
                              {}};
          for (unsigned int k = 0; k < 4; ++k)
            {
              points.emplace_back(at_node(x, face.nodes[k]));
              message.nodes[k] = nodes.id_of_local(face.nodes[k]);
            }
          const auto box = BoundingBox<3>(points).get_boundary_points();
          for (unsigned int rank = 0; rank < slave_boxes.size(); ++rank)
            {
              bool overlaps = true;
              for (unsigned int d = 0; d < 3; ++d)
                overlaps = overlaps && box.first[d] <= slave_boxes[rank][3 + d] &&
                           box.second[d] >= slave_boxes[rank][d];
              if (overlaps)
                outgoing[rank].push_back(message);
            }
        }
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
    return needed;
  }


  void
  SurfaceSearch::build_candidates(const ContactNodes &nodes,
                                  const NodalVector &positions,
                                  const ContactNodes::Field &x)
  {
    masters.clear();
    std::vector<std::pair<unsigned int, unsigned int>> incidence; // (contact node, face)
    std::vector<std::pair<BoundingBox<3>, unsigned int>> boxes;
    for (const auto &message : fetched)
      {
        MasterFace face{message.body, message.depth, message.stiffness, {}};
        std::vector<Point<3>> points;
        for (unsigned int k = 0; k < 4; ++k)
          {
            face.nodes[k] = nodes.number(message.nodes[k]);
            points.emplace_back(x[face.nodes[k]]);
            incidence.emplace_back(face.nodes[k], masters.size());
          }
        boxes.emplace_back(box_around(points, search_radius), masters.size());
        masters.push_back(face);
      }

    std::sort(incidence.begin(), incidence.end());
    faces_at.clear();
    faces_at_begin.assign(incidence.empty() ? 1 : incidence.back().first + 2, 0);
    for (const auto &[node, f] : incidence)
      {
        faces_at.push_back(f);
        ++faces_at_begin[node + 1];
      }
    for (unsigned int i = 1; i < faces_at_begin.size(); ++i)
      faces_at_begin[i] += faces_at_begin[i - 1];

    const auto tree = pack_rtree(boxes);
    candidates.clear();
    for (unsigned int s = 0; s + 1 < slaves.size(); ++s)
      {
        slaves[s].first_candidate = candidates.size();
        slaves[s].id              = nodes.id_of_local(slaves[s].node);
        slaves[s].number          = nodes.number(slaves[s].id);
        const auto outward        = slave_normal(positions, s);
        tree.query(boost::geometry::index::intersects(Point<3>(x[slaves[s].number])),
                   boost::make_function_output_iterator([&](const auto &entry) {
                     const auto &face = masters[entry.second];
                     if (face.body == discretization.body_of_node[slaves[s].node] &&
                         lies_behind(x[slaves[s].number], segment(x, face), face.depth))
                       return;
                     if (may_face(x, face, slaves[s].number, outward))
                       candidates.push_back(entry.second);
                   }));
        std::sort(candidates.begin() + slaves[s].first_candidate, candidates.end());
      }
    slaves.back().first_candidate = candidates.size();
    shapes.assign(masters.size(), FaceShape());
    last_faces.assign(slaves.size(), numbers::invalid_unsigned_int);
    rest_until.assign(slaves.size(), 0.);
  }


  // Whether a face can come to look at a slave before the candidates are built anew. On a surface
  // in contact with itself most faces nearby are the slave's own neighbours: they look the same
  // way, and no motion within the radius turns them round.
  bool
  SurfaceSearch::may_face(const ContactNodes::Field &x,
                          const MasterFace &face,
                          const unsigned int slave_number,
                          const Tensor<1, 3> &outward) const
  {
    constexpr double same_way = 0.8; // cosine

    if (std::find(face.nodes.begin(), face.nodes.end(), slave_number) != face.nodes.end())
      return false;
    const auto normal = area_vector(segment(x, face));
    return normal * outward <= same_way * normal.norm() * outward.norm();
  }
} // namespace akmon
