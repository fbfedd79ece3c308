#include <akmon/contact/penalty.h>
#include <akmon/contact/search/obstacle_search.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // Least edge at each owned node of some faces, by local node number.
    std::map<unsigned int, double>
    node_sizes(const Discretization &discretization, const std::vector<BoundaryFace> &faces)
    {
      std::map<unsigned int, double> sizes;
      for (const auto &face : faces)
        for (unsigned int k = 0; k < 4; ++k)
          for (const unsigned int end : {k, (k + 1) % 4})
            if (face.nodes[end] < discretization.n_owned_nodes)
              {
                const double edge = (at_node(discretization.reference, face.nodes[k]) -
                                     at_node(discretization.reference, face.nodes[(k + 1) % 4]))
                                      .norm();
                const auto entry = sizes.emplace(face.nodes[end], edge).first;
                entry->second    = std::min(entry->second, edge);
              }
      return sizes;
    }
  } // namespace


  RigidNodes::RigidNodes(const std::vector<RigidBody> &bodies)
  {
    for (const auto &body : bodies)
      {
        first.push_back(body.moves() ? n : none);
        n += body.moves() ? 2 : 0;
      }
  }


  void
  set_plane(ContactPair &pair, const Pose &pose, const Tensor<1, 3> &x)
  {
    const auto R      = pose.orientation.matrix();
    pair.plane_normal = transpose(R) * pair.normal;
    pair.plane_offset = pair.normal * (x - pose.place) - pair.gap;
  }


  double
  obstacle_gap(const RigidShape &shape,
               const Pose &pose,
               const ContactPair &pair,
               const Tensor<1, 3> &x)
  {
    const auto R     = pose.orientation.matrix();
    const auto X     = transpose(R) * (x - pose.place);
    const auto point = shape.closest(X);
    return pair.slot == 0 && point.normal * pair.plane_normal > 0. ?
             point.distance :
             pair.plane_normal * X - pair.plane_offset;
  }


  ObstacleSearch::ObstacleSearch(const Discretization &discretization,
                                 const RigidBody &body,
                                 const unsigned int interface)
    : body(body)
    , interface(interface)
  {
    const auto &obstacle = body.parameters();
    faces                = discretization.faces_on(
      discretization.boundary_ids("Obstacles/" + obstacle.name, "Surfaces", obstacle.slaves));
    const auto stiffness = penalty_stiffness_of_nodes(discretization, faces);
    for (const auto &[node, size] : node_sizes(discretization, faces))
      slaves.push_back({node, size, stiffness.at(node)});
    groups.resize((slaves.size() + n_in_group - 1) / n_in_group);
    for (std::size_t i = 0; i < slaves.size(); ++i)
      groups[i / n_in_group].size = std::max(groups[i / n_in_group].size, slaves[i].size);
  }


  void
  ObstacleSearch::find_pairs(const ContactNodes &nodes,
                             const ContactNodes::Field &x,
                             const unsigned int first_rigid,
                             const double reach,
                             const double travelled,
                             std::vector<ContactPair> &pairs)
  {
    const auto within = [&](const double size) { return std::max(reach, always_near * size); };
    const Pose pose   = body.pose();
    const Place place{pose, pose.orientation.matrix(), body.centre(), first_rigid, travelled};
    for (std::size_t g = 0; g < groups.size(); ++g)
      {
        Group &group = groups[g];
        if (group.clear_of - travelled > within(group.size))
          continue;
        group.clear_of = std::numeric_limits<double>::max();
        for (std::size_t i = g * n_in_group; i < std::min(slaves.size(), (g + 1) * n_in_group); ++i)
          {
            Slave &slave = slaves[i];
            if (slave.clear_of - travelled <= within(slave.size))
              find_pairs_of(place, within(slave.size), nodes, x, slave, pairs);
            group.clear_of = std::min(group.clear_of, slave.clear_of);
          }
      }
  }


  void
  ObstacleSearch::find_pairs_of(const Place &place,
                                const double within,
                                const ContactNodes &nodes,
                                const ContactNodes::Field &x,
                                Slave &slave,
                                std::vector<ContactPair> &pairs)
  {
    const auto &shape         = *body.parameters().shape;
    const auto &R             = place.orientation;
    const auto id             = nodes.id_of_local(slave.node);
    const unsigned int number = nodes.number(id);
    const auto in_frame       = transpose(R) * (x[number] - place.pose.place);
    parts.clear();
    shape.nearby(in_frame, within, parts);
    if (parts.empty())
      {
        slave.clear_of = place.travelled + std::max(within, shape.closest(in_frame).distance);
        return;
      }
    ContactPair pair;
    pair.interface  = interface;
    pair.kind       = ContactPair::Kind::node_to_shape;
    pair.slave      = slave.node;
    pair.slave_id   = id;
    pair.nodes[0]   = number;
    pair.weights[0] = 1.;
    pair.size       = slave.size;
    pair.stiffness  = slave.stiffness;
    pair.place      = x[number];
    if (body.moves())
      {
        pair.add_node(place.first_rigid, -1.);
        pair.add_rotation(place.first_rigid + 1, -1., pair.place - place.centre);
      }
    for (const auto &part : parts)
      {
        pair.slot   = &part - parts.data();
        pair.gap    = part.distance;
        pair.normal = R * part.normal;
        set_plane(pair, place.pose, pair.place);
        pairs.push_back(pair);
      }
  }
} // namespace akmon
