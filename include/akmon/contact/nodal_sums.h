#pragma once

#include <akmon/contact/contact_nodes.h>
#include <akmon/contact/pair.h>

#include <array>
#include <vector>

namespace akmon
{
  /**
   * Sums over contact pairs at their nodes, in an order that does not depend on the number of
   * ranks: that of their keys, which every rank's own pairs are in.
   */
  class NodalSums
  {
  public:
    explicit NodalSums(const ContactNodes &nodes)
      : nodes(nodes)
    {
    }

    /**
     * Add to a field of zeros at owned and common nodes (collective).
     * @param value  value(i, k) of pair i at its node number k
     */
    template <typename Value>
    void
    add(const std::vector<ContactPair *> &pairs, const Value &value, ContactNodes::Field &field);

  private:
    struct Share
    {
      ContactNodes::Id node;
      ContactNodes::Id slave;
      unsigned int interface, group, slot;
      std::array<ContactNodes::Id, 3> others;
      dealii::Tensor<1, 3> value;
    };

    void
    exchange_shares();
    void
    add_shares(ContactNodes::Field &field);
    void
    add_to_common_nodes(ContactNodes::Field &field);

    const ContactNodes &nodes;
    std::vector<Share> shares;
    std::vector<bool> others_share;             ///< by owned node
    std::vector<std::vector<double>> of_common; ///< by component of the common nodes
  };


  template <typename Value>
  void
  NodalSums::add(const std::vector<ContactPair *> &pairs,
                 const Value &value,
                 ContactNodes::Field &field)
  {
    const unsigned int first_common = nodes.first_common();
    of_common.resize(3 * (nodes.size() - first_common));
    for (auto &addends : of_common)
      addends.clear();
    // One function for all ranks and ways: inlined copies may round products with different sums.
    const auto value_of = [&](const std::size_t i, const unsigned int k) __attribute__((noinline))
    {
      return value(i, k);
    };
    const auto share = [&](const std::size_t i, const unsigned int k) {
      const ContactPair &pair = *pairs[i];
      shares.push_back({nodes.id(pair.nodes[k]),
                        pair.slave_id,
                        pair.interface,
                        pair.group(),
                        pair.slot,
                        pair.others,
                        value_of(i, k)});
    };

    shares.clear();
    for (std::size_t i = 0; i < pairs.size(); ++i)
      for (unsigned int k = 0; k < pairs[i]->n_nodes; ++k)
        if (const unsigned int number = pairs[i]->nodes[k]; number >= first_common)
          for (unsigned int d = 0; d < 3; ++d)
            of_common[3 * (number - first_common) + d].push_back(value_of(i, k)[d]);
        else if (number >= nodes.n_owned())
          share(i, k);
    exchange_shares();
    for (std::size_t i = 0; i < pairs.size(); ++i)
      for (unsigned int k = 0; k < pairs[i]->n_nodes; ++k)
        if (const unsigned int number = pairs[i]->nodes[k]; number < nodes.n_owned())
          others_share[number] ? share(i, k) : field.add(number, value_of(i, k));
    add_shares(field);
    if (!of_common.empty())
      add_to_common_nodes(field);
  }
} // namespace akmon
