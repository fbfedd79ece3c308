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
        const double relative              = -pair.gap / pair.size;
        report.max_penetration             = std::max(report.max_penetration, -pair.gap);
        interface.max_penetration          = std::max(interface.max_penetration, -pair.gap);
        interface.max_penetration_relative = std::max(interface.max_penetration_relative, relative);
        if (relative > report.max_penetration_relative)
          {
            report.max_penetration_relative = relative;
            report.place                    = Point<3>(place_of(pair, state));
            report.deepest                  = pair.slave;
          }
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
    // What rounding of coordinates in a mesh file may do is tolerated, and released slowly.
    constexpr double tolerated = 1e-6;

    const ContactPair *deepest = nullptr;
    for (const auto &pair : pairs)
      if (pair.gap < -tolerated * pair.size && (!deepest || pair.gap < deepest->gap) &&
          !bonds->hold(pair))
        deepest = &pair;
    std::string message;
    if (deepest)
      {
        const bool rigid = !deepest->has_slave_node();
        const auto place = place_of(*deepest, state);
        message          = "[" +
                  std::string(deepest->interface < contacts.size() ? "Contact/" : "Obstacles/") +
                  law_of(*deepest).name + "] " +
                  (rigid ?
                     "it" :
                     "body '" +
                       discretization.get_bodies()[discretization.body_of_node[deepest->slave]]
                         .name +
                       "'") +
                  " starts inside its partner, " + shortest_text(-deepest->gap) + " deep at (" +
                  shortest_text(place[0]) + ", " + shortest_text(place[1]) + ", " +
                  shortest_text(place[2]) + "); move the bodies apart";
      }
    for (const auto &of_rank : Utilities::MPI::all_gather(discretization.communicator(), message))
      if (!of_rank.empty())
        throw InputError(of_rank);
  }
} // namespace akmon
