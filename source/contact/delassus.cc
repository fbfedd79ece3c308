#include <akmon/contact/bonds.h>
#include <akmon/contact/delassus.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

namespace akmon
{
  using dealii::Tensor;

  namespace
  {
    // A unit vector and two others that complete it to an orthonormal frame.
    Tensor<2, 3>
    frame_of(const Tensor<1, 3> &normal)
    {
      unsigned int smallest = 0;
      for (unsigned int d = 1; d < 3; ++d)
        if (std::abs(normal[d]) < std::abs(normal[smallest]))
          smallest = d;
      Tensor<1, 3> axis;
      axis[smallest]     = 1.;
      Tensor<1, 3> first = cross_product_3d(normal, axis);
      first /= first.norm();
      Tensor<2, 3> frame;
      frame[0] = normal;
      frame[1] = first;
      frame[2] = cross_product_3d(normal, first);
      return frame;
    }
  } // namespace


  Delassus::Delassus(const ContactNodes &nodes, const Mobility &mobility, const Bonds *const bonds)
    : nodes(nodes)
    , mobility(mobility)
    , bonds(bonds)
    , sums(nodes)
  {
  }


  void
  Delassus::reinit(const std::vector<ContactPair *> &new_pairs, const double new_mass_factor)
  {
    pairs       = new_pairs;
    mass_factor = new_mass_factor;
    scales.clear();
    frames.clear();
    for (const ContactPair *const pair : pairs)
      {
        const double A_ii = mobility.along(*pair, pair->normal, mass_factor);
        scales.push_back(A_ii > 0. ? 1. / std::sqrt(A_ii) : 0.);
        frames.push_back(frame_of(pair->normal));
      }
    used.clear();
    for (const ContactPair *const pair : pairs)
      used.insert(used.end(), pair->nodes.begin(), pair->nodes.begin() + pair->n_nodes);
    if (is_bonded())
      bonds->add_nodes(used);
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    nodes.make(field);
    sums.forget();
  }


  // Row sums of the norms of A's blocks bound its norm: node by node, the coefficients of all pairs
  // at the node.
  double
  Delassus::norm_bound()
  {
    const auto coefficient = [&](const std::size_t i, const unsigned int k) {
      return pairs[i]->bound_at_node(k) * scales[i];
    };
    clear();
    sums.add(
      pairs,
      [&](const std::size_t i, const unsigned int k) {
        return Tensor<1, 3>({coefficient(i, k), 0., 0.});
      },
      field);
    nodes.update_ghosts(field);
    double largest = 0.;
    for (std::size_t i = 0; i < pairs.size(); ++i)
      {
        double row = 0.;
        for (unsigned int k = 0; k < pairs[i]->n_nodes; ++k)
          {
            const unsigned int number = pairs[i]->nodes[k];
            row += coefficient(i, k) * field[number][0] * mobility.inverse_mass(number) /
                   mass_factor;
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
    std::vector<unsigned int> bonded;
    if (is_bonded())
      bonds->add_nodes(bonded);
    for (const unsigned int number : bonded)
      field.add(number, Tensor<1, 3>({1., 0., 0.}));
    nodes.add_to_owners(field);
    nodes.update_ghosts(field);
    std::vector<bool> result;
    for (const ContactPair *const pair : pairs)
      {
        // A node alone may be guided along the contact plane; what is held moves with nobody.
        bool isolated = !pair->levered;
        for (unsigned int k = 0; k < pair->n_nodes; ++k)
          {
            const unsigned int number = pair->nodes[k];
            isolated                  = isolated &&
                       (mobility.is_held(number) ||
                        (field[number][0] == 1. &&
                         (pair->n_nodes == 1 ? mobility.is_free_along(number, pair->normal) :
                                               mobility.is_free(number))));
          }
        result.push_back(isolated);
      }
    return result;
  }


  bool
  Delassus::is_bonded() const
  {
    return bonds && bonds->exist();
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
        if (is_bonded())
          bonds->project(field);
        return;
      }
    for (unsigned int number = 0; number < nodes.n_owned(); ++number)
      to_increment(number);
    for (unsigned int number = nodes.first_common(); number < nodes.size(); ++number)
      to_increment(number);
    if (is_bonded())
      bonds->project(field);
    nodes.update_ghosts(field);
  }


  void
  Delassus::apply(const Vector &tau, Vector &y)
  {
    increments([&](const std::size_t i) { return scales[i] * (tau[i] * frames[i]); });
    for (std::size_t i = 0; i < pairs.size(); ++i)
      y[i] = scales[i] * (frames[i] * pairs[i]->relative(field));
  }
} // namespace akmon
