#include <akmon/contact/search/rigid_touch.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // Numbers of the points that join during a step come behind those found at its begin.
    constexpr unsigned int first_joined = 1024;

    // Normals that are as close as this (the cosine between them) are of the same part of a
    // surface.
    constexpr double same_normal = 0.9;
  } // namespace


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


  // The other shape from a point, both in the frame of the body that is looked at.
  SurfacePoint
  RigidTouch::View::other_from(const Tensor<1, 3> &X) const
  {
    auto point = other_shape.closest(transpose(other_R) * (pose.place + R * X - other_pose.place));
    point.normal = transpose(R) * (other_R * point.normal);
    return point;
  }


  std::vector<TouchPoint>
  RigidTouch::View::touch_points(const double within) const
  {
    std::vector<TouchPoint> points;
    if (other_from(Tensor<1, 3>()).distance <= within + shape.radius())
      shape.touch_points([&](const Tensor<1, 3> &X) { return other_from(X); }, within, points);
    return points;
  }


  RigidTouch::View
  RigidTouch::view(const bool reversed, const Pose &of_first, const Pose &of_second) const
  {
    const unsigned int own = reversed ? second : first, other = reversed ? first : second;
    const Pose &pose       = reversed ? of_second : of_first,
               &other_pose = reversed ? of_first : of_second;
    return {*bodies[own].parameters().shape,
            *bodies[other].parameters().shape,
            pose,
            other_pose,
            pose.orientation.matrix(),
            other_pose.orientation.matrix()};
  }


  RigidTouch::View
  RigidTouch::present_view(const bool reversed) const
  {
    return view(reversed, bodies[first].pose(), bodies[second].pose());
  }


  ContactPair
  RigidTouch::make_pair(const bool reversed,
                        const TouchPoint &point,
                        const View &here,
                        const ContactNodes &nodes,
                        const RigidNodes &rigid_nodes) const
  {
    const unsigned int own = reversed ? second : first, other = reversed ? first : second;
    ContactPair pair;
    pair.interface = interface;
    pair.kind      = ContactPair::Kind::rigid_touch;
    pair.reversed  = reversed;
    pair.slave     = numbers::invalid_unsigned_int;
    pair.slave_id  = number;
    pair.slot      = point.feature;
    pair.others    = {{point.number, 0, 0}};
    pair.search    = number;
    pair.size      = size;
    pair.gap       = point.other.distance;
    pair.normal    = here.R * point.other.normal;
    pair.place     = here.pose.place + here.R * point.x - point.radius * pair.normal;
    pair.n_nodes   = 0;
    for (const unsigned int body : {own, other})
      if (bodies[body].moves())
        pair.add_node(nodes.first_common() + rigid_nodes.first[body], body == own ? 1. : -1.);
    for (const unsigned int body : {own, other})
      if (bodies[body].moves())
        pair.add_rotation(nodes.first_common() + rigid_nodes.first[body] + 1,
                          body == own ? 1. : -1.,
                          pair.place - bodies[body].centre());
    set_plane(pair, here.other_pose, pair.place);
    return pair;
  }


  // Whether a point of one body and one of the other tell the same: where edges cross, or a rim
  // meets a side, both bodies' features find it.
  bool
  RigidTouch::is_same(const TouchPoint &point,
                      const View &view,
                      const TouchPoint &reversed_point,
                      const View &reversed_view) const
  {
    constexpr double same_place = 1e-5, same_direction = 1e-4; // of the size; radians

    const auto normal          = view.R * point.other.normal,
               reversed_normal = reversed_view.R * reversed_point.other.normal;
    if ((normal + reversed_normal).norm() > same_direction)
      return false;
    const auto foot = view.pose.place + view.R * point.x -
                      (point.radius + point.other.distance) * normal,
               place = reversed_view.pose.place + reversed_view.R * reversed_point.x -
                       reversed_point.radius * reversed_normal;
    return (foot - place).norm() <= same_place * size;
  }


  // Points of both bodies, those of the second one without what the first one's tell.
  std::array<std::vector<TouchPoint>, 2>
  RigidTouch::touch_points(const View &view, const View &reversed_view, const double within) const
  {
    std::array<std::vector<TouchPoint>, 2> points = {
      {view.touch_points(within), reversed_view.touch_points(within)}};
    auto &of_second = points[1];
    of_second.erase(std::remove_if(of_second.begin(),
                                   of_second.end(),
                                   [&](const TouchPoint &there) {
                                     return std::any_of(points[0].begin(),
                                                        points[0].end(),
                                                        [&](const TouchPoint &point) {
                                                          return is_same(point,
                                                                         view,
                                                                         there,
                                                                         reversed_view);
                                                        });
                                   }),
                    of_second.end());
    return points;
  }


  void
  RigidTouch::find_pairs(const ContactNodes &nodes,
                         const RigidNodes &rigid_nodes,
                         const bool reversed,
                         const double reach,
                         std::vector<ContactPair> &pairs)
  {
    if (Utilities::MPI::this_mpi_process(nodes.get_communicator()) != 0)
      return;
    if (!reversed)
      spots = touch_points(present_view(false),
                           present_view(true),
                           std::max(reach, always_near * size));
    const View here    = present_view(reversed);
    const auto &points = spots[reversed];
    for (unsigned int i = 0; i < points.size(); ++i)
      {
        pairs.push_back(make_pair(reversed, points[i], here, nodes, rigid_nodes));
        pairs.back().row = i;
      }
  }


  // Of the point of the body that the pair was found with; where the other body turns another side
  // to it, from the plane that the pair was found with.
  double
  RigidTouch::gap_of_spot(const ContactPair &pair, const View &there) const
  {
    TouchPoint spot = spots[pair.reversed][pair.row];
    spot.look([&](const Tensor<1, 3> &X) { return there.other_from(X); });
    const auto normal = there.other_R * pair.plane_normal;
    if ((there.R * spot.other.normal) * normal > same_normal)
      return spot.other.distance;
    const auto place = there.pose.place + there.R * spot.x - spot.radius * normal;
    return normal * (place - there.other_pose.place) - pair.plane_offset;
  }


  // From the point that a pair was found with: in the body or, as of what rolls, in space seen from
  // the body's frame. Infinite for points of other features or parts of the other surface.
  double
  RigidTouch::distance_of_spot(const ContactPair &pair,
                               const TouchPoint &point,
                               const View &here,
                               const View &there) const
  {
    const TouchPoint &spot = spots[pair.reversed][pair.row];
    if (spot.feature != point.feature ||
        (there.R * point.other.normal) * (there.other_R * pair.plane_normal) < same_normal)
      return std::numeric_limits<double>::infinity();
    return std::min((there.R * point.x - here.R * spot.x).norm(), (point.x - spot.x).norm());
  }


  // How far from the point that it was found with a pair tells of a closest point. Pairs leave room
  // between them: a point in their middle would be told by them in turns, round after round.
  double
  RigidTouch::range(const ContactPair &pair, const std::vector<ContactPair *> &pairs) const
  {
    constexpr double most = 0.25, least = 1e-3; // of the size
    constexpr double of_spacing = 0.4;

    double result      = most * size;
    const auto &points = spots[pair.reversed];
    const auto &spot   = points[pair.row];
    for (const ContactPair *const other : pairs)
      if (other != &pair && points[other->row].feature == spot.feature &&
          other->plane_normal * pair.plane_normal > same_normal)
        result = std::min(result, of_spacing * (points[other->row].x - spot.x).norm());
    return std::max(result, least * size);
  }


  // The pair that tells of a closest point, or none.
  ContactPair *
  RigidTouch::pair_next_to(const TouchPoint &point,
                           const std::vector<ContactPair *> &pairs,
                           const View &here,
                           const View &there) const
  {
    ContactPair *nearest = nullptr;
    double least         = std::numeric_limits<double>::infinity();
    for (ContactPair *const pair : pairs)
      {
        const double distance = distance_of_spot(*pair, point, here, there);
        if (distance < least && distance <= range(*pair, pairs))
          {
            least   = distance;
            nearest = pair;
          }
      }
    return nearest;
  }


  std::vector<RigidTouch::Uncovered>
  RigidTouch::follow(const std::vector<Pose> &poses, const std::vector<ContactPair *> &pairs) const
  {
    constexpr double tolerated = 1e-11; // of the size

    std::array<std::vector<ContactPair *>, 2> of_body;
    for (ContactPair *const pair : pairs)
      of_body[pair->reversed].push_back(pair);
    const std::array<View, 2> there = {
      {view(false, poses[first], poses[second]), view(true, poses[first], poses[second])}};
    const auto points = touch_points(there[0], there[1], always_near * size);
    std::vector<Uncovered> uncovered;
    for (const bool reversed : {false, true})
      {
        const View here = present_view(reversed);
        for (ContactPair *const pair : of_body[reversed])
          pair->reached_gap = gap_of_spot(*pair, there[reversed]);
        for (const auto &point : points[reversed])
          if (!point.least)
            continue;
          else if (ContactPair *const pair = pair_next_to(point,
                                                          of_body[reversed],
                                                          here,
                                                          there[reversed]))
            pair->reached_gap = std::min(pair->reached_gap, point.other.distance);
          else if (point.other.distance < -tolerated * size)
            uncovered.push_back({reversed, point});
      }
    return uncovered;
  }


  // The place is that of the point before the step, where it may face another side of the other
  // body than behind it: then the side behind it counts.
  ContactPair
  RigidTouch::join(const Uncovered &uncovered,
                   const std::vector<Pose> &poses,
                   const ContactNodes &nodes,
                   const RigidNodes &rigid_nodes,
                   const ContactNodes::Field &dx)
  {
    const bool reversed = uncovered.reversed;
    const View here = present_view(reversed), there = view(reversed, poses[first], poses[second]);
    TouchPoint spot = uncovered.point;
    spot.look([&](const Tensor<1, 3> &X) { return here.other_from(X); });
    const double reached = uncovered.point.other.distance;
    const auto normal    = transpose(here.R) * here.other_R * transpose(there.other_R) * there.R *
                        uncovered.point.other.normal;
    const bool same_side = spot.other.normal * normal > same_normal;
    if (!same_side)
      spot.other = {0., normal};
    spot.number      = first_joined + spots[reversed].size();
    ContactPair pair = make_pair(reversed, spot, here, nodes, rigid_nodes);
    if (!same_side)
      {
        pair.gap = std::max(0., reached - pair.normal * pair.relative(dx));
        set_plane(pair, here.other_pose, pair.place);
      }
    pair.row         = spots[reversed].size();
    pair.curvature   = reached - (pair.gap + pair.normal * pair.relative(dx));
    pair.reached_gap = reached;
    spots[reversed].push_back(spot);
    return pair;
  }
} // namespace akmon
