#include <akmon/contact/bonds/bonds.h>
#include <akmon/contact/coupled/delassus.h>

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


  void
  Delassus::reinit(const std::vector<ContactPair> &new_pairs,
                   const Mobility &new_mobility,
                   const double new_mass_factor)
  {
    pairs       = &new_pairs;
    mobility    = &new_mobility;
    bonds       = nullptr;
    mass_factor = new_mass_factor;
    scales.clear();
    frames.clear();
    for (const ContactPair &pair : *pairs)
      {
        const double A_ii = mobility->along(pair, pair.normal, mass_factor);
        scales.push_back(A_ii > 0. ? 1. / std::sqrt(A_ii) : 0.);
        frames.push_back(frame_of(pair.normal));
      }
    field.reinit(mobility->size());
    assembled.resize(0, 0);
  }


  void
  Delassus::assemble(const ClosingPairs &members, const double new_mass_factor)
  {
    bonds       = nullptr;
    mass_factor = new_mass_factor;
    scales.clear();
    frames.clear();
    columns.clear();
    begins.assign(1, 0);
    for (const ClosingPair *const member : members)
      collect_columns(*member);

    assembled.setZero(3 * members.size(), 3 * members.size());
    for (std::size_t i = 0; i < members.size(); ++i)
      for (std::size_t j = 0; j <= i; ++j)
        {
          double block[3][3] = {}; // by column
          bool any           = false;
          for (unsigned int k = begins[i]; k < begins[i + 1]; ++k)
            for (unsigned int l = begins[j]; l < begins[j + 1]; ++l)
              if (columns[k].node == columns[l].node)
                {
                  any = true;
                  for (unsigned int c = 0; c < 3; ++c)
                    for (unsigned int r = 0; r < 3; ++r)
                      block[c][r] += columns[k].force[r] * columns[l].increment[c];
                }
          if (!any)
            continue;
          for (unsigned int c = 0; c < 3; ++c)
            for (unsigned int r = 0; r < 3; ++r)
              assembled(3 * i + r, 3 * j + c) = assembled(3 * j + c, 3 * i + r) = block[c][r];
        }
  }


  // Of a pair, with its frame and scale.
  void
  Delassus::collect_columns(const ClosingPair &member)
  {
    const ContactPair &pair = *member.pair;
    const auto frame        = frame_of(pair.normal);
    frames.push_back(frame);
    const std::array<Tensor<1, 3>, 3> turns{
      {pair.turn(frame[0]), pair.turn(frame[1]), pair.turn(frame[2])}};
    const double inverse_factor = 1. / mass_factor;
    double A_ii                 = 0.;
    for (unsigned int k = 0; k < pair.n_nodes; ++k)
      if (trace(member.mobility[k]) > 0.) // else it is held
        {
          Column &column = columns.emplace_back(); // a copy would wait for what was stored
          column.node    = member.ids[k];
          for (unsigned int d = 0; d < 3; ++d)
            {
              column.force[d]     = pair.at_node(k, frame[d], turns[d]);
              column.increment[d] = inverse_factor * (member.mobility[k] * column.force[d]);
            }
          A_ii += column.force[0] * column.increment[0];
        }
    scales.push_back(A_ii > 0. ? 1. / std::sqrt(A_ii) : 0.);
    for (auto column = columns.begin() + begins.back(); column != columns.end(); ++column)
      for (unsigned int d = 0; d < 3; ++d)
        {
          column->force[d] *= scales.back();
          column->increment[d] *= scales.back();
        }
    begins.push_back(columns.size());
  }


  // Row sums of the norms of A's blocks bound its norm: node by node, the coefficients of all pairs
  // at the node.
  double
  Delassus::norm_bound()
  {
    if (assembled.size() > 0)
      return assembled.cwiseAbs().rowwise().sum().maxCoeff();
    at_node.assign(mobility->size(), 0.);
    for (std::size_t i = 0; i < pairs->size(); ++i)
      for (unsigned int k = 0; k < (*pairs)[i].n_nodes; ++k)
        at_node[(*pairs)[i].nodes[k]] += (*pairs)[i].bound_at_node(k) * scales[i];
    double largest = 0.;
    for (std::size_t i = 0; i < pairs->size(); ++i)
      {
        double row = 0.;
        for (unsigned int k = 0; k < (*pairs)[i].n_nodes; ++k)
          {
            const unsigned int node = (*pairs)[i].nodes[k];
            row += (*pairs)[i].bound_at_node(k) * scales[i] * at_node[node] *
                   mobility->inverse_mass(node) / mass_factor;
          }
        largest = std::max(largest, row);
      }
    return largest;
  }


  void
  Delassus::apply(const Vector &tau, Vector &y)
  {
    if (assembled.size() > 0)
      {
        const auto n = assembled.rows();
        Eigen::Map<Eigen::VectorXd>(y.front().begin_raw(), n)
          .noalias() = assembled * Eigen::Map<const Eigen::VectorXd>(tau.front().begin_raw(), n);
        return;
      }
    field.clear();
    for (std::size_t i = 0; i < pairs->size(); ++i)
      (*pairs)[i].distribute(scales[i] * (tau[i] * frames[i]), field);
    for (unsigned int node = 0; node < mobility->size(); ++node)
      field.set(node, mobility->times(field[node], node) / mass_factor);
    if (bonds)
      bonds->project(*ids, field);
    for (std::size_t i = 0; i < pairs->size(); ++i)
      y[i] = scales[i] * (frames[i] * (*pairs)[i].relative(field));
  }
} // namespace akmon
