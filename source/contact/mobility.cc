#include <akmon/contact/mobility.h>

namespace akmon
{
  using namespace dealii;

  void
  Mobility::reinit(const Discretization &discretization,
                   const EssentialConditions &conditions,
                   const ContactNodes &nodes)
  {
    ContactNodes::Field diagonal, off_diagonal;
    nodes.make(diagonal);
    nodes.make(off_diagonal);
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        const unsigned int node = nodes.local_node(i);
        const auto W_i          = conditions.projector(node) / discretization.mass[node];
        diagonal.set(i, Tensor<1, 3>({W_i[0][0], W_i[1][1], W_i[2][2]}));
        off_diagonal.set(i, Tensor<1, 3>({W_i[1][2], W_i[2][0], W_i[0][1]}));
      }
    nodes.update_ghosts(diagonal);
    nodes.update_ghosts(off_diagonal);
    reinit(nodes.size(), nodes.first_common());
    for (unsigned int i = 0; i < first_common; ++i)
      {
        SymmetricTensor<2, 3> W_i;
        for (unsigned int d = 0; d < 3; ++d)
          {
            W_i[d][d]                     = diagonal[i][d];
            W_i[(d + 1) % 3][(d + 2) % 3] = off_diagonal[i][d];
          }
        set(i, W_i);
      }
  }


  double
  Mobility::along(const ContactPair &pair,
                  const Tensor<1, 3> &direction,
                  const double mass_factor) const
  {
    const auto turn = pair.turn(direction);
    double sum      = 0.;
    for (unsigned int k = 0; k < pair.n_nodes; ++k)
      {
        const auto force = pair.at_node(k, direction, turn);
        sum += force * times(force, pair.nodes[k]);
      }
    return sum / mass_factor;
  }


  // Projectors leave rounding along what they hold.
  bool
  Mobility::is_held_along(const ContactPair &pair, const Tensor<1, 3> &direction) const
  {
    constexpr double rounding = 1e-12;

    double moved = 0., if_free = 0.;
    for (unsigned int k = 0; k < pair.n_nodes; ++k)
      {
        const unsigned int node = pair.nodes[k];
        const auto force        = pair.at_node(k, direction);
        if (is_free(node) && force.norm_square() > 0.)
          return false;
        moved += force * times(force, node);
        if_free += force.norm_square() * inverse_mass(node);
      }
    return moved <= rounding * if_free;
  }


  // A node alone may be guided along the contact plane; what is held moves with nobody.
  bool
  Mobility::moves_alike(const ContactPair &pair) const
  {
    if (pair.levered || pair.n_rotations > 0)
      return false;
    for (unsigned int k = 0; k < pair.n_nodes; ++k)
      if (const unsigned int node = pair.nodes[k];
          !is_held(node) && !(pair.n_nodes == 1 ? is_free_along(node, pair.normal) : is_free(node)))
        return false;
    return true;
  }
} // namespace akmon
