#include <akmon/contact/nodal_sums.h>
#include <akmon/contact/reproducible_sums.h>

#include <algorithm>
#include <tuple>

namespace akmon
{
  // With the owners of nodes, which then know where they are not alone.
  void
  NodalSums::exchange_shares()
  {
    nodes.transfer_to_owners(shares);
    others_share.assign(nodes.n_owned(), false);
    for (const Share &share : shares)
      others_share[nodes.number(share.node)] = true;
  }


  void
  NodalSums::add_shares(ContactNodes::Field &field)
  {
    const auto key = [](const Share &share) {
      return std::make_tuple(share.node,
                             share.interface,
                             share.group,
                             share.slave,
                             share.slot,
                             share.others);
    };
    std::sort(shares.begin(), shares.end(), [&](const Share &a, const Share &b) {
      return key(a) < key(b);
    });
    for (const Share &share : shares)
      field.add(nodes.number(share.node), share.value);
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
