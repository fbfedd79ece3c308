#include <akmon/contact/coupled/block_factor.h>

#include <algorithm>

namespace akmon
{
  template <typename Number>
  BlockFactor::Parts<Number>::Parts(Number *const values,
                                    const std::size_t width,
                                    const std::size_t n_below)
    : inverse_L{values, padded(width)}
    , inverse_U{inverse_L.from(0, width).values, padded(width)}
    , lower{inverse_U.from(0, width).values, padded(n_below)}
    , upper{lower.from(0, width).values, padded(width)}
  {
  }


  template <typename Number>
  std::size_t
  BlockFactor::Parts<Number>::size(const std::size_t width, const std::size_t n_below)
  {
    return 2 * padded(width) * width + padded(n_below) * width + padded(width) * n_below;
  }


  bool
  BlockFactor::compute(const std::vector<Block> &diagonal, const std::vector<Coupling> &couplings)
  {
    edges.clear();
    for (const Coupling &coupling : couplings)
      edges.push_back({{coupling.a, coupling.b}});
    fronts.reinit(diagonal.size(), edges);
    rows.resize(diagonal.size());
    row_of.resize(diagonal.size());
    for (unsigned int i = 0; i < rows.size(); ++i)
      rows[fronts.get_positions()[i]] = i;
    factors.clear();
    changes.clear();
    open.clear();
    std::size_t largest = 0;
    for (const Front &front : fronts.get_fronts())
      largest = std::max<std::size_t>(largest, 3 * front.size());
    of_front.assign(largest + Lanes::size, 0.); // what is behind the last rows is finite
    for (unsigned int f = 0; f < fronts.get_fronts().size(); ++f)
      {
        const Front &front = fronts.get_fronts()[f];
        take_entries(f, diagonal, couplings);
        for (unsigned int c = 0; c < front.n_children; ++c)
          {
            take_changes(fronts.get_fronts()[open.back()]);
            open.pop_back();
          }
        if (!eliminate(front))
          return false;
        if (front.n_below > 0)
          {
            leave_changes(front);
            open.push_back(f);
          }
      }
    return true;
  }


  void
  BlockFactor::take_entries(const unsigned int f,
                            const std::vector<Block> &diagonal,
                            const std::vector<Coupling> &couplings)
  {
    const Front &front     = fronts.get_fronts()[f];
    const std::size_t size = 3 * front.size();
    stride                 = padded(size + Lanes::size - 1); // for what stands below
    values.assign(stride * size, 0.);
    for (unsigned int i = front.first; i < front.end; ++i)
      row_of[i] = 3 * (i - front.first);
    std::size_t row = 3 * front.n_pivots();
    for (const unsigned int i : fronts.below(front))
      {
        row_of[i] = row;
        row += 3;
      }
    const auto put =
      [&](const Block &block, const std::size_t first_row, const std::size_t column) {
        for (unsigned int j = 0; j < 3; ++j)
          for (unsigned int i = 0; i < 3; ++i)
            values[(column + j) * stride + first_row + i] = block.rows[i][j];
      };
    for (unsigned int i = front.first; i < front.end; ++i)
      put(diagonal[rows[i]], row_of[i], row_of[i]);
    const auto &positions = fronts.get_positions();
    for (const unsigned int e : fronts.edges_of(f))
      {
        const Coupling &coupling = couplings[e];
        const std::size_t a = row_of[positions[coupling.a]], b = row_of[positions[coupling.b]];
        put(coupling.ab, a, b);
        put(coupling.ba, b, a);
      }
  }


  void
  BlockFactor::take_changes(const Front &child)
  {
    const std::size_t size = 3 * child.n_below;
    runs.clear();
    for (const unsigned int i : fronts.below(child))
      if (!runs.empty() && runs.back().begin_in_parent + runs.back().size == row_of[i])
        runs.back().size += 3;
      else
        runs.push_back({runs.empty() ? 0 : runs.back().begin + runs.back().size, 3, row_of[i]});
    changes.resize(changes.size() - size * size);
    const double *change = changes.data() + changes.size();
    for (const Run &of_columns : runs)
      for (std::size_t j = 0; j < of_columns.size; ++j, change += size)
        {
          double *const column = values.data() + (of_columns.begin_in_parent + j) * stride;
          for (const Run &of_rows : runs)
            {
              double *const to         = column + of_rows.begin_in_parent;
              const double *const from = change + of_rows.begin;
              for (std::size_t i = 0; i < of_rows.size; ++i)
                to[i] += from[i];
            }
        }
  }


