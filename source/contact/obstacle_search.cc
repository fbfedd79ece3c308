#include <akmon/contact/obstacle_search.h>
#include <akmon/contact/penalty.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // Slaves this close, over their size, always get their pairs: bodies may be about to start.
    constexpr double always_near = 0.1;

    // Names of pairs between rigid bodies: behind all nodes' ids.
    constexpr ContactNodes::Id first_touch_id = ContactNodes::Id(1) << 28;
    constexpr unsigned int features_per_touch = 1u << 20;


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


    // Remember the plane a pair was found with, in the frame of its rigid partner.
    void
    set_plane(ContactPair &pair, const Pose &pose, const Tensor<1, 3> &x)
    {
      const auto R      = pose.orientation.matrix();
      pair.plane_normal = transpose(R) * pair.normal;
      pair.plane_offset = pair.normal * (x - pose.place) - pair.gap;
    }


    void
    add_body(ContactPair &pair, const unsigned int node, const double weight)
    {
      pair.nodes[pair.n_nodes]     = node;
      pair.weights[pair.n_nodes++] = weight;
    }


    void
    add_rotation(ContactPair &pair,
                 const unsigned int node,
                 const double weight,
                 const Tensor<1, 3> &radius)
    {
      pair.radii[pair.n_rotations++] = radius;
      add_body(pair, node, weight);
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


  SurfacePoint
  closest_in_space(const RigidShape &shape, const Pose &pose, const Tensor<1, 3> &x)
  {
    const auto R       = pose.orientation.matrix();
    SurfacePoint point = shape.closest(transpose(R) * (x - pose.place));
    point.normal       = R * point.normal;
    return point;
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
    std::set<types::boundary_id> ids;
    for (const auto &surface : obstacle.slaves)
      ids.merge(discretization.boundary_ids("Obstacles/" + obstacle.name, "Surfaces", surface));
    faces                = discretization.faces_on(ids);
    const auto stiffness = penalty_stiffness_of_nodes(discretization, faces);
    for (const auto &[node, size] : node_sizes(discretization, faces))
      slaves.push_back({node, size, stiffness.at(node)});
  }


  void
  ObstacleSearch::find_pairs(const ContactNodes &nodes,
                             const ContactNodes::Field &x,
                             const unsigned int first_rigid,
                             const double reach,
                             const double travelled,
                             std::vector<ContactPair> &pairs)
  {
    const auto &shape = *body.parameters().shape;
    const Pose pose   = body.pose();
    const auto R      = pose.orientation.matrix();
    const auto centre = body.centre();
    for (auto &slave : slaves)
      {
        const double within = std::max(reach, always_near * slave.size);
        if (slave.clear_of - travelled > within)
          continue;
        ContactPair pair;
        pair.interface   = interface;
        pair.slave       = slave.node;
        pair.slave_id    = nodes.id_of_local(slave.node);
        pair.nodes[0]    = nodes.number(pair.slave_id);
        pair.weights[0]  = 1.;
        pair.size        = slave.size;
        pair.stiffness   = slave.stiffness;
        pair.place       = x[pair.nodes[0]];
        const auto place = transpose(R) * (pair.place - pose.place);
        parts.clear();
        shape.nearby(place, within, parts);
        if (parts.empty())
          {
            slave.clear_of = travelled + std::max(within, shape.closest(place).distance);
            continue;
          }
        if (body.moves())
          {
            add_body(pair, first_rigid, -1.);
            add_rotation(pair, first_rigid + 1, -1., pair.place - centre);
          }
        for (const auto &part : parts)
          {
            pair.slot   = &part - parts.data();
            pair.gap    = part.distance;
            pair.normal = R * part.normal;
            set_plane(pair, pose, pair.place);
            pairs.push_back(pair);
          }
      }
  }


  RigidTouch::RigidTouch(const std::vector<RigidBody> &bodies,
                         const std::pair<unsigned int, unsigned int> &pair,
                         const unsigned int interface,
                         const unsigned int number)
    : bodies(bodies)
    , first(pair.first)
    , second(pair.second)
    , interface(interface)
    , number(number)
    , size(std::min(bodies[first].parameters().shape->radius(),
                    bodies[second].parameters().shape->radius()))
  {
  }


  // Features of the first body against the second, or the other way round.
  std::vector<TouchPoint>
  RigidTouch::touch_points(const bool reversed,
                           const Pose &of_first,
                           const Pose &of_second,
                           const double within) const
  {
    const auto &shape      = *bodies[reversed ? second : first].parameters().shape;
    const auto &other      = *bodies[reversed ? first : second].parameters().shape;
    const Pose &pose       = reversed ? of_second : of_first,
               &other_pose = reversed ? of_first : of_second;
    const auto R           = pose.orientation.matrix();
    std::vector<TouchPoint> points;
    shape.touch_points(
      [&](const Tensor<1, 3> &X) {
        auto point   = closest_in_space(other, other_pose, pose.place + R * X);
        point.normal = transpose(R) * point.normal;
        return point;
      },
      within,
      points);
    return points;
  }


  void
  RigidTouch::find_pairs(const ContactNodes &nodes,
                         const RigidNodes &rigid_nodes,
                         const bool reversed,
                         const double reach,
                         std::vector<ContactPair> &pairs) const
  {
    if (Utilities::MPI::this_mpi_process(nodes.get_communicator()) != 0)
      return;
    const double within    = std::max(reach, always_near * size);
    const unsigned int own = reversed ? second : first, other = reversed ? first : second;
    const Pose pose = bodies[own].pose();
    const auto R    = pose.orientation.matrix();
    for (const auto &point :
         touch_points(reversed, bodies[first].pose(), bodies[second].pose(), within))
      {
        ContactPair pair;
        pair.interface = interface;
        pair.reversed  = reversed;
        pair.slave     = numbers::invalid_unsigned_int;
        pair.slave_id  = first_touch_id + ContactNodes::Id(number) * features_per_touch +
                        point.feature;
        pair.size    = size;
        pair.gap     = point.other.distance;
        pair.normal  = R * point.other.normal;
        pair.place   = pose.place + R * point.x - point.radius * pair.normal;
        pair.n_nodes = 0;
        for (const unsigned int body : {own, other})
          if (bodies[body].moves())
            add_body(pair, nodes.first_common() + rigid_nodes.first[body], body == own ? 1. : -1.);
        for (const unsigned int body : {own, other})
          if (bodies[body].moves())
            add_rotation(pair,
                         nodes.first_common() + rigid_nodes.first[body] + 1,
                         body == own ? 1. : -1.,
                         pair.place - bodies[body].centre());
        set_plane(pair, bodies[other].pose(), pair.place);
        pairs.push_back(pair);
      }
  }


  bool
  RigidTouch::gap_at(const ContactPair &pair, const std::vector<Pose> &poses, double &gap) const
  {
    const auto points        = touch_points(pair.reversed,
                                     poses[first],
                                     poses[second],
                                     std::numeric_limits<double>::max());
    const auto feature       = (pair.slave_id - first_touch_id) % features_per_touch;
    const unsigned int other = pair.reversed ? first : second;
    const unsigned int own   = pair.reversed ? second : first;
    const auto R             = poses[own].orientation.matrix();
    for (const auto &point : points)
      if (point.feature == feature &&
          (R * point.other.normal) * (poses[other].orientation.matrix() * pair.plane_normal) > 0.9)
        {
          gap = point.other.distance;
          return true;
        }
    return false;
  }
} // namespace akmon
