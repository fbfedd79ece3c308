#include <akmon/contact/bonds/bonds.h>

#include <algorithm>
#include <cmath>

// What Bonds do in a step.

namespace akmon
{
  using namespace dealii;

  // Forces that hold points, from where the nodes would be without them.
  Eigen::VectorXd
  Bonds::hold_points(const System &system, const Values &reached) const
  {
    Eigen::VectorXd b(system.rows.size());
    for (std::size_t r = 0; r < system.rows.size(); ++r)
      {
        const auto &point = points[system.rows[r].point];
        b[r] = mass_factor * (system.rows[r].direction * (point.offset - relative(point, reached)));
      }
    return solve(system, b);
  }


  // Part of its initial strength, r of its law.
  double
  Bonds::strength_left(const Point &point) const
  {
    if (point.broken)
      return 0.;
    if (!point.softening)
      return 1.;
    const double taken = std::max(0., point.energy.carried) / point.area;
    return contacts[point.interface].bond.remaining(taken);
  }


  // A point that cannot bear a force gives what it can, or breaks.
  void
  Bonds::fail(Point &point, const Tensor<1, 3> &trial, const double r)
  {
    constexpr double nothing = 1e-3; // of the strength: a millionth of the energy

    const auto &law = contacts[point.interface].bond;
    point.softening = true;
    if (law.fracture_energy == 0. || r < nothing)
      {
        point.broken = true;
        point.holds  = Holds::nothing;
        point.given = point.force = Tensor<1, 3>();
        point.energy.add_level(0., 0.);
        return;
      }
    point.given        = -point.area * law.limit(-trial / point.area, point.normal, r);
    const bool pressed = trial * point.normal > 0.;
    point.holds        = pressed ? Holds::normal : Holds::nothing;
    if (pressed)
      point.given -= (point.given * point.normal) * point.normal;
  }


  // Whether any point had to bear more than it can. The bond pulls the slave against the normal.
  bool
  Bonds::let_fail(const System &system, const Eigen::VectorXd &t)
  {
    constexpr double rounding = 1e-12;

    bool any = false;
    for (std::size_t r = 0; r < system.rows.size();)
      {
        auto &point        = points[system.rows[r].point];
        Tensor<1, 3> trial = point.given;
        for (const std::size_t end = r + (point.holds == Holds::all ? 3 : 1); r < end; ++r)
          trial += t[r] * system.rows[r].direction;
        const auto &law   = contacts[point.interface].bond;
        const double left = strength_left(point);
        const bool fails  = point.holds == Holds::all ?
                              law.breaks() && law.utilization(-trial / point.area, point.normal) >
                                               left * (1. + rounding) :
                              trial * point.normal < 0.;
        if (fails)
          fail(point, trial, left);
        any = any || fails;
      }
    return any;
  }


  void
  Bonds::begin_step(const NodalState &state,
                    const double effective_mass_factor,
                    ContactNodes::Field &dx_free)
  {
    // Within a step forces are passed on to neighbours by inertia only.
    constexpr unsigned int most_rounds = 8;

    if (!exist())
      return;
    mass_factor = effective_mass_factor;
    x           = gather([&](const Own &node) { return at_node(state.x, node.local_node); });
    before      = gather([&](const Own &node) { return at_node(state.dx, node.local_node); });
    free        = gather([&](const Own &node) { return dx_free[node.number]; });
    for (unsigned int i = 0; i < nodes.size(); ++i)
      free[i] += x[i];
    turn_offsets(x, before);
    update_normals(x);
    follow_slip(x);
    set_levers(x);

    active            = &system_now();
    Values reached    = free;
    Eigen::VectorXd t = hold_points(*active, reached);
    for (unsigned int round = 0; round < most_rounds && let_fail(*active, t); ++round)
      {
        reached = free;
        for (const unsigned int i : unbroken)
          add_response(points[i], points[i].given / mass_factor, reached);
        active = &system_now();
        t      = hold_points(*active, reached);
      }
    if (std::any_of(unbroken.begin(), unbroken.end(), [&](const unsigned int i) {
          return points[i].broken;
        }))
      {
        count_unbroken();
        active = &system_now();
      }
    mark_held();
    for (std::size_t r = 0; r < active->rows.size(); ++r)
      add_response(points[active->rows[r].point],
                   t[r] / mass_factor * active->rows[r].direction,
                   reached);
    for (const auto &node : own)
      dx_free.set(node.number, reached[node.node] - x[node.node]);
  }


  void
  Bonds::project(ContactNodes::Field &increments) const
  {
    Values u = gather([&](const Own &node) { return increments[node.number]; });
    take_out_motion_of_points(u);
    for (const auto &node : own)
      increments.set(node.number, u[node.node]);
  }


  void
  Bonds::project(const std::vector<ContactNodes::Id> &ids_of_increments,
                 ContactNodes::Field &increments) const
  {
    Values u(nodes.size());
    for (unsigned int i = 0; i < ids_of_increments.size(); ++i)
      if (const auto number = number_of(ids_of_increments[i]);
          number != numbers::invalid_unsigned_int)
        u[number] = increments[i];
    take_out_motion_of_points(u);
    for (unsigned int i = 0; i < ids_of_increments.size(); ++i)
      if (const auto number = number_of(ids_of_increments[i]);
          number != numbers::invalid_unsigned_int)
        increments.set(i, u[number]);
  }


