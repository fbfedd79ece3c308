#pragma once

#include <akmon/contact/buckets.h>

#include <array>
#include <vector>

namespace akmon
{
  /**
   * How a sparse matrix with a symmetric pattern is eliminated by dense fronts (Duff and Reid, ACM
   * Trans. Math. Softw. 9, 1983): rows in an order that leaves few entries (approximate minimum
   * degree; Amestoy, Davis and Duff, SIAM J. Matrix Anal. Appl. 17, 1996), and those with nearly
   * the same entries together (relaxed supernodes; Ashcraft and Grimes, ACM Trans. Math. Softw. 15,
   * 1989).
   */
  class EliminationFronts
  {
  public:
    /// Rows that are eliminated together, positions `first` to `end` of the order, and those behind
    /// that they change. Its children are fronts whose changes it takes up.
    struct Front
    {
      unsigned int first, end;
      unsigned int n_below, begin_below;
      unsigned int n_children;

      unsigned int
      n_pivots() const
      {
        return end - first;
      }

      unsigned int
      size() const
      {
        return n_pivots() + n_below;
      }
    };

    /// Two rows that share entries.
    using Edge = std::array<unsigned int, 2>;

    /// Nothing is done if all is as before.
    /// @param edges  of different ones of @p n rows, every two once
    void
    reinit(const unsigned int n, const std::vector<Edge> &edges);

    /// By row: where it comes.
    const std::vector<unsigned int> &
    get_positions() const
    {
      return positions;
    }

    /// Children before their parents, so that those last seen that have no parent yet are the
    /// children of the next.
    const std::vector<Front> &
    get_fronts() const
    {
      return fronts;
    }

    /// The positions that a front changes, in rising order.
    dealii::ArrayView<const unsigned int>
    below(const Front &front) const
    {
      return {rows_below.data() + front.begin_below, front.n_below};
    }

    /// Numbers of the edges that a front has to bring in: from its pivots to what comes later.
    dealii::ArrayView<const unsigned int>
    edges_of(const std::size_t front) const
    {
      return edges_at[front];
    }

  private:
    void
    order_for_few_entries();
    void
    find_parents();
    void
    order_by_subtrees();
    void
    renumber(const std::vector<unsigned int> &new_positions);
    void
    count_changes();
    void
    make_fronts();
    void
    collect_below();

    std::vector<Edge> given;
    std::vector<Edge> edges; ///< by positions, the lower one first
    std::vector<unsigned int> positions;
    std::vector<Front> fronts;
    std::vector<unsigned int> rows_below;
    Buckets edges_at; ///< by front

    // Scratch.
    std::vector<unsigned int> parents; ///< elimination tree, by position
    Buckets by_later;                  ///< edges by their later position
    std::vector<unsigned int> marks, counts, front_of, open;
  };
} // namespace akmon