  bool
  BlockFactor::eliminate(const Front &front)
  {
    const std::size_t size = 3 * front.size(), n = 3 * front.n_pivots();
    const Panel F{values.data(), stride};
    for (std::size_t k = 0; k < n; k += max_panel)
      {
        const std::size_t width = std::min(max_panel, n - k), end = k + width, n_below = size - end;
        const std::size_t begin = factors.size();
        factors.resize(begin + Parts<double>::size(width, n_below));
        const Parts<double> parts(factors.data() + begin, width, n_below);
        if (!invert_factors(F.from(k, k), width, parts.inverse_L, parts.inverse_U))
          return false;
        const auto below = F.from(end, k), beside = F.from(k, end), rest = F.from(end, end);
        subtract_product(below, parts.inverse_U, parts.lower, n_below, width, width);
        subtract_product(parts.inverse_L, beside, parts.upper, width, width, n_below);
        subtract_product(parts.lower, parts.upper, rest, n_below, width, n_below);
      }
    return true;
  }


  void
  BlockFactor::leave_changes(const Front &front)
  {
    const std::size_t size = 3 * front.n_below, first = 3 * front.n_pivots();
    for (std::size_t j = first; j < first + size; ++j)
      {
        const auto column = values.begin() + j * stride + first;
        changes.insert(changes.end(), column, column + size);
      }
  }


  // What a vector has at the rows of a front, in front.
  void
  BlockFactor::load(const Front &front) const
  {
    double *to      = of_front.data();
    const auto take = [&](const unsigned int i) {
      for (unsigned int d = 0; d < 3; ++d)
        *to++ = permuted[i][d];
    };
    for (unsigned int i = front.first; i < front.end; ++i)
      take(i);
    for (const unsigned int i : fronts.below(front))
      take(i);
  }


  // Back to where they came from: the rows of the pivots, or all.
  void
  BlockFactor::store(const Front &front, const bool all) const
  {
    const double *from = of_front.data();
    const auto give    = [&](const unsigned int i) {
      for (unsigned int d = 0; d < 3; ++d)
        permuted[i][d] = *from++;
    };
    for (unsigned int i = front.first; i < front.end; ++i)
      give(i);
    if (all)
      for (const unsigned int i : fronts.below(front))
        give(i);
  }


  // From the first panel to the last: y = -L^{-1} x, and less L y below.
  const double *
  BlockFactor::go_forward(const Front &front, const double *factor) const
  {
    const std::size_t size = 3 * front.size(), n = 3 * front.n_pivots();
    for (std::size_t k = 0; k < n; k += max_panel)
      {
        const std::size_t width = std::min(max_panel, n - k), n_below = size - k - width;
        const Parts<const double> parts(factor, width, n_below);
        multiply(parts.inverse_L, k, width);
        double *const x = of_front.data() + k;
        subtract_product(parts.lower, x, x + width, n_below, width);
        factor += parts.size(width, n_below);
      }
    return factor;
  }


  // From the last panel to the first: x = -U^{-1} (y + U x_below). Returns where the front's begin.
  const double *
  BlockFactor::go_backward(const Front &front, const double *factor) const
  {
    const std::size_t size = 3 * front.size(), n = 3 * front.n_pivots();
    for (std::size_t end = n; end > 0;)
      {
        const std::size_t width = (end - 1) % max_panel + 1, n_below = size - end;
        end -= width;
        factor -= Parts<const double>::size(width, n_below);
        const Parts<const double> parts(factor, width, n_below);
        double *const x = of_front.data() + end;
        subtract_product(parts.upper, x + width, x, width, n_below);
        multiply(parts.inverse_U, end, width);
      }
    return factor;
  }


  // x = -A x for a panel's pivots.
  void
  BlockFactor::multiply(const ConstPanel &A, const std::size_t first, const std::size_t width) const
  {
    std::array<double, max_panel> y{};
    subtract_product(A, of_front.data() + first, y.data(), width, width);
    std::copy_n(y.begin(), width, of_front.begin() + first);
  }


  void
  BlockFactor::solve_in_place(Vector &vector) const
  {
    permuted.resize(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
      permuted[i] = vector[rows[i]];
    const double *factor = factors.data();
    for (const Front &front : fronts.get_fronts())
      {
        load(front);
        factor = go_forward(front, factor);
        store(front, true);
      }
    for (auto front = fronts.get_fronts().rbegin(); front != fronts.get_fronts().rend(); ++front)
      {
        load(*front);
        factor = go_backward(*front, factor);
        store(*front, false);
      }
    for (std::size_t i = 0; i < rows.size(); ++i)
      vector[rows[i]] = permuted[i];
  }
} // namespace akmon
