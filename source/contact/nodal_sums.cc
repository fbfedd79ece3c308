#include <akmon/contact/nodal_sums.h>
#include <akmon/contact/reproducible_sums.h>

#include <algorithm>
#include <numeric>
#include <tuple>

namespace akmon
{
  void
  NodalSums::add_shares(ContactNodes::Field &field)
  {
    nodes.transfer_to_owners(shares);
    if (order.size() != shares.size())
      {
        const auto key = [&](const unsigned int i) {
          const Share &share = shares[i];
          return std::make_tuple(share.node,
                                 share.interface,
                                 share.of_edges,
                                 share.reversed,
                                 share.slave,
                                 share.slot,
                                 share.others);
        };
        order.resize(shares.size());
        std::iota(order.begin(), order.end(), 0U);
        std::sort(order.begin(), order.end(), [&](const auto a, const auto b) {
          return key(a) < key(b);
        });
      }
    for (const unsigned int i : order)
      field.add(nodes.number(shares[i].node), shares[i].value);
  }


  // All ranks may have many pairs with a rigid body.
  void
  NodalSums::add_to_common_nodes(ContactNodes::Field &field)
  {
    const auto sums = reproducible_sums(of_common, nodes.get_communicator());
    for (unsigned int i = 0; i < sums.size() / 3; ++i)
      field.set(nodes.first_common() + i,
                dealii::Tensor<1, 3>({sums[3 * i], sums[3 * i + 1], sums[3 * i + 2]}));
  }
} // namespace akmon
