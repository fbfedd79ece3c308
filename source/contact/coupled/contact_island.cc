#include <akmon/contact/bonds/bonds.h>
#include <akmon/contact/coupled/active_set.h>
#include <akmon/contact/coupled/contact_island.h>
#include <akmon/contact/coupled/gauss_seidel.h>

#include <algorithm>
#include <cmath>

namespace akmon
{
  using namespace dealii;

  void
  ContactIsland::reinit(const ContactNodes::Id first_common_id,
                        const Bonds *const bonds,
                        const double effective_mass_factor)
  {
    // Pairs. Of rigid bodies, which couple many that share nothing else, more.
    constexpr std::size_t most_assembled = 20;

    result                     = {0, 0., true};
    problem.start_is_reference = false;
    mass_factor                = effective_mass_factor;
    has_bonds                  = bonds != nullptr;
    if (!has_bonds &&
        (members.size() <= most_assembled ||
         (members.size() <= most_of_rigid_bodies && has_rigid_bodies(first_common_id))))
      assemble();
    else
      {
        number_nodes(first_common_id);
        delassus.reinit(pairs, mobility, mass_factor);
        if (has_bonds)
          delassus.set_bonds(*bonds, ids);
        preconditioner.set_pairs(pairs, delassus, mobility, mass_factor);
      }
    problem.norm = delassus.norm_bound();
    problem.friction.clear();
    problem.weights.clear();
    tau.clear();
    solved_gaps.clear();
    for (std::size_t i = 0; i < members.size(); ++i)
      {
        const ContactPair &pair = *members[i]->pair;
        const double s          = delassus.scale()[i];
        problem.friction.push_back(members[i]->friction);
        problem.weights.push_back(s > 0. ? 1. / (s * pair.size) : 0.);
        tau.push_back(s > 0. ? delassus.frame(i) * pair.force() / s : Tensor<1, 3>());
      }
  }


  bool
  ContactIsland::has_rigid_bodies(const ContactNodes::Id first_common_id) const
  {
    return std::any_of(members.begin(), members.end(), [&](const ClosingPair *const member) {
      return std::any_of(member->ids.begin(),
                         member->ids.begin() + member->pair->n_nodes,
                         [&](const ContactNodes::Id id) { return id >= first_common_id; });
    });
  }


  void
  ContactIsland::assemble()
  {
    delassus.assemble(members, mass_factor);
    preconditioner.set_matrix(delassus);
  }


  void
  ContactIsland::number_nodes(const ContactNodes::Id first_common_id)
  {
    ids.clear();
    for (const ClosingPair *const member : members)
      ids.insert(ids.end(), member->ids.begin(), member->ids.begin() + member->pair->n_nodes);
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    const auto number = [&](const ContactNodes::Id id) {
      return static_cast<unsigned int>(std::lower_bound(ids.begin(), ids.end(), id) - ids.begin());
    };
    mobility.reinit(ids.size(), number(first_common_id));
    pairs.clear();
    for (const ClosingPair *const member : members)
      {
        pairs.push_back(*member->pair);
        for (unsigned int k = 0; k < member->pair->n_nodes; ++k)
          {
            const unsigned int node = number(member->ids[k]);
            pairs.back().nodes[k]   = node;
            mobility.set(node, member->mobility[k]);
          }
      }
  }


  bool
  ContactIsland::is_solved() const
  {
    return std::equal(solved_gaps.begin(),
                      solved_gaps.end(),
                      members.begin(),
                      members.end(),
                      [](const double gap, const ClosingPair *const member) {
                        return gap == member->pair->target_gap;
                      });
  }


  void
  ContactIsland::pose(const ContactSolver &parameters, const double tolerance)
  {
    // Of a pair's own mobility: enough to make repeated constraints regular, and of no consequence
    // for gaps (SemismoothNewton).
    constexpr double compliance = 1e-7;

    problem.tolerance  = tolerance;
    problem.sufficient = std::max(parameters.tolerance, tolerance);
    // Where Newton steps found no friction in this step they would not now: one of them, and on to
    // what solve() tries after them.
    problem.limit      = result.converged || !problem.rubs() ? parameters.limit : 1;
    problem.compliance = compliance;
    problem.b.resize(members.size());
    solved_gaps.resize(members.size());
    const auto &s = delassus.scale();
    for (std::size_t i = 0; i < members.size(); ++i)
      {
        solved_gaps[i] = members[i]->pair->target_gap;
        problem.b[i]   = s[i] * (delassus.frame(i) * members[i]->free_motion);
        problem.b[i][0] += s[i] * solved_gaps[i];
      }
  }


  void
  ContactIsland::solve(const ContactSolver &parameters, Newton &newton)
  {
    constexpr unsigned int patience = 1; // iterations that old factors may cost more than new ones

    result                     = newton.solve(problem, delassus, preconditioner, tau, faces);
    problem.start_is_reference = true; // of the next gaps of the same step
    if (!result.converged && !problem.rubs())
      solve_one_by_one();
    else if (!result.converged && !has_bonds && members.size() <= most_restarted)
      start_elsewhere(parameters.limit, newton);
    if (!result.converged && problem.rubs() && result.residual > nearly &&
        largest_overlap() > problem.sufficient)
      let_slip(parameters.limit, newton);
    if (!preconditioner.is_old())
      iterations_when_new = result.n_applications;
    else if (result.n_applications > iterations_when_new + patience)
      preconditioner.forget();
    take_forces();
  }


