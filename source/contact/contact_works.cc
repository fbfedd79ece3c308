#include <akmon/contact/bonds/bonds.h>
#include <akmon/contact/contact.h>

#include <map>

// What bonds add to step 7 of Contact, and the works of all forces.

namespace akmon
{
  using namespace dealii;

  // Of the bonds, which hold what contact moves too.
  void
  Contact::add_bond_forces(NodalState &state, const double effective_mass_factor)
  {
    std::map<unsigned int, Tensor<1, 3>> of_contact;
    if (bonds->exist())
      for (const auto &force : forces)
        of_contact[force.node] += force.normal + force.tangential;
    for (const auto &force : bonds->finish_step(effective_mass_factor, of_contact))
      {
        const auto increment = force.sum() /
                               (discretization.mass[force.node] * effective_mass_factor);
        for (unsigned int d = 0; d < 3; ++d)
          state.dx_next.local_element(3 * force.node + d) += increment[d];
      }
  }


  std::vector<Contact::Work>
  Contact::works(const NodalVector &increment, RigidIncrement (RigidBody::*motion)() const) const
  {
    std::vector<Work> sums(contacts.size() + bodies.size());
    for (const auto &force : forces)
      {
        const auto step = at_node(increment, force.node);
        sums[force.interface].normal += force.normal * step;
        sums[force.interface].tangential += force.tangential * step;
      }
    for (const auto &force : bonds->nodal_forces())
      {
        const auto step = at_node(increment, force.node);
        sums[force.interface].holding += force.holding * step;
        sums[force.interface].failing += force.failing * step;
      }
    if (rigid_nodes.n == 0)
      return sums;
    std::vector<Tensor<1, 3>> steps(rigid_nodes.n);
    for (unsigned int i = 0; i < bodies.size(); ++i)
      if (bodies[i].moves())
        {
          const RigidIncrement step       = (bodies[i].*motion)();
          steps[rigid_nodes.first[i]]     = step.centre;
          steps[rigid_nodes.first[i] + 1] = step.rotation;
        }
    visit_rigid_loads([&](const unsigned int interface,
                          const unsigned int i,
                          const Tensor<1, 3> &normal,
                          const Tensor<1, 3> &tangential) {
      sums[interface].normal += normal * steps[i];
      sums[interface].tangential += tangential * steps[i];
    });
    return sums;
  }
} // namespace akmon
