#include <akmon/contact/coupled_solver.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

namespace akmon
{
  using namespace dealii;

  CoupledSolver::CoupledSolver(const ContactSolver &parameters,
                               const ContactNodes &nodes,
                               const Mobility &mobility)
    : parameters(parameters)
    , nodes(nodes)
    , delassus(nodes, mobility)
  {
  }


  // Pairs that the step could close: the contact forces move a node by no more than a few times
  // what the fastest pair would do freely. All others only cost iterations.
  void
  CoupledSolver::choose_participants(std::vector<ContactPair> &pairs,
                                     const ContactNodes::Field &dx_free)
  {
    double fastest = 0.;
    for (const auto &pair : pairs)
      fastest = std::max(fastest, std::abs(pair.normal * pair.relative(dx_free)));
    const double margin = 4. * Utilities::MPI::max(fastest, nodes.get_communicator());
    participants.clear();
    indices.clear();
    for (unsigned int i = 0; i < pairs.size(); ++i)
      if (pairs[i].target_gap <= margin)
        {
          participants.push_back(&pairs[i]);
          indices.push_back(i);
        }
      else
        {
          pairs[i].normal_force     = 0.;
          pairs[i].tangential_force = Tensor<1, 3>();
        }
  }


  void
  CoupledSolver::solve_normal(std::vector<ContactPair> &pairs,
                              const ContactNodes::Field &dx_free,
                              const double effective_mass_factor)
  {
    n_iterations      = 0;
    last_residual     = 0.;
    tangential_forces = false;
    choose_participants(pairs, dx_free);
    if (Utilities::MPI::max((unsigned int)participants.size(), nodes.get_communicator()) == 0)
      return;
    delassus.reinit(participants, effective_mass_factor);
    norm     = delassus.norm_bound();
    isolated = delassus.isolated_pairs();
    weights.resize(participants.size());
    for (std::size_t i = 0; i < participants.size(); ++i)
      weights[i] = delassus.scale()[i] > 0. ? 1. / (delassus.scale()[i] * participants[i]->size) :
                                              0.;
    complementarity(dx_free);
  }


  // Gaps are to be exact relative to the cell, forces relative to themselves: what remains of a
  // violation over the violation without contact forces is the relative error of the forces.
  double
  CoupledSolver::tolerance_for(const double violation) const
  {
    constexpr double force_tolerance = 1e-9;
    return std::min(parameters.tolerance,
                    force_tolerance * Utilities::MPI::max(violation, nodes.get_communicator()));
  }


  // 0 <= t_n _|_ A t_n + n . (G (dx_f + dx_tau) + g) >= 0. Returns the largest change of a gap that
  // the new forces make, relative to the cell size.
  double
  CoupledSolver::complementarity(const ContactNodes::Field &dx_free)
  {
    const auto &s       = delassus.scale();
    const std::size_t n = participants.size();
    std::vector<double> b(n), tau(n);
    normal_violation = 0.;
    if (tangential_forces)
      {
        const auto &dx_tau = delassus.increments(
          [&](const std::size_t i) { return participants[i]->tangential_force; });
        for (std::size_t i = 0; i < n; ++i)
          b[i] = s[i] * (participants[i]->normal * participants[i]->relative(dx_tau));
      }
    for (std::size_t i = 0; i < n; ++i)
      {
        const auto &pair = *participants[i];
        b[i] += s[i] * (pair.normal * pair.relative(dx_free) + pair.target_gap);
        tau[i]           = s[i] > 0. ? pair.normal_force / s[i] : 0.;
        normal_violation = std::max(normal_violation, -weights[i] * b[i]);
      }
    last_tolerance = tolerance_for(normal_violation);
    if (last_tolerance == 0.) // nothing would close: no force at all
      tau.assign(n, 0.);
    set_isolated(HalfLine(), b, tau);

    ProjectedConjugateGradients<HalfLine> solver(nodes.get_communicator(),
                                                 last_tolerance,
                                                 parameters.limit);
    const auto result = solver.solve([&](const std::vector<double> &t,
                                         std::vector<double> &y) { delassus.apply_normal(t, y); },
                                     b,
                                     HalfLine(),
                                     weights,
                                     norm,
                                     tau);
    n_iterations += result.n_applications;
    last_residual = std::max(last_residual, result.residual);

    double change = 0.;
    for (std::size_t i = 0; i < n; ++i)
      {
        const double force = s[i] * tau[i];
        if (s[i] > 0.)
          change = std::max(change,
                            std::abs(force - participants[i]->normal_force) /
                              (s[i] * s[i] * participants[i]->size));
        participants[i]->normal_force = force;
      }
    return Utilities::MPI::max(change, nodes.get_communicator());
  }


  void
  CoupledSolver::solve_friction(const ContactNodes::Field &dx_free,
                                const std::vector<double> &friction_coefficients)
  {
    double largest = 0.;
    for (std::size_t i = 0; i < participants.size(); ++i)
      if (participants[i]->normal_force > 0.)
        largest = std::max(largest, friction_coefficients[indices[i]]);
    if (Utilities::MPI::max(largest, nodes.get_communicator()) == 0.)
      {
        for (ContactPair *const pair : participants)
          pair->tangential_force = Tensor<1, 3>();
        return;
      }

    constexpr unsigned int max_rounds = 10;
    for (unsigned int round = 0; round < max_rounds; ++round)
      {
        slip(dx_free, friction_coefficients);
        if (complementarity(dx_free) <= last_tolerance)
          break;
      }
  }


  // Friction for given normal forces: minimizes over |t_i| <= mu_i t_n,i, which makes the slip
  // P_tau G dx vanish inside the circle and oppose the force on it.
  void
  CoupledSolver::slip(const ContactNodes::Field &dx_free,
                      const std::vector<double> &friction_coefficients)
  {
    const auto &s       = delassus.scale();
    const std::size_t n = participants.size();
    Discs discs;
    // Of normal forces too: where nothing slips, slip itself is rounding and no measure.
    double violation = normal_violation;
    std::vector<Tensor<1, 3>> b(n), tau(n);
    const auto &dx_n = delassus.increments(
      [&](const std::size_t i) { return participants[i]->normal_force * participants[i]->normal; });
    for (std::size_t i = 0; i < n; ++i)
      {
        const auto &pair = *participants[i];
        b[i]   = s[i] * pair.tangential_part(pair.relative(dx_free) + pair.relative(dx_n));
        tau[i] = s[i] > 0. ? pair.tangential_part(pair.tangential_force) / s[i] : Tensor<1, 3>();
        discs.radius.push_back(
          s[i] > 0. ? friction_coefficients[indices[i]] * pair.normal_force / s[i] : 0.);
        violation = std::max(violation, weights[i] * b[i].norm());
      }
    set_isolated(discs, b, tau);
    ProjectedConjugateGradients<Discs> solver(nodes.get_communicator(),
                                              tolerance_for(violation),
                                              parameters.limit);
    const auto
      result = solver.solve([&](const std::vector<Tensor<1, 3>> &t,
                                std::vector<Tensor<1, 3>> &y) { delassus.apply_tangential(t, y); },
                            b,
                            discs,
                            weights,
                            norm,
                            tau);
    n_iterations += result.n_applications;
    last_residual     = std::max(last_residual, result.residual);
    tangential_forces = true;
    for (std::size_t i = 0; i < n; ++i)
      {
        participants[i]->tangential_force = s[i] * tau[i];
        participants[i]->sticks           = participants[i]->normal_force > 0. &&
                                  discs.is_interior(i, tau[i]);
      }
  }
} // namespace akmon