  void
  ContactIsland::take(const NewtonLanes::Problem &lane)
  {
    result                     = {lane.n_applications, lane.residual, true};
    problem.start_is_reference = true; // of the next gaps of the same step
    take_forces();
  }


  // Of the solution.
  void
  ContactIsland::take_forces()
  {
    const auto &s = delassus.scale();
    forces.resize(members.size());
    for (std::size_t i = 0; i < members.size(); ++i)
      {
        const auto force     = s[i] * tau[i];
        const auto &frame    = delassus.frame(i);
        forces[i].normal     = force[0];
        forces[i].tangential = force[1] * frame[1] + force[2] * frame[2];
        // On the circle up to rounding is sliding.
        forces[i].sticks = force[0] > 0. && forces[i].tangential.norm() <
                                              (1. - 1e-12) * problem.friction[i] * force[0];
      }
  }


  // Where no solution was found there may be one all the same, or forces that are nearly one, which
  // are better than made-up friction.
  void
  ContactIsland::start_elsewhere(const unsigned int limit, Newton &newton)
  {
    constexpr unsigned int n_sweeps = 200;

    if (delassus.matrix().size() == 0)
      assemble();
    auto best                   = tau;
    Newton::Result best_result  = result;
    unsigned int n_applications = result.n_applications;
    problem.limit               = limit;
    result = newton.follow_compliance(problem, delassus, preconditioner, tau, faces);
    n_applications += result.n_applications;
    if (!result.converged)
      tau = best;
    for (const bool from_zero : {false, true})
      {
        if (result.converged)
          break;
        if (from_zero)
          tau.assign(tau.size(), {});
        sweep(delassus.matrix(), problem, n_sweeps, tau);
        if (const double left = residual(); left < std::min(best_result.residual, nearly))
          {
            best                 = tau;
            best_result.residual = left;
          }
        result = newton.solve(problem, delassus, preconditioner, tau, faces);
        n_applications += n_sweeps + result.n_applications;
      }
    if (!result.converged)
      {
        tau              = best;
        result           = best_result;
        result.converged = result.residual <= problem.sufficient;
      }
    result.n_applications = n_applications;
  }


  // As SemismoothNewton measures it.
  double
  ContactIsland::residual()
  {
    CompliantProblem<Delassus> forces_alone;
    forces_alone.begin(problem, delassus);
    forces_alone.set_reference(tau);
    forces_alone.set_compliance(problem.compliance);
    forces_alone.evaluate(tau);
    return forces_alone.measure(tau);
  }


  // Where constraints without friction nearly repeat each other, which Newton's steps, all pairs at
  // once, may not find out of.
  void
  ContactIsland::solve_one_by_one()
  {
    constexpr unsigned int most = 400; // pairs: the time grows with their third power

    const unsigned int n = members.size();
    if (n > most)
      return;
    Eigen::MatrixXd A(n, n);
    Eigen::VectorXd b(n), weights(n), t;
    Delassus::Vector unit(n), image(n);
    for (unsigned int j = 0; j < n; ++j)
      {
        unit[j][0] = 1.;
        delassus.apply(unit, image);
        unit[j][0] = 0.;
        for (unsigned int i = 0; i < n; ++i)
          A(i, j) = image[i][0];
        b[j]       = problem.b[j][0];
        weights[j] = problem.weights[j];
      }
    result.n_applications += n;
    if (!solve_by_active_set(A, b, weights, 0.5 * problem.tolerance, t))
      return;
    for (unsigned int i = 0; i < n; ++i)
      {
        tau[i]          = Delassus::Vector::value_type({std::max(0., t[i]), 0., 0.});
        faces[i]        = CoulombFace();
        faces[i].normal = t[i] > 0.;
      }
    result.residual  = largest_overlap();
    result.converged = result.residual <= problem.sufficient;
  }


  // By which gaps are less than they should be, over the size of the pair.
  double
  ContactIsland::largest_overlap()
  {
    auto w = tau;
    delassus.apply(tau, w);
    double largest = 0.;
    for (std::size_t i = 0; i < members.size(); ++i)
      largest = std::max(largest, -problem.weights[i] * (w[i][0] + problem.b[i][0]));
    return largest;
  }


  // Bodies that are wedged may have no forces with any friction that could be found: they slip
  // freely in this step.
  void
  ContactIsland::let_slip(const unsigned int limit, Newton &newton)
  {
    const unsigned int n_applications = result.n_applications;
    const auto friction               = problem.friction;
    problem.friction.assign(friction.size(), 0.);
    problem.limit = limit;
    tau.assign(tau.size(), {});
    result = newton.solve(problem, delassus, preconditioner, tau, faces);
    if (!result.converged)
      solve_one_by_one();
    problem.friction = friction;
    result.n_applications += n_applications;
    result.converged = false; // with friction
  }
} // namespace akmon
