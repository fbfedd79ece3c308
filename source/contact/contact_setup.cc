#include <akmon/contact/bonds/bonds.h>
#include <akmon/contact/contact.h>
#include <akmon/contact/coupled/coupled_solver.h>
#include <akmon/contact/search/edge_search.h>
#include <akmon/contact/search/feature_search.h>
#include <akmon/parameters.h>

#include <algorithm>
#include <set>
#include <utility>

// How Contact is made from its parameters.

namespace akmon
{
  using namespace dealii;

  namespace
  {
    std::vector<double>
    wave_speeds_of_bodies(const Discretization &discretization)
    {
      std::vector<double> speeds;
      for (unsigned int body = 0; body < discretization.get_bodies().size(); ++body)
        speeds.push_back(discretization.material_of(body).dilatational_wave_speed());
      return speeds;
    }


    std::vector<SurfaceSearch>
    make_searches(const Discretization &discretization,
                  const ContactSolver &solver,
                  const std::vector<SurfaceContact> &contacts)
    {
      std::vector<SurfaceSearch> searches;
      for (unsigned int i = 0; i < contacts.size(); ++i)
        {
          const auto &contact  = contacts[i];
          const bool levers    = solver.type != ContactSolver::Type::decoupled;
          const bool symmetric = levers && contact.symmetric;
          searches.emplace_back(discretization, contact, i, searches.size(), false, levers);
          if (symmetric && !is_one_surface(discretization, contact))
            searches.emplace_back(discretization, contact, i, searches.size(), true, levers);
        }
      return searches;
    }


    // One for every contact, in their order; none with the decoupled solver, which takes pairs that
    // share nodes for each other's strangers.
    std::vector<EdgeSearch>
    make_edge_searches(const Discretization &discretization,
                       const ContactSolver &solver,
                       const std::vector<SurfaceContact> &contacts,
                       const std::vector<SurfaceSearch> &searches)
    {
      std::vector<EdgeSearch> edge_searches;
      if (solver.type != ContactSolver::Type::decoupled)
        for (const auto &search : searches)
          if (search.get_interface() == edge_searches.size())
            edge_searches.emplace_back(discretization,
                                       contacts[edge_searches.size()],
                                       search,
                                       edge_searches.size());
      return edge_searches;
    }


    std::vector<ObstacleSearch>
    make_obstacle_searches(const Discretization &discretization,
                           const std::vector<RigidBody> &bodies,
                           const unsigned int first_interface)
    {
      std::vector<ObstacleSearch> searches;
      for (unsigned int i = 0; i < bodies.size(); ++i)
        searches.emplace_back(discretization, bodies[i], first_interface + i);
      return searches;
    }


    // One for every body; none with the decoupled solver.
    std::vector<FeatureSearch>
    make_feature_searches(const Discretization &discretization,
                          const ContactSolver &solver,
                          const std::vector<RigidBody> &bodies,
                          const std::vector<ObstacleSearch> &obstacle_searches,
                          const unsigned int first_interface)
    {
      std::vector<FeatureSearch> searches;
      if (solver.type != ContactSolver::Type::decoupled)
        for (unsigned int i = 0; i < bodies.size(); ++i)
          searches.emplace_back(discretization,
                                bodies[i],
                                obstacle_searches[i].surface_faces(),
                                first_interface + i);
      return searches;
    }


    // Bodies that name each other as obstacles, each two once.
    std::vector<RigidTouch>
    make_rigid_touches(const std::vector<RigidBody> &bodies, const unsigned int first_interface)
    {
      std::vector<RigidTouch> touches;
      std::set<std::pair<unsigned int, unsigned int>> known;
      for (unsigned int i = 0; i < bodies.size(); ++i)
        for (const auto &name : bodies[i].parameters().obstacles)
          {
            unsigned int j = 0;
            while (j < bodies.size() && bodies[j].parameters().name != name)
              ++j;
            const std::string section = "Obstacles/" + bodies[i].parameters().name;
            if (j == bodies.size() || j == i)
              throw InputError(section,
                               "Obstacles",
                               name,
                               "allowed are names of other obstacles (the Names of [Obstacles])");
            if (!bodies[i].is_free() && !bodies[j].is_free())
              throw InputError(section, "Obstacles", name, "one of the two must be free to move");
            if (known.insert({std::min(i, j), std::max(i, j)}).second)
              touches.emplace_back(bodies,
                                   std::make_pair(i, j),
                                   first_interface + i,
                                   touches.size());
          }
      return touches;
    }


    std::vector<unsigned int>
    owned_nodes(const Discretization &discretization,
                const std::vector<SurfaceSearch> &searches,
                const std::vector<ObstacleSearch> &obstacle_searches)
    {
      std::vector<unsigned int> nodes;
      const auto add = [&](const std::vector<BoundaryFace> &faces) {
        for (const auto &face : faces)
          for (const unsigned int node : face.nodes)
            if (node < discretization.n_owned_nodes)
              nodes.push_back(node);
      };
      for (const auto &search : searches)
        add(search.surface_faces());
      for (const auto &search : obstacle_searches)
        add(search.surface_faces());
      std::sort(nodes.begin(), nodes.end());
      nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
      return nodes;
    }
  } // namespace


  Contact::Contact(const Discretization &discretization,
                   const ContactSolver &solver,
                   const std::vector<SurfaceContact> &contacts,
                   std::vector<RigidBody> &bodies,
                   const EssentialConditions &conditions)
    : discretization(discretization)
    , solver(solver)
    , contacts(contacts)
    , conditions(conditions)
    , bodies(bodies)
    , searches(make_searches(discretization, solver, contacts))
    , edge_searches(make_edge_searches(discretization, solver, contacts, searches))
    , obstacle_searches(make_obstacle_searches(discretization, bodies, contacts.size()))
    , feature_searches(
        make_feature_searches(discretization, solver, bodies, obstacle_searches, contacts.size()))
    , rigid_touches(make_rigid_touches(bodies, contacts.size()))
    , rigid_nodes(bodies)
    , wave_speeds(wave_speeds_of_bodies(discretization))
    , surface_nodes(owned_nodes(discretization, searches, obstacle_searches))
    , areas(discretization.n_owned_nodes, contact_faces())
    , nodes(discretization, surface_nodes, rigid_nodes.n)
    , bonds(std::make_unique<Bonds>(discretization, contacts, conditions))
    , coupled(std::make_unique<CoupledSolver>(solver, nodes, mobility, bonds.get()))
    , motions(discretization, surface_nodes)
  {
    bonds->set_numbers(nodes);
    if (solver.type == ContactSolver::Type::penalty && !rigid_touches.empty())
      throw InputError(
        "Contact solver",
        "Type",
        "penalty",
        "rigid bodies that meet have no bulk modulus for penalty springs; allowed are "
        "coupled and decoupled");
    for (unsigned int i = 0; i < contacts.size() + bodies.size(); ++i)
      {
        const bool is_contact = i < contacts.size();
        const ContactLaw &law = is_contact ? static_cast<const ContactLaw &>(contacts[i]) :
                                             bodies[i - contacts.size()].parameters();
        if (solver.type != ContactSolver::Type::decoupled &&
            law.stick == ContactLaw::Stick::central)
          throw InputError((is_contact ? "Contact/" : "Obstacles/") + law.name,
                           "Stick",
                           "central",
                           "allowed with [Contact solver] Type = decoupled only");
      }
  }


  Contact::~Contact() = default;
} // namespace akmon
