#include <akmon/contact/coupled/elimination_fronts.h>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <limits>
#include <numeric>

namespace akmon
{
  namespace
  {
    constexpr unsigned int none = std::numeric_limits<unsigned int>::max();


    // Whether entries that are zero cost less than a front of its own.
    bool
    are_few(const unsigned int n_zeros, const EliminationFronts::Front &front)
    {
      constexpr unsigned int small = 8; // pivots
      constexpr double of_small = 0.3, of_large = 0.08;

      return n_zeros <
             (front.n_pivots() <= small ? of_small : of_large) * front.n_pivots() * front.size();
    }
  } // namespace


  void
  EliminationFronts::reinit(const unsigned int n, const std::vector<Edge> &new_edges)
  {
    if (n == positions.size() && new_edges == given)
      return;
    given = edges = new_edges;
    positions.resize(n);
    order_for_few_entries();
    find_parents();
    order_by_subtrees();
    count_changes();
    make_fronts();
    collect_below();
  }


  void
  EliminationFronts::order_for_few_entries()
  {
    const unsigned int n = positions.size();
    std::vector<Eigen::Triplet<double>> pattern;
    for (unsigned int i = 0; i < n; ++i) // without, the order is left as it is
      pattern.emplace_back(i, i, 1.);
    for (const auto &[a, b] : edges)
      {
        pattern.emplace_back(a, b, 1.);
        pattern.emplace_back(b, a, 1.);
      }
    Eigen::SparseMatrix<double> graph(n, n);
    graph.setFromTriplets(pattern.begin(), pattern.end());
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
    Eigen::AMDOrdering<int>()(graph, order);
    std::vector<unsigned int> places(n);
    for (unsigned int i = 0; i < n; ++i)
      places[order.indices()[i]] = i;
    std::iota(positions.begin(), positions.end(), 0U);
    renumber(places);
  }


  void
  EliminationFronts::renumber(const std::vector<unsigned int> &new_positions)
  {
    for (unsigned int &position : positions)
      position = new_positions[position];
    for (Edge &edge : edges)
      edge = {{std::min(new_positions[edge[0]], new_positions[edge[1]]),
               std::max(new_positions[edge[0]], new_positions[edge[1]])}};
    by_later.fill(positions.size(), edges.size(), [&](const unsigned int e) {
      return edges[e][1];
    });
  }


  // The parent of a row is the first that it changes. Shortcuts lead up the tree (Liu, ACM Trans.
  // Math. Softw. 12, 1986).
  void
  EliminationFronts::find_parents()
  {
    const unsigned int n = positions.size();
    parents.assign(n, none);
    auto &ancestors = marks;
    ancestors.assign(n, none);
    for (unsigned int i = 0; i < n; ++i)
      for (const unsigned int e : by_later[i])
        for (unsigned int k = edges[e][0]; k != i;)
          {
            const unsigned int next = ancestors[k];
            ancestors[k]            = i;
            if (next == none)
              parents[k] = i;
            k = next == none ? i : next;
          }
  }


  // Every subtree in one piece: from the end, each row takes the last place of what is left of its
  // parent's.
  void
  EliminationFronts::order_by_subtrees()
  {
    const unsigned int n = positions.size();
    auto &sizes          = counts;
    sizes.assign(n, 1);
    for (unsigned int i = 0; i < n; ++i)
      if (parents[i] != none)
        sizes[parents[i]] += sizes[i];
    std::vector<unsigned int> places(n), ends(n);
    unsigned int end = n; // of what is left for roots
    for (unsigned int i = n; i-- > 0;)
      {
        unsigned int &left = parents[i] == none ? end : ends[parents[i]];
        places[i] = ends[i] = left - 1;
        left -= sizes[i];
      }
    const auto old = parents;
    for (unsigned int i = 0; i < n; ++i)
      parents[places[i]] = old[i] == none ? none : places[old[i]];
    renumber(places);
  }


  // How many rows behind it a row changes: those it is on the way up to, along the tree.
  void
  EliminationFronts::count_changes()
  {
    const unsigned int n = positions.size();
    counts.assign(n, 0);
    marks.assign(n, none);
    for (unsigned int i = 0; i < n; ++i)
      {
        marks[i] = i;
        for (const unsigned int e : by_later[i])
          for (unsigned int k = edges[e][0]; marks[k] != i; k = parents[k])
            {
              marks[k] = i;
              ++counts[k];
            }
      }
  }


  // Of single rows, each joined with those before it as long as that is worth while.
  void
  EliminationFronts::make_fronts()
  {
    const unsigned int n = positions.size();
    fronts.clear();
    auto &zeros = marks; // of each front
    zeros.clear();
    for (unsigned int i = 0; i < n; ++i)
      {
        Front front{i, i + 1, counts[i], 0, 0};
        unsigned int of_front = 0;
        while (!fronts.empty())
          {
            const Front &last = fronts.back();
            if (parents[last.end - 1] >= front.end) // or none
              break;
            Front joined              = front;
            joined.first              = last.first;
            const unsigned int of_all = of_front + zeros.back() +
                                        last.n_pivots() * (front.size() - last.n_below);
            if (!are_few(of_all, joined))
              break;
            front    = joined;
            of_front = of_all;
            fronts.pop_back();
            zeros.pop_back();
          }
        fronts.push_back(front);
        zeros.push_back(of_front);
      }
  }


  void
  EliminationFronts::collect_below()
  {
    front_of.resize(positions.size());
    for (unsigned int f = 0; f < fronts.size(); ++f)
      std::fill(front_of.begin() + fronts[f].first, front_of.begin() + fronts[f].end, f);
    edges_at.fill(fronts.size(), edges.size(), [&](const unsigned int e) {
      return front_of[edges[e][0]];
    });
    rows_below.clear();
    marks.assign(positions.size(), none);
    open.clear(); // fronts whose parents are still to come
    for (unsigned int f = 0; f < fronts.size(); ++f)
      {
        Front &front      = fronts[f];
        front.begin_below = rows_below.size();
        const auto add    = [&](const unsigned int i) {
          if (i >= front.end && marks[i] != f)
            {
              marks[i] = f;
              rows_below.push_back(i);
            }
        };
        for (const unsigned int e : edges_at[f])
          add(edges[e][1]);
        for (; !open.empty() && parents[fronts[open.back()].end - 1] < front.end; open.pop_back())
          {
            ++front.n_children;
            const Front &child = fronts[open.back()];
            for (unsigned int k = 0; k < child.n_below; ++k)
              add(rows_below[child.begin_below + k]);
          }
        std::sort(rows_below.begin() + front.begin_below, rows_below.end());
        if (front.n_below > 0)
          open.push_back(f);
      }
  }
} // namespace akmon