  void
  Bonds::take_out_motion_of_points(Values &u) const
  {
    Eigen::VectorXd b(active->rows.size());
    for (std::size_t r = 0; r < active->rows.size(); ++r)
      b[r] = -(active->rows[r].direction * relative(points[active->rows[r].point], u));
    const Eigen::VectorXd t = solve(*active, b);
    for (std::size_t r = 0; r < active->rows.size(); ++r)
      add_response(points[active->rows[r].point], t[r] * active->rows[r].direction, u);
  }


  const std::vector<Bonds::NodalForce> &
  Bonds::finish_step(const double effective_mass_factor,
                     const std::map<unsigned int, Tensor<1, 3>> &contact_force)
  {
    forces.clear();
    if (!exist())
      return forces;
    mass_factor        = effective_mass_factor;
    const Values loads = gather([&](const Own &node) {
      const auto found = contact_force.find(node.local_node);
      return found == contact_force.end() ? Tensor<1, 3>() : found->second;
    });
    Values reached     = free;
    for (unsigned int i = 0; i < nodes.size(); ++i)
      reached[i] += W[i] * loads[i] / mass_factor;
    for (const unsigned int i : unbroken)
      {
        points[i].force = points[i].given;
        add_response(points[i], points[i].given / mass_factor, reached);
      }
    const Eigen::VectorXd t = hold_points(*active, reached);
    for (std::size_t r = 0; r < active->rows.size(); ++r)
      {
        const auto force = t[r] * active->rows[r].direction;
        auto &point      = points[active->rows[r].point];
        point.force += force;
        add_response(point, force / mass_factor, reached);
      }

    for (unsigned int i = 0; i < nodes.size(); ++i)
      reached[i] -= x[i];
    for (const unsigned int i : unbroken)
      if (points[i].softening)
        points[i].energy.add_level(-(points[i].force * relative(points[i], before)),
                                   -(points[i].force * relative(points[i], reached)));
    collect_forces();
    return forces;
  }


  // At the owned nodes, interface by interface.
  void
  Bonds::collect_forces()
  {
    std::vector<NodalForce> of_nodes;
    for (auto begin = unbroken.begin(); begin != unbroken.end();)
      {
        const unsigned int interface = points[*begin].interface;
        of_nodes.assign(nodes.size(), NodalForce{});
        for (; begin != unbroken.end() && points[*begin].interface == interface; ++begin)
          {
            const auto &point = points[*begin];
            visit_parts(point, point.force, [&](const Entry &entry, const Tensor<1, 3> &part) {
              auto &of_node = of_nodes[entry.first];
              (point.softening ? of_node.failing : of_node.holding) += part;
            });
          }
        for (const auto &node : own)
          if (uses[node.node] > 0)
            {
              forces.push_back(of_nodes[node.node]);
              forces.back().node      = node.local_node;
              forces.back().interface = interface;
            }
      }
  }


  Bonds::Load
  Bonds::load_on(const unsigned int interface) const
  {
    Load load;
    for (const unsigned int i : unbroken)
      if (points[i].interface == interface)
        {
          const auto &point = points[i];
          const auto normal = (point.force * point.normal) * point.normal;
          load.normal += normal;
          load.tangential += point.force - normal;
          visit_parts(point, point.force, [&](const Entry &entry, const Tensor<1, 3> &part) {
            if (entry.second > 0.) // of the slave side
              load.moment += cross_product_3d(x[entry.first], part);
          });
        }
    return load;
  }


  Bonds::Report
  Bonds::report(const unsigned int interface) const
  {
    Report report;
    for (const auto &point : points)
      if (point.interface == interface)
        {
          report.area += point.area;
          report.broken_area += point.broken ? point.area : 0.;
          report.energy += point.energy.at_level;
        }
    return report;
  }


  // A point counts at a node with the part of its area that the node's shape function covers.
  std::map<types::global_dof_index, double>
  Bonds::strength_at_nodes() const
  {
    std::vector<double> area(nodes.size(), 0.), bonded(nodes.size(), 0.);
    for (const auto &point : points)
      for (const auto &[node, weight] : point.row)
        {
          const double part = std::abs(weight) * point.area;
          area[node] += part;
          bonded[node] += part * strength_left(point);
        }
    std::map<types::global_dof_index, double> strength;
    for (unsigned int i = 0; i < nodes.size(); ++i)
      if (area[i] > 0.)
        strength.emplace_hint(strength.end(), nodes[i], bonded[i] / area[i]);
    return strength;
  }


  void
  Bonds::save(CheckpointWriter &checkpoint) const
  {
    std::vector<double> values = {double(points.size())};
    for (const auto &point : points)
      {
        for (const auto &vector : {point.offset, point.force})
          for (unsigned int d = 0; d < 3; ++d)
            values.push_back(vector[d]);
        for (const double value : {point.energy.at_level,
                                   point.energy.carried,
                                   double(point.broken),
                                   double(point.softening),
                                   double(point.holds)})
          values.push_back(value);
      }
    checkpoint.numbers("bonds", values);
  }


  void
  Bonds::restore(const CheckpointReader &checkpoint)
  {
    const auto values = checkpoint.numbers("bonds");
    if (values.at(0) != points.size())
      throw std::runtime_error("its bonds are not those of the case");
    std::size_t next = 1;
    for (auto &point : points)
      {
        for (auto *const vector : {&point.offset, &point.force})
          for (unsigned int d = 0; d < 3; ++d)
            (*vector)[d] = values.at(next++);
        point.energy.at_level = values.at(next++);
        point.energy.carried  = values.at(next++);
        point.broken          = values.at(next++) != 0.;
        point.softening       = values.at(next++) != 0.;
        point.holds           = static_cast<Holds>(int(values.at(next++)));
      }
    if (!points.empty())
      count_unbroken();
  }
} // namespace akmon
