#include <akmon/contact/coulomb.h>
#include <akmon/contact/coupled/coupled_solver.h>
#include <akmon/contact/work_time.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

namespace akmon
{
  using namespace dealii;

  namespace
  {
    // Where rigid bodies touch at more points than it takes, the gaps disagree by rounding, which
    // nothing can move: relative to the size of the pairs.
    double
    rounding_of_rigid_gaps(const std::vector<ContactPair *> &pairs)
    {
      constexpr double rounding = 1e-15;

      double largest = 0.;
      for (const ContactPair *const pair : pairs)
        if (!pair->has_slave_node())
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
    , mobility(mobility)
    , bonds(bonds)
    , rank(Utilities::MPI::this_mpi_process(nodes.get_communicator()))
    , response(nodes, mobility, bonds)
  {
  }


  // Pairs that the step could close: the contact forces move a node by no more than a few times
  // what the fastest pair would do freely. What rigid bodies' rims touch may be elsewhere then.
  void
  CoupledSolver::choose_participants(std::vector<ContactPair> &pairs,
                                     const std::vector<double> &friction_of_pairs)
  {
    double fastest = 0.;
    for (const auto &pair : pairs)
      fastest = std::max(fastest, std::abs(pair.normal * pair.relative(*free_increments)));
    const double margin = 4. * Utilities::MPI::max(fastest, nodes.get_communicator());
    all.clear();
    friction_of_all.clear();
    active.clear();
    for (std::size_t i = 0; i < pairs.size(); ++i)
      if (pairs[i].target_gap <= margin || pairs[i].kind == ContactPair::Kind::rigid_touch)
        {
          all.push_back(&pairs[i]);
          friction_of_all.push_back(friction_of_pairs[i]);
          active.push_back(pairs[i].normal_force > 0.);
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
    n_applications = n_coupled = last_residual = 0.;
    all_converged                              = true;
    mass_factor                                = effective_mass_factor;
    free_increments                            = &dx_free;
    take_up_anew(pairs, friction_of_pairs);
    const bool friction_here = std::any_of(friction_of_all.begin(),
                                           friction_of_all.end(),
                                           [](const double mu) { return mu > 0.; });
    friction_somewhere = Utilities::MPI::max(int(friction_here), nodes.get_communicator()) > 0;
  }


  void
  CoupledSolver::take_up_anew(std::vector<ContactPair> &pairs,
                              const std::vector<double> &friction_of_pairs)
  {
    choose_participants(pairs, friction_of_pairs);
    response.reinit(all, mass_factor);
    has_begun = false;
    for (const auto &island : islands)
      island->of_this_step = false;
  }


  void
  CoupledSolver::solve()
  {
    const double tolerance = tolerance_for();
    bool join              = activate(nullptr, 0.) || !has_begun;
    has_begun              = true;
    do
      {
        if (join)
          divide_into_islands();
        else
          take_target_gaps();
        solve_lone_pairs();
        solve_islands(tolerance);
        bring_forces_home();
        response.update();
        join = activate(&response.increments(), tolerance);
      }
    while (join);
  }


  // n . G (dx_f + caused) + g
  double
  CoupledSolver::gap_after(const ContactPair &pair, const ContactNodes::Field *const caused) const
  {
    const double gap = pair.normal * pair.relative(*free_increments) + pair.target_gap;
    return caused ? gap + pair.normal * pair.relative(*caused) : gap;
  }


  // Gaps are to be exact relative to the cell, forces relative to themselves: what remains of a
  // violation over the violation without contact forces is the relative error of the forces. Gaps
  // are not known better than to rounding, though.
  double
  CoupledSolver::tolerance_for() const
  {
    constexpr double force_tolerance = 1e-11, rounding = 1e-14;

    double violation = 0.;
    for (const ContactPair *const pair : all)
      violation = std::max(violation, -gap_after(*pair, nullptr) / pair->size);
    const double relative = force_tolerance *
                            Utilities::MPI::max(violation, nodes.get_communicator());
    return std::max(std::min(parameters.tolerance, std::max(relative, rounding)),
                    Utilities::MPI::max(rounding_of_rigid_gaps(all), nodes.get_communicator()));
  }


  // Pairs join that penetrate by more than what is tolerated, relative to the cell size, and that
  // forces can move. Whether there are any, on any rank.
  bool
  CoupledSolver::activate(const ContactNodes::Field *const caused, const double tolerance)
  {
    bool any = false;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (!active[i] && gap_after(*all[i], caused) < -tolerance * all[i]->size &&
          mobility.along(*all[i], all[i]->normal, mass_factor) > 0.)
        any = active[i] = true;
    return Utilities::MPI::max(int(any), nodes.get_communicator()) > 0;
  }


  // A_ii is a multiple of the identity, at least where the nodes can move: (80) and (82).
  void
  CoupledSolver::solve_lone_pairs()
  {
    const WorkTime timing(seconds_of_work);
    for (const unsigned int i : lone)
      {
        ContactPair &pair      = *all[i];
        const auto free_motion = pair.relative(*free_increments);
        const double A_ii      = mobility.along(pair, pair.normal, mass_factor);
        const double stiffness = A_ii > 0. ? 1. / A_ii : 0.; // else forces move nothing
        const double gap       = pair.normal * free_motion + pair.target_gap;
        pair.normal_force      = std::max(0., -stiffness * gap);
        const auto friction    = Coulomb::tangential_force(-stiffness *
                                                          pair.tangential_part(free_motion),
                                                        friction_of_all[i] * pair.normal_force);
        pair.tangential_force  = friction.force;
        pair.sticks            = friction.sticks;
      }
  }


  // Small ones as many at a time as there are lanes, of about the same size.
  void
  CoupledSolver::solve_islands(const double tolerance)
  {
    {
      const WorkTime timing(seconds_of_work);
      small.clear();
      for (const auto &island : islands)
        {
          island->is_new = !island->is_solved();
          if (!island->is_new)
            continue;
          island->pose(parameters, tolerance);
          if (island->fits_lane())
            small.push_back(island.get());
          else
            island->solve(parameters, newton);
        }
      std::stable_sort(small.begin(), small.end(), [](const Island *a, const Island *b) {
        return a->get_members().size() < b->get_members().size();
      });
      for (std::size_t i = 0; i < small.size(); i += n_lanes)
        solve_side_by_side(&small[i],
                           small.data() + std::min<std::size_t>(i + n_lanes, small.size()));
    }
    count_solutions();
  }


  // What takes more than the lanes do is solved alone.
  void
  CoupledSolver::solve_side_by_side(Island *const *const begin, Island *const *const end)
  {
    problems.clear();
    for (auto island = begin; island != end; ++island)
      problems.push_back((*island)->lane());
    lanes.solve(problems);
    for (auto island = begin; island != end; ++island)
      if (const auto &problem = problems[island - begin]; problem.is_solved)
        (*island)->take(problem);
      else
        (*island)->solve(parameters, newton);
  }


  // Of all islands and ranks, those solved just now.
  void
  CoupledSolver::count_solutions()
  {
    std::vector<double> sums(2, 0.), worst(2, 0.);
    for (const auto &island : islands)
      {
        const double n = island->get_members().size();
        sums[1] += n;
        if (!island->is_new)
          continue;
        const auto &result = island->get_result();
        sums[0] += n * result.n_applications;
        worst[0] = std::max(worst[0], result.residual);
        worst[1] = std::max(worst[1], result.converged ? 0. : 1.);
      }
    Utilities::MPI::sum(sums, nodes.get_communicator(), sums);
    Utilities::MPI::max(worst, nodes.get_communicator(), worst);
    n_applications += sums[0];
    n_coupled     = sums[1];
    last_residual = std::max(last_residual, worst[0]);
    all_converged = all_converged && worst[1] == 0.;
  }


  unsigned int
  CoupledSolver::iterations() const
  {
    return n_coupled > 0. ? static_cast<unsigned int>(std::ceil(n_applications / n_coupled)) : 0;
  }
} // namespace akmon
