#include <akmon/contact/bonds/bonds.h>
#include <akmon/parameters.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

// How Bonds are made, and their system of equations.

namespace akmon
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int none = numbers::invalid_unsigned_int;

    // Of the diagonal: makes bonds regular that repeat each other. Its error is squared away.
    constexpr double shift = 1e-12;
  } // namespace


  Bonds::Bonds(const Discretization &discretization,
               const std::vector<SurfaceContact> &contacts,
               const EssentialConditions &conditions)
    : discretization(discretization)
    , contacts(contacts)
    , conditions(conditions)
  {
    std::vector<std::vector<BondPoint>> found(contacts.size());
    std::vector<std::vector<TiedFace>> slaves(contacts.size()), all_faces;
    for (unsigned int i = 0; i < contacts.size(); ++i)
      if (contacts[i].tied)
        {
          const std::string section = "Contact/" + contacts[i].name;
          slaves[i]          = tied_faces(discretization, section, "Slave", contacts[i].slaves);
          const auto masters = tied_faces(discretization, section, "Master", contacts[i].masters);
          found[i]           = bond_points(slaves[i], masters, contacts[i].bond_distance);
          if (found[i].empty())
            throw InputError(section,
                             "Type",
                             "tied",
                             "no part of the slave surface lies within [" + section +
                               "] Bond distance of the master");
          all_faces.push_back(slaves[i]);
          all_faces.push_back(masters);
        }
    if (all_faces.empty())
      return;
    number_nodes(all_faces);
    const auto number = [&](const types::global_dof_index node) {
      return static_cast<unsigned int>(std::lower_bound(nodes.begin(), nodes.end(), node) -
                                       nodes.begin());
    };
    const Values X = gather(
      [&](const Own &node) { return at_node(discretization.reference, node.local_node); });
    for (unsigned int i = 0; i < contacts.size(); ++i)
      for (const auto &of_mesh : found[i])
        {
          Point point{};
          point.interface = i;
          point.slave     = number(of_mesh.slave);
          point.area      = of_mesh.area;
          for (const auto &[node, weight] : of_mesh.row)
            point.row.emplace_back(number(node), weight);
          for (const unsigned int f : of_mesh.faces)
            {
              std::array<unsigned int, 4> face;
              for (unsigned int k = 0; k < 4; ++k)
                face[k] = number(slaves[i][f].nodes[k]);
              point.faces.push_back(face);
            }
          point.offset = offset_at(point, X);
          points.push_back(std::move(point));
        }
    count_unbroken();
  }


  void
  Bonds::update_mobilities()
  {
    if (!exist())
      return;
    const auto W_of = [&](const Own &node) {
      return conditions.projector(node.local_node) / discretization.mass[node.local_node];
    };
    const Values diagonal     = gather([&](const Own &node) {
      const auto W_i = W_of(node);
      return Tensor<1, 3>({W_i[0][0], W_i[1][1], W_i[2][2]});
    });
    const Values off_diagonal = gather([&](const Own &node) {
      const auto W_i = W_of(node);
      return Tensor<1, 3>({W_i[1][2], W_i[2][0], W_i[0][1]});
    });
    std::vector<SymmetricTensor<2, 3>> found(nodes.size());
    for (unsigned int i = 0; i < nodes.size(); ++i)
      for (unsigned int d = 0; d < 3; ++d)
        {
          found[i][d][d]                     = diagonal[i][d];
          found[i][(d + 1) % 3][(d + 2) % 3] = off_diagonal[i][d];
        }
    if (found != W)
      full.valid = reduced.valid = false;
    W = std::move(found);
  }


  // All nodes of tied surfaces, and which of them are this rank's.
  void
  Bonds::number_nodes(const std::vector<std::vector<TiedFace>> &faces)
  {
    for (const auto &of_surface : faces)
      for (const auto &face : of_surface)
        nodes.insert(nodes.end(), face.nodes.begin(), face.nodes.end());
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());

    const auto &owned = discretization.partitioner->locally_owned_range();
    std::vector<unsigned int> own_numbers;
    for (unsigned int i = 0; i < nodes.size(); ++i)
      if (owned.is_element(3 * nodes[i]))
        {
          const unsigned int local = discretization.partitioner->global_to_local(3 * nodes[i]) / 3;
          own.push_back({i, local, none});
          number_here[local] = i;
          own_numbers.push_back(i);
        }
    int next = 0;
    for (const auto &of_rank :
         Utilities::MPI::all_gather(discretization.communicator(), own_numbers))
      {
        counts.push_back(3 * of_rank.size());
        first_of_rank.push_back(next);
        next += counts.back();
        order.insert(order.end(), of_rank.begin(), of_rank.end());
      }
  }


  void
  Bonds::set_numbers(const ContactNodes &contact_nodes)
  {
    for (auto &node : own)
      node.number = contact_nodes.number(contact_nodes.id_of_local(node.local_node));
    if (nodes.empty())
      return;
    // Doubles hold integers of this size exactly.
    const Values found = gather([&](const Own &node) {
      return Tensor<1, 3>({double(contact_nodes.id(node.number)), 0., 0.});
    });
    for (const auto &id : found)
      ids.push_back(ContactNodes::Id(id[0]));
  }


  // Number in `nodes` of a contact node that unbroken points take part in, else invalid.
  unsigned int
  Bonds::number_of(const ContactNodes::Id id) const
  {
    const auto found = std::lower_bound(ids.begin(), ids.end(), id);
    if (found == ids.end() || *found != id || uses[found - ids.begin()] == 0)
      return numbers::invalid_unsigned_int;
    return found - ids.begin();
  }


  bool
  Bonds::hold(const ContactPair &pair) const
  {
    if (!exist() || pair.interface >= contacts.size() || !contacts[pair.interface].tied)
      return false;
    const auto found = number_here.find(pair.slave);
    if (found == number_here.end())
      return false;
    return (pair.reversed ? held : held_slaves)[found->second];
  }


  void
  Bonds::count_unbroken()
  {
    unbroken.clear();
    uses.assign(nodes.size(), 0);
    for (unsigned int i = 0; i < points.size(); ++i)
      if (!points[i].broken)
        {
          unbroken.push_back(i);
          for (const auto &entry : points[i].row)
            ++uses[entry.first];
        }
    n_unbroken = unbroken.size();
    full.valid = reduced.valid = false;
    mark_held();
  }


  // Nodes of points that hold in this step.
  void
  Bonds::mark_held()
  {
    held.assign(nodes.size(), false);
    held_slaves.assign(nodes.size(), false);
    for (const unsigned int i : unbroken)
      if (points[i].holds != Holds::nothing)
        {
          held_slaves[points[i].slave] = true;
          for (const auto &entry : points[i].row)
            held[entry.first] = true;
        }
  }


  // u += W C^T t
  void
  Bonds::add_response(const Point &point, const Tensor<1, 3> &force, Values &u) const
  {
    visit_parts(point, force, [&](const Entry &entry, const Tensor<1, 3> &part) {
      u[entry.first] += W[entry.first] * part;
    });
  }


  void
  Bonds::factorize(System &system, const std::vector<Row> &rows) const
  {
    system.rows = rows;
    std::vector<std::vector<std::pair<unsigned int, Tensor<1, 3>>>> at_node(nodes.size());
    for (unsigned int r = 0; r < rows.size(); ++r)
      visit_parts(points[rows[r].point],
                  rows[r].direction,
                  [&](const Entry &entry, const Tensor<1, 3> &part) {
                    at_node[entry.first].emplace_back(r, part);
                  });
    std::vector<Eigen::Triplet<double>> triplets;
    for (unsigned int node = 0; node < nodes.size(); ++node)
      for (const auto &[i, of_i] : at_node[node])
        for (const auto &[j, of_j] : at_node[node])
          if (const double entry = j <= i ? of_i * (W[node] * of_j) : 0.; entry != 0.)
            triplets.emplace_back(i, j, entry);
    const unsigned int n = rows.size();
    system.matrix.resize(n, n);
    system.matrix.setFromTriplets(triplets.begin(), triplets.end());
    const Eigen::VectorXd diagonal = system.matrix.diagonal();
    // Directions in which all nodes are held get no force.
    auto regular = system.matrix;
    for (unsigned int i = 0; i < n; ++i)
      regular.coeffRef(i, i) += diagonal[i] > 0. ? shift * diagonal[i] : 1.;
    system.cholesky.compute(regular);
    system.valid = true;
  }


  // (C W C^T) t = b
  Eigen::VectorXd
  Bonds::solve(const System &system, const Eigen::VectorXd &b) const
  {
    if (b.size() == 0)
      return b;
    Eigen::VectorXd t = system.cholesky.solve(b);
    t += system.cholesky.solve(b - system.matrix.selfadjointView<Eigen::Lower>() * t);
    return t;
  }


  std::vector<Bonds::Row>
  Bonds::holding_rows() const
  {
    std::vector<Row> rows;
    for (const unsigned int i : unbroken)
      if (points[i].holds == Holds::normal)
        rows.push_back({i, points[i].normal});
      else if (points[i].holds == Holds::all)
        for (unsigned int d = 0; d < 3; ++d)
          {
            Tensor<1, 3> axis;
            axis[d] = 1.;
            rows.push_back({i, axis});
          }
    return rows;
  }


  // Where all hold the factors are kept from step to step, else from round to round.
  const Bonds::System &
  Bonds::system_now()
  {
    const bool all = std::all_of(unbroken.begin(), unbroken.end(), [&](const unsigned int i) {
      return points[i].holds == Holds::all;
    });
    System &system = all ? full : reduced;
    if (all && system.valid)
      return system;
    const auto rows = holding_rows();
    if (!system.valid || system.rows != rows)
      factorize(system, rows);
    return system;
  }
} // namespace akmon
