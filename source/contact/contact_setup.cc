#include <akmon/contact/contact.h>
#include <akmon/parameters.h>

#include <algorithm>
#include <map>

// How Contact is made from its parameters.

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // Least edge at each owned node of some faces, by local node number.
    std::vector<std::pair<unsigned int, double>>
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
      return {sizes.begin(), sizes.end()};
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
          const bool coupled   = solver.type == ContactSolver::Type::coupled;
          const bool symmetric = coupled && contact.symmetric;
          searches.emplace_back(discretization, contact, i, searches.size(), false, coupled);
          if (symmetric && contact.slaves != contact.masters)
            searches.emplace_back(discretization, contact, i, searches.size(), true, coupled);
        }
      return searches;
    }


    std::vector<std::vector<BoundaryFace>>
    faces_of_planes(const Discretization &discretization, const std::vector<RigidPlane> &planes)
    {
      std::vector<std::vector<BoundaryFace>> faces;
      for (const auto &plane : planes)
        {
          std::set<types::boundary_id> ids;
          for (const auto &surface : plane.slaves)
            ids.merge(discretization.boundary_ids("Obstacles/" + plane.name, "Surfaces", surface));
          faces.push_back(discretization.faces_on(ids));
        }
      return faces;
    }


    std::vector<unsigned int>
    owned_nodes(const Discretization &discretization,
                const std::vector<SurfaceSearch> &searches,
                const std::vector<std::vector<BoundaryFace>> &plane_faces)
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
      for (const auto &faces : plane_faces)
        add(faces);
      std::sort(nodes.begin(), nodes.end());
      nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
      return nodes;
    }
  } // namespace


  Contact::Contact(const Discretization &discretization,
                   const ContactSolver &solver,
                   const std::vector<SurfaceContact> &contacts,
                   const std::vector<RigidPlane> &planes,
                   const EssentialConditions &conditions)
    : discretization(discretization)
    , solver(solver)
    , contacts(contacts)
    , planes(planes)
    , searches(make_searches(discretization, solver, contacts))
    , plane_faces(faces_of_planes(discretization, planes))
    , surface_nodes(owned_nodes(discretization, searches, plane_faces))
    , nodes(discretization, surface_nodes)
    , mobility(discretization, conditions)
    , coupled(solver, nodes, mobility)
  {
    for (const auto &faces : plane_faces)
      plane_slaves.push_back(node_sizes(discretization, faces));
    for (unsigned int i = 0; i < contacts.size() + planes.size(); ++i)
      {
        const bool is_contact = i < contacts.size();
        const ContactLaw &law = is_contact ? static_cast<const ContactLaw &>(contacts[i]) :
                                             planes[i - contacts.size()];
        if (solver.type == ContactSolver::Type::coupled && law.stick == ContactLaw::Stick::central)
          throw InputError((is_contact ? "Contact/" : "Obstacles/") + law.name,
                           "Stick",
                           "central",
                           "allowed with [Contact solver] Type = decoupled only");
      }
  }
} // namespace akmon
