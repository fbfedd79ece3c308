#include <akmon/contact/contact.h>
#include <akmon/contact/coupled/coupled_solver.h>
#include <akmon/contact/search/edge_search.h>
#include <akmon/contact/search/feature_search.h>
#include <akmon/contact/work_time.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>

// The coupled solution in rounds: what is not linear in the gaps that a step leads to.

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // Of the solver's tolerance: for the gaps that features of rigid bodies reach, and for what is
    // between them, where pairs that tell less would only repeat others.
    constexpr double of_features = 0.5, of_bulges = 4.;
  } // namespace


  // Forces, and again while the gaps that they lead to are not what the linear constraints promise,
  // or rigid bodies touch, or their edges are in faces, where there is no pair.
  void
  Contact::solve_coupled(const NodalState &state)
  {
    constexpr unsigned int most_rounds = 40;
    constexpr unsigned int unsettled   = 10; // rounds after which edges are followed all the same
    constexpr unsigned int until_refit = 6;
    constexpr unsigned int most_with_moves = 8; // of pairs of edges; later ones only join
    constexpr double touch_anew            = std::numeric_limits<double>::infinity();

    coupled->solve();
    if (searches.empty() && bodies.empty())
      return;
    const bool has_edges = !feature_searches.empty() ||
                           std::any_of(edge_searches.begin(),
                                       edge_searches.end(),
                                       [](const auto &search) { return search.may_miss_dips(); });
    for (unsigned int round = 1; round < most_rounds; ++round)
      {
        const auto poses             = reach();
        auto joining                 = follow_touches(poses);
        const double here            = std::max(follow_partners(state, poses, round),
                                     joining.empty() ? 0. : touch_anew);
        const double on_this_rank[2] = {here, may_be_entered() ? 1. : 0.};
        double on_all[2];
        Utilities::MPI::max(on_this_rank, discretization.communicator(), on_all);
        double excess = on_all[0];
        if ((excess <= 1. || round % unsettled == 0) && (has_edges || on_all[1] > 0.))
          {
            const bool any = follow_bulges(poses, round <= most_with_moves, joining);
            excess = Utilities::MPI::max(any ? touch_anew : excess, discretization.communicator());
          }
        if (excess <= 1.)
          return;
        if (round % until_refit == 0 && excess != touch_anew && refit_pairs())
          excess = touch_anew;
        if (!joining.empty())
          {
            for (auto &pair : joining)
              pair.depth = std::max(0., -pair.gap);
            pairs.insert(pairs.end(), joining.begin(), joining.end());
            std::sort(pairs.begin(), pairs.end(), by_key);
          }
        set_target_gaps(state);
        if (excess == touch_anew)
          coupled->take_up_anew(pairs, friction_of_pairs(state));
        coupled->solve();
      }
  }


  // Whether the step may lead a slave into a body that it has no pair with.
  bool
  Contact::may_be_entered() const
  {
    return std::any_of(searches.begin(),
                       searches.end(),
                       [](const auto &search) { return search.watches_slaves(); }) ||
           std::any_of(pairs.begin(), pairs.end(), [](const auto &pair) {
             return pair.may_enter();
           });
  }


  // Take the increments that the last solution leads to, and the nodes there; where the bodies are.
  std::vector<Pose>
  Contact::reach()
  {
    const auto &dx_contact = coupled->increments();
    x_reached              = x;
    dx_reached             = dx_free;
    for (unsigned int i = 0; i < nodes.size(); ++i)
      {
        dx_reached.add(i, dx_contact[i]);
        x_reached.add(i, dx_reached[i]);
      }
    return reached_poses(&dx_contact);
  }


  // Pairs for points where rigid bodies are in each other without one.
  std::vector<ContactPair>
  Contact::follow_touches(const std::vector<Pose> &poses)
  {
    if (rigid_touches.empty())
      return {};
    std::vector<std::vector<ContactPair *>> of_touch(rigid_touches.size());
    for (auto &pair : pairs)
      if (pair.kind == ContactPair::Kind::rigid_touch)
        of_touch[pair.search].push_back(&pair);
    std::vector<ContactPair> joining;
    if (Utilities::MPI::this_mpi_process(discretization.communicator()) == 0)
      for (unsigned int i = 0; i < rigid_touches.size(); ++i)
        for (const auto &uncovered : rigid_touches[i].follow(poses, of_touch[i]))
          joining.push_back(
            rigid_touches[i].join(uncovered, poses, nodes, rigid_nodes, dx_reached));
    return joining;
  }


  // Pairs for what edges are in faces deeper than the settled pairs tell. Whether there are any, or
  // some have moved.
  bool
  Contact::follow_bulges(const std::vector<Pose> &poses,
                         const bool may_move,
                         std::vector<ContactPair> &joining)
  {
    const std::size_t before = joining.size();
    bool any                 = false;
    for (unsigned int i = 0; i < bodies.size(); ++i)
      {
        const unsigned int first = nodes.first_common() + rigid_nodes.first[i];
        any                      = feature_searches[i].join_bulges({x, dx, first, 0.},
                                              {x_reached, dx_reached, first, 0.},
                                              poses[i],
                                              of_bulges * solver.tolerance,
                                              may_move,
                                              pairs,
                                              joining) ||
              any;
      }
    for (const auto &search : edge_searches)
      search.join_dips(x, x_reached, dx_reached, pairs, joining);
    for (const auto &search : searches)
      search.join_entering(x, x_reached, dx_reached, pairs, joining);
    return any || joining.size() > before;
  }


  // Where the bodies are at the next level, after contact forces that cause a response.
  std::vector<Pose>
  Contact::reached_poses(const ContactNodes::Field *response) const
  {
    std::vector<Pose> poses;
    for (unsigned int i = 0; i < bodies.size(); ++i)
      {
        RigidIncrement increment;
        if (bodies[i].moves() && response)
          {
            const unsigned int first = nodes.first_common() + rigid_nodes.first[i];
            increment                = {(*response)[first], (*response)[first + 1]};
          }
        poses.push_back(bodies[i].next_pose(increment));
      }
    return poses;
  }


  // Where gaps do not settle because segments turn far in a step, the constraints are those of the
  // configuration that the last solution leads to: its gradients are right there, so that rounds
  // converge as Newton's method does. Whether there were any, on any rank.
  bool
  Contact::refit_pairs()
  {
    int n_refitted = 0;
    for (ContactPair *const pair : unsettled)
      n_refitted += searches[pair->search].refit(x, x_reached, dx_reached, *pair);
    return Utilities::MPI::max(n_refitted, discretization.communicator()) > 0;
  }


  // The gap of a pair in the configuration x_reached; false if it has no partner there.
  bool
  Contact::reached_gap(ContactPair &pair, const std::vector<Pose> &poses, double &gap) const
  {
    const unsigned int body = pair.interface - contacts.size(); // of an obstacle's pair
    switch (pair.kind)
      {
        case ContactPair::Kind::node_to_face:
          return pair.n_nodes > 1 && searches[pair.search].gap_at(x_reached, pair, gap);
        case ContactPair::Kind::node_to_shape:
          gap = obstacle_gap(*bodies[body].parameters().shape,
                             poses[body],
                             pair,
                             x_reached[pair.nodes[0]]);
          return true;
        case ContactPair::Kind::rigid_touch:
          gap = pair.reached_gap; // of follow_touches()
          return true;
        case ContactPair::Kind::rigid_feature:
          return feature_searches[body].gap_at(x_reached, poses[body], pair, gap);
        case ContactPair::Kind::edges:
        case ContactPair::Kind::dip:
          return edge_searches[pair.search].gap_at(x_reached, pair, gap);
      }
    return false;
  }


  // The curvature that a solution has found is what the next one counts on, and what further
  // rounds would add to it: the secant through this round and the one before tells how much of a
  // change comes back. Where it comes back with the other sign less of it is more: rounds would
  // overshoot, or close and open the pair in turns. Where most of it comes back, others may have
  // their part in it, unless it is the same part round by round.
  void
  Contact::count_on(ContactPair &pair, const double curvature)
  {
    constexpr double largest_return = 0.5;  // beyond, it is not the pair's own motion that counts
    constexpr double least_return   = -20.; // the same
    constexpr double slowest_return = 0.99, steady = 0.05;

    const double change  = curvature - pair.curvature;
    const double returns = pair.correction != 0. ? 1. + (change - pair.change) / pair.correction :
                                                   0.;
    pair.change          = change;
    const bool is_steady = returns < slowest_return && std::abs(returns - pair.returns) < steady;
    const bool is_own    = (returns < largest_return || is_steady) && returns > least_return;
    pair.returns         = returns;
    pair.correction      = is_own ? change / (1. - returns) : change;
    pair.curvature += pair.correction;
  }


  // Up to which the gaps that a step reaches are to be right, over the cell size. Rigid shapes are
  // exact, and so are gaps from them, but no better than forces are known, and late in a step not
  // at sharp edges, where the closest face changes; normals of edges turn fast. Late in a step dips
  // that move on along an edge need not be as good.
  double
  Contact::gap_tolerance(const ContactPair &pair, const bool late) const
  {
    constexpr double of_faces = 1e-7, of_edges = 1e-10, of_dips = 5e-10, of_rigid = 1e-12,
                     of_kinks = 1e-10, of_touches = 1e-11;

    switch (pair.kind)
      {
        case ContactPair::Kind::node_to_face:
          return of_faces;
        case ContactPair::Kind::node_to_shape:
          return std::max(2. * coupled->residual(), late ? of_kinks : of_rigid);
        case ContactPair::Kind::rigid_touch:
          return of_touches;
        case ContactPair::Kind::rigid_feature:
          return std::max(2. * coupled->residual(), of_features * solver.tolerance);
        case ContactPair::Kind::edges:
          return of_edges;
        case ContactPair::Kind::dip:
          return late ? of_dips : of_edges;
      }
    return of_faces;
  }


  void
  Contact::prefetch(const ContactPair &pair) const
  {
    if (pair.kind == ContactPair::Kind::node_to_face)
      searches[pair.search].prefetch(pair);
  }


  // While segments turn under a slave, surfaces are curved or bodies rotate, n . G dx + g misses a
  // part of second order of the gap that the step reaches. Measures it for all pairs that may
  // close, or for those that the last solution has moved otherwise than the one before; returns how
  // far it is from what the solution counted on, over what is allowed.
  double
  Contact::follow_partners(const NodalState &state,
                           const std::vector<Pose> &poses,
                           const unsigned int round)
  {
    constexpr double least_of_features = 0.1; // and of rims
    constexpr unsigned int many_rounds = 20;  // what closed and opened in turns only closes then

    const WorkTime timing(seconds_of_work);
    const auto &dx_contact = coupled->increments();
    const auto moves_anew  = [&](const ContactPair &pair) {
      return !pair.settled || pair.wanders ||
             std::any_of(pair.nodes.begin(),
                         pair.nodes.begin() + pair.n_nodes,
                         [&](const auto node) { return dx_contact[node] != dx_followed[node]; });
    };

    double largest = 0.;
    unsettled.clear();
    const auto &visited = coupled->participants();
    for (std::size_t i = 0; i < visited.size(); ++i)
      {
        ContactPair *const pair = visited[i];
        if (i + SurfaceSearch::prefetched < visited.size())
          prefetch(*visited[i + SurfaceSearch::prefetched]);
        if (round > 1 && !moves_anew(*pair))
          continue;
        const auto motion = pair->relative(dx_reached);
        // Whatever is beyond is another partner. Bulges may be highest far from where they were.
        const bool may_be_far = pair->kind == ContactPair::Kind::rigid_feature ||
                                pair->kind == ContactPair::Kind::rigid_touch ||
                                pair->kind == ContactPair::Kind::dip;
        const double bound   = std::max(0.5 * motion.norm(),
                                      may_be_far ? least_of_features * pair->size : 0.);
        const double linear  = pair->gap + pair->normal * motion;
        const double allowed = least_gap(*pair, state);
        double reached;
        const bool stays_open = pair->normal_force == 0. && linear - bound >= allowed;
        pair->lost            = !stays_open && !reached_gap(*pair, poses, reached);
        if (stays_open || pair->lost)
          continue;
        const double curvature = std::clamp(reached - linear, -bound, bound);
        const bool late        = round > many_rounds;
        const bool only_closes = pair->kind != ContactPair::Kind::node_to_face && late;
        const double change    = curvature - pair->curvature;
        const double excess    = (only_closes ? std::max(0., -change) : std::abs(change)) /
                              (pair->size * gap_tolerance(*pair, late));
        if (pair->normal_force > 0. || linear + curvature < allowed)
          {
            largest = std::max(largest, excess);
            if (excess > 1. && pair->kind == ContactPair::Kind::node_to_face)
              unsettled.push_back(pair);
          }
        pair->settled = excess <= 1.;
        if (!pair->settled && only_closes && pair->kind != ContactPair::Kind::rigid_feature)
          pair->curvature = curvature;
        else if (!pair->settled)
          count_on(*pair, curvature);
      }
    dx_followed = dx_contact;
    return largest;
  }
} // namespace akmon
