#include <akmon/contact/bonds/bonds.h>
#include <akmon/contact/contact.h>
#include <akmon/contact/coupled/coupled_solver.h>
#include <akmon/output/history.h>
#include <akmon/parameters.h>

#include <deal.II/base/mpi.h>

#include <algorithm>

// What Contact tells about itself: report, names, faces, initial overlap.

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // Of the cell size: what rounding of coordinates in a mesh file may do.
    constexpr double rounding_of_places = 1e-6;


    // Where the force acts: at the slave node, if it is a node's.
    Tensor<1, 3>
    place_of(const ContactPair &pair, const NodalState &state)
    {
      return pair.of_node() ? at_node(state.x, pair.slave) : pair.place;
    }
  } // namespace


  ContactReport
  Contact::report(const NodalState &state) const
  {
    ContactReport report;
    report.iterations = coupled->iterations();
    report.converged  = coupled->converged();
    report.residual   = coupled->residual();
    report.interfaces.resize(contacts.size() + bodies.size());
    for (const auto &pair : pairs)
      {
        const bool rigid                   = !pair.has_slave_node();
        auto &interface                    = report.interfaces[pair.interface];
        const double depth                 = pair.entered ? 0. : pair.depth;
        const double relative              = depth / pair.size;
        report.max_penetration             = std::max(report.max_penetration, depth);
        interface.max_penetration          = std::max(interface.max_penetration, depth);
        interface.max_penetration_relative = std::max(interface.max_penetration_relative, relative);
        if (relative > report.max_penetration_relative)
          {
            report.max_penetration_relative = relative;
            report.place                    = Point<3>(place_of(pair, state));
            report.deepest                  = pair.slave;
          }
        if (relative > report.driven_penetration && is_driven(pair))
          report.driven_penetration = relative;
        if (!(pair.normal_force > 0.))
          continue;
        ++report.active_pairs;
        report.sticking_pairs += pair.sticks;
        ++(pair.sticks ? interface.sticking_pairs : interface.slipping_pairs);
        // On what an obstacle touches; where two rigid bodies do, the pair's force is on the first.
        const double sign   = pair.reversed != rigid ? -1. : 1.;
        const auto normal   = sign * pair.normal_force * pair.normal;
        const auto friction = sign * pair.tangential_force;
        interface.normal_force += normal;
        interface.friction_force += friction;
        interface.moment += cross_product_3d(place_of(pair, state), normal + friction);
      }
    if (Utilities::MPI::this_mpi_process(discretization.communicator()) == 0) // all know the bonds
      for (unsigned int i = 0; i < contacts.size(); ++i)
        {
          const auto load = bonds->load_on(i);
          report.interfaces[i].normal_force += load.normal;
          report.interfaces[i].friction_force += load.tangential;
          report.interfaces[i].moment += load.moment;
        }
    return report;
  }


  // Whether a pair is inside because its bodies move as prescribed.
  bool
  Contact::is_driven(const ContactPair &pair) const
  {
    return pair.gap < -rounding_of_places * pair.size && mobility.is_held_along(pair, pair.normal);
  }


  // The bodies of a pair: those of its first and its last node, or an obstacle.
  std::string
  Contact::sides_of(const ContactPair &pair, const ContactNodes::Field &body_of_node) const
  {
    std::string first, last;
    for (unsigned int k = 0; k < pair.n_points(); ++k)
      if (pair.nodes[k] < nodes.first_common())
        {
          const auto body = static_cast<unsigned int>(body_of_node[pair.nodes[k]][0]);
          last            = "'" + discretization.get_bodies()[body].name + "'";
          first           = first.empty() ? last : first;
        }
    if (pair.interface >= contacts.size())
      return "body " + first + " and obstacle '" + law_of(pair).name +
             "' are driven into each other";
    return first == last ? "body " + first + " is driven into itself" :
                           "bodies " + first + " and " + last + " are driven into each other";
  }


  std::string
  Contact::driven_bodies(const NodalState &state) const
  {
    NodalVector bodies_of_nodes = discretization.make_vector();
    for (unsigned int node = 0; node < discretization.n_owned_nodes; ++node)
      bodies_of_nodes.local_element(3 * node) = discretization.body_of_node[node];
    ContactNodes::Field body_of_node;
    nodes.gather(bodies_of_nodes, body_of_node);

    const ContactPair *deepest = nullptr;
    double relative            = 0.;
    for (const auto &pair : pairs)
      if (-pair.gap > relative * pair.size && is_driven(pair))
        {
          deepest  = &pair;
          relative = -pair.gap / pair.size;
        }
    const double largest = Utilities::MPI::max(relative, discretization.communicator());
    std::string text;
    if (deepest && relative == largest)
      text = sides_of(*deepest, body_of_node) + ": both move as prescribed at " +
             place_text(place_of(*deepest, state)) +
             ", where no contact force keeps them apart; there they penetrate by " +
             rounded_text(relative) + " of the cell size";
    for (const auto &of_rank : Utilities::MPI::all_gather(discretization.communicator(), text))
      if (!of_rank.empty())
        return of_rank;
    return "";
  }


  std::vector<Contact::Patch>
  Contact::patches(const NodalState &state) const
  {
    std::vector<Patch> result(contacts.size() + bodies.size());
    for (const auto &pair : pairs)
      if (pair.normal_force > 0. && pair.of_node())
        {
          const bool both_sides = solver.type != ContactSolver::Type::decoupled &&
                                  pair.kind == ContactPair::Kind::node_to_face &&
                                  contacts[pair.interface].symmetric;
          result[pair.interface].area += (both_sides ? 0.5 : 1.) *
                                         areas.facing(state.x, pair.slave, pair.normal);
        }
    for (const auto &force : forces)
      {
        double &largest = result[force.interface].max_pressure;
        largest         = std::max(largest, areas.pressure(state.x, force.node, force.normal));
      }
    return result;
  }


  std::vector<std::string>
  Contact::names() const
  {
    std::vector<std::string> result;
    for (const auto &contact : contacts)
      result.push_back(contact.name);
    for (const auto &body : bodies)
      result.push_back(body.parameters().name);
    return result;
  }


  std::vector<BoundaryFace>
  Contact::contact_faces() const
  {
    std::vector<BoundaryFace> faces;
    for (const auto &search : searches)
      faces.insert(faces.end(), search.surface_faces().begin(), search.surface_faces().end());
    for (const auto &search : obstacle_searches)
      faces.insert(faces.end(), search.surface_faces().begin(), search.surface_faces().end());
    std::sort(faces.begin(), faces.end(), [](const auto &a, const auto &b) { return a.id < b.id; });
    faces.erase(std::unique(faces.begin(),
                            faces.end(),
                            [](const auto &a, const auto &b) { return a.id == b.id; }),
                faces.end());
    return faces;
  }


  void
  Contact::refuse_initial_overlap(const NodalState &state) const
  {
    // What rounding of places may do is tolerated, and released slowly.
    const ContactPair *deepest = nullptr;
    for (const auto &pair : pairs)
      if (pair.gap < -rounding_of_places * pair.size && (!deepest || pair.gap < deepest->gap) &&
          !bonds->hold(pair))
        deepest = &pair;
    std::string message;
    if (deepest)
      {
        const bool rigid = !deepest->has_slave_node();
        message          = "[" +
                  std::string(deepest->interface < contacts.size() ? "Contact/" : "Obstacles/") +
                  law_of(*deepest).name + "] " +
                  (rigid ?
                     "it" :
                     "body '" +
                       discretization.get_bodies()[discretization.body_of_node[deepest->slave]]
                         .name +
                       "'") +
                  " starts inside its partner, " + rounded_text(-deepest->gap) + " deep at " +
                  place_text(place_of(*deepest, state)) + "; move the bodies apart";
      }
    for (const auto &of_rank : Utilities::MPI::all_gather(discretization.communicator(), message))
      if (!of_rank.empty())
        throw InputError(of_rank);
  }
} // namespace akmon
