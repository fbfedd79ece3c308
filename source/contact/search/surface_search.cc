#include <akmon/contact/penalty.h>
#include <akmon/contact/search/face_geometry.h>
#include <akmon/contact/search/surface_search.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    std::set<types::boundary_id>
    slave_ids(const Discretization &discretization, const SurfaceContact &contact)
    {
      return discretization.boundary_ids("Contact/" + contact.name, "Slave", contact.slaves);
    }


    std::set<types::boundary_id>
    master_ids(const Discretization &discretization, const SurfaceContact &contact)
    {
      return discretization.boundary_ids("Contact/" + contact.name, "Master", contact.masters);
    }


    double
    face_size(const Discretization &discretization, const BoundaryFace &face)
    {
      return std::sqrt(area_vector(segment_of(face, discretization.reference)).norm());
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
  } // namespace


  bool
  is_one_surface(const Discretization &discretization, const SurfaceContact &contact)
  {
    return slave_ids(discretization, contact) == master_ids(discretization, contact);
  }


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
    , slave_faces(discretization.faces_on(slave_ids(discretization, contact)))
    , master_faces(discretization.faces_on(master_ids(discretization, contact)))
  {
    if (reversed)
      std::swap(slave_faces, master_faces);
    least_radius = search_radius = 0.5 * std::max(mean_size(discretization, slave_faces),
                                                  mean_size(discretization, master_faces));
    faces                        = slave_faces;
    faces.insert(faces.end(), master_faces.begin(), master_faces.end());
    for (const auto &face : master_faces)
      stiffness_of_masters.push_back(penalty_stiffness(discretization, face));
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
    face_areas.resize(slave_faces.size());
    forget_distances();
  }


  void
  SurfaceSearch::forget_distances()
  {
    memories.assign(slaves.size(), Memory());
    candidates.clear();
    body_pairs.clear();
    pairs_around.clear();
    for (Slave &slave : slaves)
      slave.first_candidate = 0;
  }
} // namespace akmon
