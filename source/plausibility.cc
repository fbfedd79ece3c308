#include <akmon/model/hexahedron_cell.h>
#include <akmon/output/history.h>
#include <akmon/plausibility.h>

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/mpi.h>
#include <deal.II/fe/mapping_q1.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // A part of the model as it stands and starts.
    struct Extent
    {
      Point<3> lower, upper; ///< of the box around it; length
      double speed = 0.;     ///< largest initial speed of a node; length/time

      double
      diagonal() const
      {
        return (upper - lower).norm();
      }
    };


    class Plausibility
    {
    public:
      Plausibility(const Case &parameters,
                   const Discretization &discretization,
                   const NodalVector &velocity);

      std::vector<std::string> warnings;

    private:
      Extent
      extent(const std::vector<unsigned int> &nodes, const NodalVector &velocity) const;
      Extent
      extent_of_surfaces(const std::string &section,
                         const std::string &key,
                         const std::vector<std::string> &surfaces,
                         const NodalVector &velocity) const;
      bool
      acts_on(const std::vector<std::string> &surfaces, const Body &body) const;
      void
      check_units();
      void
      check_weight();
      void
      check_contacts(const NodalVector &velocity);
      void
      check_bodies();
      void
      check_probes();

      const Case &parameters;
      const Discretization &discretization;
      const MPI_Comm comm;
      std::vector<Extent> bodies;
    };


    double
    youngs_modulus(const Elasticity &elasticity)
    {
      return elasticity.mu * (3. * elasticity.lambda + 2. * elasticity.mu) /
             (elasticity.lambda + elasticity.mu);
    }


    std::string
    rounded(const double number)
    {
      char text[32];
      std::snprintf(text, sizeof(text), "%.3g", number);
      return text;
    }


    Plausibility::Plausibility(const Case &parameters,
                               const Discretization &discretization,
                               const NodalVector &velocity)
      : warnings(parameters.idle)
      , parameters(parameters)
      , discretization(discretization)
      , comm(discretization.communicator())
    {
      std::vector<std::vector<unsigned int>> nodes(parameters.bodies.size());
      for (unsigned int node = 0; node < discretization.n_owned_nodes; ++node)
        nodes[discretization.body_of_node[node]].push_back(node);
      for (const auto &of_body : nodes)
        bodies.push_back(extent(of_body, velocity));
      check_units();
      check_weight();
      check_contacts(velocity);
      check_bodies();
      check_probes();
    }


    Extent
    Plausibility::extent(const std::vector<unsigned int> &nodes, const NodalVector &velocity) const
    {
      // Maxima only: of -x, x and the speed.
      std::vector<double> largest(7, -std::numeric_limits<double>::max());
      for (const unsigned int node : nodes)
        {
          const auto X = at_node(discretization.reference, node);
          for (unsigned int d = 0; d < 3; ++d)
            {
              largest[d]     = std::max(largest[d], -X[d]);
              largest[3 + d] = std::max(largest[3 + d], X[d]);
            }
          largest[6] = std::max(largest[6], at_node(velocity, node).norm());
        }
      Utilities::MPI::max(largest, comm, largest);
      Extent result;
      for (unsigned int d = 0; d < 3; ++d)
        {
          result.lower[d] = -largest[d];
          result.upper[d] = largest[3 + d];
        }
      result.speed = largest[6];
      return result;
    }


    Extent
    Plausibility::extent_of_surfaces(const std::string &section,
                                     const std::string &key,
                                     const std::vector<std::string> &surfaces,
                                     const NodalVector &velocity) const
    {
      std::vector<unsigned int> nodes;
      for (const auto &face :
           discretization.faces_on(discretization.boundary_ids(section, key, surfaces)))
        for (const unsigned int node : face.nodes)
          if (node < discretization.n_owned_nodes)
            nodes.push_back(node);
      return extent(nodes, velocity);
    }


    bool
    Plausibility::acts_on(const std::vector<std::string> &surfaces, const Body &body) const
    {
      return std::any_of(surfaces.begin(), surfaces.end(), [&](const std::string &surface) {
        return surface == "all" || body.is_called(surface.substr(0, surface.find(':')));
      });
    }


    // Ratios without a unit that no sensible case has.
    void
    Plausibility::check_units()
    {
      constexpr double fastest_impact = 1., largest_yield_strain = 0.2, unlike = 1e3, waves = 1e-2;

      double slowest = std::numeric_limits<double>::max(), fastest = 0.;
      for (unsigned int b = 0; b < bodies.size(); ++b)
        {
          if (parameters.bodies[b].copy > 0)
            continue; // as the first one
          const std::string body        = "body '" + parameters.bodies[b].name + "'";
          const Material &material      = discretization.material_of(b);
          const double c                = material.dilatational_wave_speed();
          slowest                       = std::min(slowest, c);
          fastest                       = std::max(fastest, c);
          const std::string of_material = "its wave speed " + rounded(c) + " (density " +
                                          rounded(material.density) + ", Young's modulus " +
                                          rounded(youngs_modulus(material.elasticity())) + ")";
          if (bodies[b].speed > fastest_impact * c)
            warnings.push_back(body + " starts at " + rounded(bodies[b].speed / c) + " times " +
                               of_material + ": are the units mixed?");
          else if (parameters.time.end * c < waves * bodies[b].diagonal())
            warnings.push_back(body + " of size " + rounded(bodies[b].diagonal()) +
                               " is crossed by no wave before the end of the run, by " +
                               of_material + ": are the units mixed?");
          if (const auto *const j2 = std::get_if<J2Plastic>(&material.law);
              j2 != nullptr &&
              j2->yield_stress > largest_yield_strain * youngs_modulus(j2->elasticity))
            warnings.push_back("material '" + material.name + "' yields at " +
                               rounded(j2->yield_stress / youngs_modulus(j2->elasticity)) +
                               " of Young's modulus: are the units mixed?");
        }
      if (fastest > unlike * slowest)
        warnings.push_back("the wave speeds of the materials differ by a factor of " +
                           rounded(fastest / slowest) + ": are the units mixed?");
    }


    // A body compressed by its own weight, rho g L/E.
    void
    Plausibility::check_weight()
    {
      constexpr double largest = 0.3;

      const auto &acceleration = parameters.body_force.acceleration;
      if (acceleration.identically_zero() || !acceleration.uniform())
        return;
      const double g = acceleration.vector(Point<3>(), 0.).norm();
      for (unsigned int b = 0; b < bodies.size(); ++b)
        {
          if (parameters.bodies[b].copy > 0)
            continue; // as the first one
          const Material &material = discretization.material_of(b);
          const double strain      = material.density * g * bodies[b].diagonal() /
                                youngs_modulus(material.elasticity());
          if (strain > largest)
            warnings.push_back("body '" + parameters.bodies[b].name +
                               "' is strained by its own weight to about " + rounded(strain) +
                               ": are the units mixed?");
        }
    }


    // Contacts whose surfaces are further apart than anything can move until the end. Only where
    // nothing but the initial velocities moves the bodies: no tool pushes them either.
    void
    Plausibility::check_contacts(const NodalVector &velocity)
    {
      double fastest = 0.;
      for (const auto &body : bodies)
        fastest = std::max(fastest, body.speed);
      if (!parameters.body_force.acceleration.identically_zero() ||
          !parameters.surface_loads.empty() ||
          std::any_of(parameters.obstacles.begin(),
                      parameters.obstacles.end(),
                      [](const auto &obstacle) {
                        return obstacle.motion != Obstacle::Motion::fixed;
                      }) ||
          std::any_of(parameters.prescribed_motions.begin(),
                      parameters.prescribed_motions.end(),
                      [](const auto &motion) {
                        return motion.type != PrescribedMotion::Type::symmetry &&
                               !motion.function.identically_zero();
                      }))
        return;
      // Hit by a heavy body, a light one gets up to twice its speed.
      const double way = 4. * fastest * parameters.time.end;
      for (const auto &contact : parameters.contacts)
        {
          const std::string section = "Contact/" + contact.name;
          const Extent slave  = extent_of_surfaces(section, "Slave", contact.slaves, velocity);
          const Extent master = extent_of_surfaces(section, "Master", contact.masters, velocity);
          double square       = 0.;
          for (unsigned int d = 0; d < 3; ++d)
            square += std::pow(std::max({0.,
                                         slave.lower[d] - master.upper[d],
                                         master.lower[d] - slave.upper[d]}),
                               2);
          if (std::sqrt(square) > way)
            warnings.push_back("contact '" + contact.name + "' can never close: its surfaces are " +
                               rounded(std::sqrt(square)) +
                               " apart, and nothing moves further than " + rounded(way));
        }
      for (const auto &obstacle : parameters.obstacles)
        {
          // Of a box's points a corner is closest to a plane; other shapes are nearby anyway.
          if (std::isfinite(obstacle.shape->radius()))
            continue;
          const Extent surface = extent_of_surfaces("Obstacles/" + obstacle.name,
                                                    "Surfaces",
                                                    obstacle.slaves,
                                                    velocity);
          const auto rotation  = obstacle.start.orientation.matrix();
          double gap           = std::numeric_limits<double>::max();
          for (unsigned int corner = 0; corner < 8; ++corner)
            {
              Tensor<1, 3> x;
              for (unsigned int d = 0; d < 3; ++d)
                x[d] = (corner >> d) % 2 ? surface.upper[d] : surface.lower[d];
              const auto X = (x - obstacle.start.place) * rotation;
              gap          = std::min(gap, obstacle.shape->closest(X).distance);
            }
          if (gap > way)
            warnings.push_back("obstacle '" + obstacle.name + "' can never be touched: it is " +
                               rounded(gap) + " away, and nothing moves further than " +
                               rounded(way));
        }
    }


    void
    Plausibility::check_bodies()
    {
      const bool weight = !parameters.body_force.acceleration.identically_zero();
      for (unsigned int b = 0; b < bodies.size(); ++b)
        {
          if (parameters.bodies[b].copy > 0)
            continue; // as the first one
          const std::string &name = parameters.bodies[b].name;
          const auto any          = [&](const auto &items, const auto &surfaces) {
            return std::any_of(items.begin(), items.end(), [&](const auto &item) {
              return acts_on(surfaces(item), parameters.bodies[b]);
            });
          };
          const bool held    = any(parameters.prescribed_motions,
                                [](const auto &motion) { return motion.surfaces; });
          const bool loaded  = any(parameters.surface_loads,
                                  [](const auto &load) { return load.surfaces; });
          const bool touched = any(parameters.contacts,
                                   [](const auto &contact) { return contact.slaves; }) ||
                               any(parameters.contacts,
                                   [](const auto &contact) { return contact.masters; }) ||
                               any(parameters.obstacles,
                                   [](const auto &obstacle) { return obstacle.slaves; });
          // Cases about rigid bodies alone have an onlooker, as a case has at least one body.
          const bool onlooker = std::any_of(parameters.obstacles.begin(),
                                            parameters.obstacles.end(),
                                            [](const auto &obstacle) {
                                              return obstacle.motion != Obstacle::Motion::fixed;
                                            });
          if (held || touched || loaded || onlooker)
            continue;
          if (weight)
            warnings.push_back("body '" + name +
                               "' falls for ever: it has weight, but no support "
                               "and no contact");
          else if (bodies[b].speed == 0.)
            warnings.push_back("body '" + name +
                               "' never moves: it has no velocity, load, support "
                               "or contact");
        }
    }


    void
    Plausibility::check_probes()
    {
      constexpr double tolerance = 1e-6; // in the reference cell
      const MappingQ1<3> mapping;
      HexahedronCell hexahedron;
      for (const auto &probe : parameters.probes)
        {
          int inside = 0;
          for (const auto &relevant : discretization.cells)
            if (parameters.bodies[relevant.body].name == probe.body)
              {
                const auto cell = hexahedron.at(discretization.corners_of(relevant));
                if ((probe.point - cell->center()).norm() <= cell->diameter())
                  try
                    {
                      const auto unit = mapping.transform_real_to_unit_cell(cell, probe.point);
                      inside |= GeometryInfo<3>::is_inside_unit_cell(unit, tolerance);
                    }
                  catch (const Mapping<3>::ExcTransformationFailed &)
                    {
                      // far outside of a distorted cell
                    }
              }
          if (Utilities::MPI::max(inside, comm) == 0)
            warnings.push_back("probe '" + probe.name + "' lies outside body '" + probe.body +
                               "'; it sits on the closest node");
        }
    }
  } // namespace


  std::vector<std::string>
  plausibility_warnings(const Case &parameters,
                        const Discretization &discretization,
                        const NodalVector &velocity)
  {
    return Plausibility(parameters, discretization, velocity).warnings;
  }
} // namespace akmon
