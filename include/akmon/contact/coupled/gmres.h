#pragma once

#include <deal.II/base/tensor.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace akmon
{
  /**
   * Generalized minimal residuals, preconditioned from the right (Saad, Iterative Methods for
   * Sparse Linear Systems, 2nd ed., algorithm 9.5), for vectors of three components per contact
   * pair. Keeps what the operator made of its basis, so that images of the solution are known
   * without another application. Its storage is reused.
   */
  class Gmres
  {
  public:
    using Vector = std::vector<dealii::Tensor<1, 3>>;

    /// v . w
    static double
    product(const Vector &v, const Vector &w)
    {
      double sum = 0.;
      for (std::size_t i = 0; i < v.size(); ++i)
        sum += v[i] * w[i];
      return sum;
    }

    /**
     * Minimise |r - K x| over the Krylov space.
     * @param apply         apply(z, image, y): y = K z; `image` is kept along with z
     * @param precondition  precondition(v, z): z close to K^{-1} v
     * @param target        norm of the residual that is small enough
     * @param most          largest dimension of the space
     */
    template <typename Operator, typename Preconditioner>
    void
    solve(const Operator &apply,
          const Preconditioner &precondition,
          const Vector &r,
          const double target,
          const unsigned int most)
    {
      basis.resize(std::max<std::size_t>(basis.size(), most + 1));
      directions.resize(std::max<std::size_t>(directions.size(), most));
      images.resize(std::max<std::size_t>(images.size(), most));
      columns.clear();
      coefficients.clear();
      rotations.clear();
      rest = {std::sqrt(product(r, r))};
      if (!(rest[0] > 0.))
        return;
      set_to(basis[0], r, 1. / rest[0]);
      while (columns.size() < most && std::abs(rest.back()) > target)
        {
          const unsigned int k = columns.size();
          for (Vector *const v : {&directions[k], &images[k], &basis[k + 1]})
            v->resize(r.size());
          precondition(basis[k], directions[k]);
          apply(directions[k], images[k], basis[k + 1]);
          if (!(orthogonalize(k) > 0.))
            break;
        }
      solve_triangle();
    }

    /// The solution, and the image that belongs to it.
    void
    combine(Vector &x, Vector &image) const
    {
      for (std::size_t i = 0; i < x.size(); ++i)
        {
          x[i] = image[i] = dealii::Tensor<1, 3>();
          for (std::size_t k = 0; k < coefficients.size(); ++k)
            {
              x[i] += coefficients[k] * directions[k][i];
              image[i] += coefficients[k] * images[k][i];
            }
        }
    }

  private:
    static void
    set_to(Vector &v, const Vector &w, const double factor)
    {
      v.resize(w.size());
      for (std::size_t i = 0; i < w.size(); ++i)
        v[i] = factor * w[i];
    }

    // Classical Gram and Schmidt, twice, and Givens' rotations; returns the norm that is left.
    double
    orthogonalize(const unsigned int k)
    {
      Vector &v = basis[k + 1];
      std::vector<double> column(k + 2), sums(k + 1);
      for (unsigned int pass = 0; pass < 2; ++pass)
        {
          for (unsigned int j = 0; j <= k; ++j)
            sums[j] = product(v, basis[j]);
          for (unsigned int j = 0; j <= k; ++j)
            {
              column[j] += sums[j];
              for (std::size_t i = 0; i < v.size(); ++i)
                v[i] -= sums[j] * basis[j][i];
            }
        }
      const double norm = std::sqrt(product(v, v));
      column[k + 1]     = norm;
      for (unsigned int j = 0; j < k; ++j)
        rotate(rotations[j], column[j], column[j + 1]);
      const double length = std::hypot(column[k], column[k + 1]);
      if (!(length > 0.))
        return 0.;
      rotations.push_back({column[k] / length, column[k + 1] / length});
      rotate(rotations[k], column[k], column[k + 1]);
      rest.push_back(0.);
      rotate(rotations[k], rest[k], rest[k + 1]);
      columns.push_back(std::move(column));
      if (norm > 0.)
        set_to(v, v, 1. / norm);
      return norm;
    }

    struct Rotation
    {
      double cosine, sine;
    };

    static void
    rotate(const Rotation &rotation, double &a, double &b)
    {
      const double old = a;
      a                = rotation.cosine * old + rotation.sine * b;
      b                = -rotation.sine * old + rotation.cosine * b;
    }

    void
    solve_triangle()
    {
      coefficients.assign(columns.size(), 0.);
      for (std::size_t i = columns.size(); i-- > 0;)
        {
          double sum = rest[i];
          for (std::size_t j = i + 1; j < columns.size(); ++j)
            sum -= columns[j][i] * coefficients[j];
          coefficients[i] = sum / columns[i][i];
        }
    }

    std::vector<Vector> basis, directions, images;
    std::vector<std::vector<double>> columns; ///< of the triangular matrix
    std::vector<Rotation> rotations;
    std::vector<double> rest; ///< rotated right-hand side; its last entry is the residual
    std::vector<double> coefficients;
  };
} // namespace akmon
