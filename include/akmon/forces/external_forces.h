#pragma once

#include <akmon/model/nodal_state.h>
#include <akmon/model/vector_function.h>

#include <deal.II/base/parameter_handler.h>

#include <string>
#include <vector>

namespace akmon
{
  /// Traction or pressure on boundary parts (2). Section "Loads/NAME".
  struct SurfaceLoad
  {
    enum class Type
    {
      traction, ///< f(X, t), a vector per current area
      pressure  ///< p(X, t) against the outward normal of the current surface
    };

    std::string name;
    Type type = Type::pressure;
    std::vector<std::string> surfaces; ///< "BODY:PART"
    SpaceTimeFunction function;

    static void
    declare(dealii::ParameterHandler &prm);

    /// Throws InputError where a value is missing or inadmissible.
    void
    parse(dealii::ParameterHandler &prm, const std::string &section);
  };


  /// Body force per mass b/rho and the damping rate eta of (1). Section "Body force".
  struct BodyForce
  {
    SpaceTimeFunction acceleration; ///< length/time^2
    double damping     = 0.;        ///< eta, 1/time
    double damping_end = 0.;        ///< eta is zero from then on, time

    static void
    declare(dealii::ParameterHandler &prm);

    void
    parse(dealii::ParameterHandler &prm);
  };


  /// Body forces and surface loads at the current configuration.
  class ExternalForces
  {
  public:
    /// Throws InputError for unknown surfaces.
    ExternalForces(const Discretization &discretization,
                   const std::vector<SurfaceLoad> &surface_loads,
                   const BodyForce &body_force);

    /// Add the forces at (x_n, t_n) to the owned entries of @p force; complete at owned nodes.
    void
    add(const NodalState &state, NodalVector &force);

    /// Work of the forces of the last add() through an increment of the owned nodes; energy.
    double
    work(const NodalVector &increment) const;

  private:
    void
    add_body_force(const NodalState &state, NodalVector &force);
    void
    add_surface_load(const SurfaceLoad &load,
                     const std::vector<BoundaryFace> &faces,
                     const NodalState &state,
                     NodalVector &force);

    const Discretization &discretization;
    const std::vector<SurfaceLoad> &surface_loads;
    const BodyForce &body_force;
    std::vector<std::vector<BoundaryFace>> loaded_faces; ///< per load
    NodalVector current;                                 ///< empty without loads
  };
} // namespace akmon
