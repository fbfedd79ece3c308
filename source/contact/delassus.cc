#include <akmon/contact/delassus.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

namespace akmon
{
  using dealii::Tensor;

  Delassus::Delassus(const ContactNodes &nodes, const Mobility &mobility)
    : nodes(nodes)
    , mobility(mobility)
  {
  }


  void
  Delassus::reinit(const std::vector<ContactPair *> &new_pairs, const double new_mass_factor)
  {
    pairs       = new_pairs;
    mass_factor = new_mass_factor;
    scales.clear();
    for (const ContactPair *const pair : pairs)
      {
        const double A_ii = mobility.along(*pair, pair->normal, mass_factor);
        scales.push_back(A_ii > 0. ? 1. / std::sqrt(A_ii) : 0.);
      }
    used.clear();
    for (const ContactPair *const pair : pairs)
      used.insert(used.end(), pair->nodes.begin(), pair->nodes.begin() + pair->n_nodes);
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    nodes.make(field);
  }


  // Row sums of |A| bound its norm: node by node, the coefficients of all pairs at the node.
  double
  Delassus::norm_bound()
  {
    clear();
    for (std::size_t i = 0; i < pairs.size(); ++i)
      for (unsigned int k = 0; k < pairs[i]->n_nodes; ++k)
        field.add(pairs[i]->nodes[k],
                  Tensor<1, 3>({std::abs(pairs[i]->weights[k]) * scales[i], 0., 0.}));
    nodes.add_to_owners(field);
    nodes.update_ghosts(field);
    double largest = 0.;
    for (std::size_t i = 0; i < pairs.size(); ++i)
      {
        double row = 0.;
        for (unsigned int k = 0; k < pairs[i]->n_nodes; ++k)
          {
            const unsigned int number = pairs[i]->nodes[k];
            row += std::abs(pairs[i]->weights[k]) * scales[i] * field[number][0] *
                   mobility.inverse_mass(number) / mass_factor;
          }
        largest = std::max(largest, row);
      }
    return dealii::Utilities::MPI::max(largest, nodes.get_communicator());
  }


  std::vector<bool>
  Delassus::isolated_pairs()
  {
    clear();
    for (const ContactPair *const pair : pairs)
      for (unsigned int k = 0; k < pair->n_nodes; ++k)
        field.add(pair->nodes[k], Tensor<1, 3>({1., 0., 0.}));
    nodes.add_to_owners(field);
    nodes.update_ghosts(field);
    std::vector<bool> result;
    for (const ContactPair *const pair : pairs)
      result.push_back(std::all_of(pair->nodes.begin(),
                                   pair->nodes.begin() + pair->n_nodes,
                                   [&](const auto number) { return field[number][0] == 1.; }));
    return result;
  }


  void
  Delassus::clear()
  {
    if (nodes.is_parallel())
      nodes.make(field);
    else
      for (const unsigned int number : used)
        field.set(number, Tensor<1, 3>());
  }


  void
  Delassus::forces_to_increments()
  {
    const auto to_increment = [&](const unsigned int number) {
      field.set(number, mobility[number] * field[number] / mass_factor);
    };
    if (!nodes.is_parallel())
      {
        for (const unsigned int number : used)
          to_increment(number);
        return;
      }
    nodes.add_to_owners(field);
    for (unsigned int number = 0; number < nodes.n_owned(); ++number)
      to_increment(number);
    nodes.update_ghosts(field);
  }


  void
  Delassus::apply_normal(const std::vector<double> &tau, std::vector<double> &y)
  {
    increments([&](const std::size_t i) { return (scales[i] * tau[i]) * pairs[i]->normal; });
    for (std::size_t i = 0; i < pairs.size(); ++i)
      y[i] = scales[i] * (pairs[i]->normal * pairs[i]->relative(field));
  }


  void
  Delassus::apply_tangential(const std::vector<Tensor<1, 3>> &tau, std::vector<Tensor<1, 3>> &y)
  {
    increments([&](const std::size_t i) { return scales[i] * tau[i]; });
    for (std::size_t i = 0; i < pairs.size(); ++i)
      y[i] = scales[i] * pairs[i]->tangential_part(pairs[i]->relative(field));
  }
} // namespace akmon
