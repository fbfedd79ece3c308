#include <akmon/contact/coupled_solver.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // Of a pair's own mobility: enough to make repeated constraints regular, and of no consequence
    // for gaps (SemismoothNewton).
    constexpr double compliance = 1e-7;


    // Where rigid bodies touch at more points than it takes, the gaps disagree by rounding, which
    // nothing can move: relative to the size of the pairs.
    double
    rounding_of_rigid_gaps(const std::vector<ContactPair *> &pairs)
    {
      constexpr double rounding = 1e-15;

      double largest = 0.;
      for (const ContactPair *const pair : pairs)
        if (pair->slave == numbers::invalid_unsigned_int)
          largest = std::max(largest, rounding * (1. + pair->place.norm() / pair->size));
      return largest;
    }
  } // namespace


  CoupledSolver::CoupledSolver(const ContactSolver &parameters,
                               const ContactNodes &nodes,
                               const Mobility &mobility,
                               const Bonds *const bonds)
    : parameters(parameters)
    , nodes(nodes)
    , delassus_of_all(nodes, mobility, bonds)
    , delassus(nodes, mobility, bonds)
    , preconditioner(nodes, mobility)
    , newton(delassus, preconditioner, nodes.get_communicator())
  {
  }


  // Pairs that the step could close: the contact forces move a node by no more than a few times
  // what the fastest pair would do freely. All others only cost iterations.
  void
  CoupledSolver::choose_participants(std::vector<ContactPair> &pairs,
                                     const ContactNodes::Field &dx_free,
                                     const std::vector<double> &friction_of_pairs)
  {
    double fastest = 0.;
    for (const auto &pair : pairs)
      fastest = std::max(fastest, std::abs(pair.normal * pair.relative(dx_free)));
    const double margin = 4. * Utilities::MPI::max(fastest, nodes.get_communicator());
    all.clear();
    friction_of_all.clear();
    for (std::size_t i = 0; i < pairs.size(); ++i)
      if (pairs[i].target_gap <= margin)
        {
          all.push_back(&pairs[i]);
          friction_of_all.push_back(friction_of_pairs[i]);
        }
      else
        {
          pairs[i].normal_force     = 0.;
          pairs[i].tangential_force = Tensor<1, 3>();
        }
  }


  void
  CoupledSolver::begin_step(std::vector<ContactPair> &pairs,
                            const ContactNodes::Field &dx_free,
                            const std::vector<double> &friction_of_pairs,
                            const double effective_mass_factor)
  {
    n_iterations  = 0;
    last_residual = 0.;
    all_converged = true;
    choose_participants(pairs, dx_free, friction_of_pairs);
    delassus_of_all.reinit(all, effective_mass_factor);
    isolated = delassus_of_all.isolated_pairs();
    coupled.clear();
    problem.friction.clear();
    for (std::size_t i = 0; i < all.size(); ++i)
      if (!isolated[i])
        {
          coupled.push_back(all[i]);
          problem.friction.push_back(friction_of_all[i]);
        }
    const auto any = [&](const bool here) {
      return Utilities::MPI::max(int(here), nodes.get_communicator()) > 0;
    };
    couples_somewhere  = any(!coupled.empty());
    friction_somewhere = any(std::any_of(friction_of_all.begin(),
                                         friction_of_all.end(),
                                         [](const double mu) { return mu > 0.; }));
    if (!couples_somewhere)
      return;
    delassus.reinit(coupled, effective_mass_factor);
    preconditioner.set_pairs(coupled, delassus, effective_mass_factor);
    problem.norm = delassus.norm_bound();
    problem.weights.resize(coupled.size());
    for (std::size_t i = 0; i < coupled.size(); ++i)
      problem.weights[i] = delassus.scale()[i] > 0. ?
                             1. / (delassus.scale()[i] * coupled[i]->size) :
                             0.;
  }


  void
  CoupledSolver::solve(const ContactNodes::Field &dx_free)
  {
    for (std::size_t i = 0; i < all.size(); ++i)
      if (isolated[i])
        solve_alone(*all[i], dx_free, delassus_of_all.scale()[i], friction_of_all[i]);
    if (couples_somewhere)
      solve_together(dx_free);
  }


  // A pair that shares no node with another has the closed solution (80)(82), which is exact.
  void
  CoupledSolver::solve_alone(ContactPair &pair,
                             const ContactNodes::Field &dx_free,
                             const double s,
                             const double mu) const
  {
    const auto moved      = pair.relative(dx_free);
    pair.normal_force     = std::max(0., -s * s * (pair.normal * moved + pair.target_gap));
    const auto result     = Coulomb::tangential_force(-s * s * pair.tangential_part(moved),
                                                  mu * pair.normal_force);
    pair.tangential_force = result.force;
    pair.sticks           = result.sticks;
  }


  // Gaps are to be exact relative to the cell, forces relative to themselves: what remains of a
  // violation over the violation without contact forces is the relative error of the forces. Gaps
  // are not known better than to rounding, though.
  double
  CoupledSolver::tolerance_for(const double violation) const
  {
    constexpr double force_tolerance = 1e-11, rounding = 1e-14;
    const double relative = force_tolerance *
                            Utilities::MPI::max(violation, nodes.get_communicator());
    return std::min(parameters.tolerance, std::max(relative, rounding));
  }


  void
  CoupledSolver::solve_together(const ContactNodes::Field &dx_free)
  {
    constexpr unsigned int patience = 1; // iterations that old factors may cost more than new ones

    const auto &s       = delassus.scale();
    const std::size_t n = coupled.size();
    problem.b.resize(n);
    problem.compliance = compliance;
    problem.limit      = parameters.limit;
    tau.resize(n);
    double violation = 0.;
    for (std::size_t i = 0; i < n; ++i)
      {
        const auto &pair = *coupled[i];
        problem.b[i]     = s[i] * (delassus.frame(i) * pair.relative(dx_free));
        problem.b[i][0] += s[i] * pair.target_gap;
        tau[i]    = s[i] > 0. ? delassus.frame(i) * pair.force() / s[i] : Tensor<1, 3>();
        violation = std::max(violation, -problem.weights[i] * problem.b[i][0]);
      }
    problem.tolerance = std::max(tolerance_for(violation),
                                 Utilities::MPI::max(rounding_of_rigid_gaps(coupled),
                                                     nodes.get_communicator()));
    const auto result = newton.solve(problem, tau);
    n_iterations += result.n_applications;
    last_residual = std::max(last_residual, result.residual);
    all_converged = all_converged && result.converged;
    if (!preconditioner.is_old())
      iterations_when_new = result.n_applications;
    else if (result.n_applications > iterations_when_new + patience)
      preconditioner.forget();
    for (std::size_t i = 0; i < n; ++i)
      {
        auto &pair            = *coupled[i];
        const auto force      = s[i] * tau[i];
        pair.normal_force     = force[0];
        pair.tangential_force = force[1] * delassus.frame(i)[1] + force[2] * delassus.frame(i)[2];
        // On the circle up to rounding is sliding.
        pair.sticks = pair.normal_force > 0. &&
                      pair.tangential_force.norm() <
                        (1. - 1e-12) * problem.friction[i] * pair.normal_force;
      }
  }


  const ContactNodes::Field &
  CoupledSolver::increments()
  {
    return delassus_of_all.increments([&](const std::size_t i) { return all[i]->force(); });
  }
} // namespace akmon
