#include <akmon/contact/bonds/bonds.h>
#include <akmon/contact/coupled/contact_response.h>

namespace akmon
{
  ContactResponse::ContactResponse(const ContactNodes &nodes,
                                   const Mobility &mobility,
                                   const Bonds *const bonds)
    : nodes(nodes)
    , mobility(mobility)
    , bonds(bonds)
    , sums(nodes)
  {
  }


  void
  ContactResponse::reinit(const std::vector<ContactPair *> &new_pairs, const double new_mass_factor)
  {
    pairs       = new_pairs;
    mass_factor = new_mass_factor;
  }


  void
  ContactResponse::update()
  {
    loaded.clear();
    loads.clear();
    for (ContactPair *const pair : pairs)
      if (pair->normal_force > 0.)
        {
          loaded.push_back(pair);
          loads.push_back({pair->force(), pair->turn(pair->force())});
        }
    nodes.make(field);
    sums.add(
      loaded,
      [&](const std::size_t i, const unsigned int k) {
        return loaded[i]->at_node(k, loads[i].force, loads[i].turn);
      },
      field);
    const auto to_increment = [&](const unsigned int number) {
      if (const auto force = field[number]; force != dealii::Tensor<1, 3>()) // few nodes have one
        field.set(number, mobility.times(force, number) / mass_factor);
    };
    for (unsigned int number = 0; number < nodes.n_owned(); ++number)
      to_increment(number);
    for (unsigned int number = nodes.first_common(); number < nodes.size(); ++number)
      to_increment(number);
    if (bonds && bonds->exist())
      bonds->project(field);
    nodes.update_ghosts(field);
  }
} // namespace akmon
