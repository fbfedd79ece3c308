#pragma once

#include <akmon/model/nodal_state.h>
#include <akmon/model/vector_function.h>

#include <deal.II/base/parameter_handler.h>

#include <string>
#include <vector>

namespace akmon
{
  /// Prescribed motion of boundary parts (3). Section "Prescribed motion/NAME".
  struct PrescribedMotion
  {
    enum class Type
    {
      symmetry,     ///< nodes stay in their plane
      displacement, ///< u(X, t) in chosen components
      velocity      ///< v(X, t) in chosen components
    };

    std::string name;
    Type type = Type::symmetry;
    std::vector<std::string> surfaces; ///< "BODY:PART"
    std::vector<unsigned int> components;
    SpaceTimeFunction function;

    static void
    declare(dealii::ParameterHandler &prm);

    /// Throws InputError where a value is missing or inadmissible.
    void
    parse(dealii::ParameterHandler &prm, const std::string &section);
  };


  /**
   * Prescribed increments of nodes. A constrained node has up to three orthonormal directions d
   * along which its increment is given; the reaction that this takes does work, which is external
   * work.
   */
  class EssentialConditions
  {
  public:
    /// Throws InputError for unknown surfaces and symmetry planes that are not plane.
    EssentialConditions(const Discretization &discretization,
                        const std::vector<PrescribedMotion> &motions);

    /**
     * Give the constrained increments in state.dx_next their values and add the reactions this
     * takes, m* (dx_after - dx_before). Called after the free increment and again after contact.
     */
    void
    apply(NodalState &state, const double effective_mass_factor);

    /// Forget the reactions of the last step.
    void
    clear_reactions();

    /// Work of the reactions through an increment on the owned nodes; energy.
    double
    reaction_work(const NodalVector &increment) const;

    /// The part of a force at a node that can move it: P = I - sum d (x) d. Identity for free
    /// nodes.
    dealii::SymmetricTensor<2, 3>
    projector(const unsigned int node) const;

    /// Initial velocities of constrained nodes take the prescribed values where these have one at t
    /// = 0.
    void
    adjust_initial_velocity(NodalVector &velocity) const;

  private:
    struct Direction
    {
      dealii::Tensor<1, 3> d;
      // the value along d is sum_k weight_k * (component of motion k's function)
      std::vector<std::pair<unsigned int, dealii::Tensor<1, 3>>> terms;
    };

    struct ConstrainedNode
    {
      unsigned int node;
      std::vector<Direction> directions;
      dealii::Tensor<1, 3> reaction;
    };

    void
    constrain(const unsigned int node,
              const unsigned int motion,
              const dealii::Tensor<1, 3> &direction);
    dealii::Tensor<1, 3>
    function_value(const unsigned int motion,
                   const NodalState &state,
                   const dealii::Point<3> &X) const;
    void
    evaluate_uniform_functions(const NodalState &state);
    double
    prescribed_increment(const Direction &direction,
                         const NodalState &state,
                         const unsigned int node) const;

    const Discretization &discretization;
    const std::vector<PrescribedMotion> &motions;
    std::vector<ConstrainedNode> nodes;               ///< owned nodes only
    std::vector<unsigned int> index_of_node;          ///< in nodes, or invalid
    std::vector<dealii::Tensor<1, 3>> uniform_values; ///< of the motions, for the step in work
  };
} // namespace akmon
