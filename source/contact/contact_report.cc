#include <akmon/contact/contact.h>
#include <akmon/output/history.h>
#include <akmon/parameters.h>

#include <deal.II/base/mpi.h>

#include <algorithm>

// What Contact tells about itself: report, names, faces, initial overlap.

namespace akmon
{
  using namespace dealii;

  ContactReport
  Contact::report(const NodalState &state) const
  {
    ContactReport report;
    report.iterations = coupled.iterations();
    report.converged  = coupled.converged();
    report.residual   = coupled.residual();
    report.forces.resize(contacts.size() + bodies.size());
    for (const auto &pair : pairs)
      {
        report.max_penetration = std::max(report.max_penetration, -pair.gap);
        if (-pair.gap / pair.size > report.max_penetration_relative)
          {
            report.max_penetration_relative = -pair.gap / pair.size;
            report.place                    = Point<3>(pair.slave == numbers::invalid_unsigned_int ?
                                                         pair.place :
                                                         at_node(state.x, pair.slave));
            report.deepest                  = pair.slave;
          }
        report.active_pairs += pair.normal_force > 0.;
        report.sticking_pairs += pair.normal_force > 0. && pair.sticks;
        const auto force = pair.normal_force * pair.normal + pair.tangential_force;
        // Of an obstacle, on what it touches.
        const bool own = pair.slave == numbers::invalid_unsigned_int;
        report.forces[pair.interface] += pair.reversed != own ? -force : force;
      }
    return report;
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
      if (pair.gap < -tolerated * pair.size && (!deepest || pair.gap < deepest->gap))
        deepest = &pair;
    std::string message;
    if (deepest)
      {
        const bool rigid = deepest->slave == numbers::invalid_unsigned_int;
        const auto place = rigid ? deepest->place : at_node(state.x, deepest->slave);
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
