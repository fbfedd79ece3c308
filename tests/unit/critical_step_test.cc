#include <akmon/forces/internal_forces.h>
#include <akmon/time/critical_step.h>

#include <deal.II/lac/lapack_full_matrix.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <random>
#include <string>
#include <vector>

// The critical step 2/omega_max of a cell and of a body against references.md, section 7, and
// against an independent stiffness matrix: B-matrices in Voigt form at 2 x 2 x 2 Gauss points,
// B-bar for the mean dilatation, row-sum lumped masses, dense symmetric eigenvalues.

namespace
{
  using namespace akmon;
  using dealii::Tensor;

  using Nodes  = std::array<std::array<double, 3>, 8>;
  using Masses = std::array<double, 8>;

  // Of the estimated step below the true one.
  constexpr double allowed_loss = 0.03;
  // The estimated step may exceed the true one by rounding only.
  constexpr double rounding = 1e-10;

  constexpr CellIntegration integrations[] = {CellIntegration::full,
                                              CellIntegration::mean_dilatation};


  void
  report(const std::string &name, const double value)
  {
    std::cout << "  " << name << " " << value << std::endl;
  }


  // ---------------------------------------------------------------------------------------------
  // The independent route
  // ---------------------------------------------------------------------------------------------

  struct Shape
  {
    std::array<double, 8> N;
    std::array<std::array<double, 3>, 8> gradient; ///< with respect to x
    double jacobian;
  };


  Shape
  shape_at(const Nodes &x, const std::array<double, 3> &xi)
  {
    Shape shape;
    std::array<std::array<double, 3>, 8> reference_gradient;
    double J[3][3] = {};
    for (unsigned int a = 0; a < 8; ++a)
      {
        double factor[3], slope[3];
        for (unsigned int d = 0; d < 3; ++d)
          {
            const double sign = (a >> d) & 1 ? 1. : -1.;
            factor[d]         = 0.5 * (1. + sign * xi[d]);
            slope[d]          = 0.5 * sign;
          }
        shape.N[a]            = factor[0] * factor[1] * factor[2];
        reference_gradient[a] = {{slope[0] * factor[1] * factor[2],
                                  factor[0] * slope[1] * factor[2],
                                  factor[0] * factor[1] * slope[2]}};
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int d = 0; d < 3; ++d)
            J[i][d] += x[a][i] * reference_gradient[a][d];
      }
    Tensor<2, 3> jacobian;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int d = 0; d < 3; ++d)
        jacobian[i][d] = J[i][d];
    shape.jacobian     = determinant(jacobian);
    const auto inverse = invert(jacobian);
    for (unsigned int a = 0; a < 8; ++a)
      for (unsigned int i = 0; i < 3; ++i)
        {
          shape.gradient[a][i] = 0.;
          for (unsigned int d = 0; d < 3; ++d)
            shape.gradient[a][i] += reference_gradient[a][d] * inverse[d][i];
        }
    return shape;
  }


  // Gauss points with their weights 1.
  std::vector<std::array<double, 3>>
  gauss_points()
  {
    const double g = 1. / std::sqrt(3.);
    std::vector<std::array<double, 3>> points;
    for (const double z : {-g, g})
      for (const double y : {-g, g})
        for (const double x : {-g, g})
          points.push_back({{x, y, z}});
    return points;
  }


  Masses
  lumped_masses(const Nodes &x, const double density)
  {
    Masses mass{};
    for (const auto &point : gauss_points())
      {
        const Shape shape = shape_at(x, point);
        for (unsigned int a = 0; a < 8; ++a)
          mass[a] += density * shape.N[a] * shape.jacobian;
      }
    return mass;
  }


  bool
  valid(const Nodes &x)
  {
    for (const double i : {-1., 1.})
      for (const double j : {-1., 1.})
        for (const double k : {-1., 1.})
          if (!(shape_at(x, {{i, j, k}}).jacobian > 0.))
            return false;
    return true;
  }


  // omega_max^2 of M^{-1} K.
  double
  exact_eigenvalue(const Nodes &x,
                   const Masses &mass,
                   const Elasticity &elasticity,
                   const CellIntegration integration)
  {
    std::array<std::array<double, 3>, 8> mean_gradient{};
    double volume = 0.;
    for (const auto &point : gauss_points())
      {
        const Shape shape = shape_at(x, point);
        volume += shape.jacobian;
        for (unsigned int a = 0; a < 8; ++a)
          for (unsigned int i = 0; i < 3; ++i)
            mean_gradient[a][i] += shape.gradient[a][i] * shape.jacobian;
      }

    dealii::LAPACKFullMatrix<double> K(24, 24);
    for (unsigned int i = 0; i < 24; ++i)
      for (unsigned int j = 0; j < 24; ++j)
        K(i, j) = 0.;
    for (const auto &point : gauss_points())
      {
        const Shape shape   = shape_at(x, point);
        double B[6][24]     = {}; // xx, yy, zz, 2xy, 2yz, 2zx
        const double lambda = elasticity.lambda, mu = elasticity.mu;
        for (unsigned int a = 0; a < 8; ++a)
          for (unsigned int i = 0; i < 3; ++i)
            {
              const unsigned int next = (i + 1) % 3;
              B[i][3 * a + i]         = shape.gradient[a][i];
              B[3 + i][3 * a + i]     = shape.gradient[a][next];
              B[3 + i][3 * a + next]  = shape.gradient[a][i];
            }
        if (integration == CellIntegration::mean_dilatation)
          for (unsigned int a = 0; a < 8; ++a)
            for (unsigned int i = 0; i < 3; ++i)
              for (unsigned int k = 0; k < 3; ++k)
                B[k][3 * a + i] += (mean_gradient[a][i] / volume - shape.gradient[a][i]) / 3.;

        double C[6][6] = {};
        for (unsigned int i = 0; i < 3; ++i)
          {
            for (unsigned int j = 0; j < 3; ++j)
              C[i][j] = lambda;
            C[i][i] += 2. * mu;
            C[3 + i][3 + i] = mu;
          }
        for (unsigned int i = 0; i < 24; ++i)
          for (unsigned int j = 0; j < 24; ++j)
            for (unsigned int k = 0; k < 6; ++k)
              for (unsigned int l = 0; l < 6; ++l)
                K(i, j) += B[k][i] * C[k][l] * B[l][j] * shape.jacobian;
      }
    for (unsigned int i = 0; i < 24; ++i)
      for (unsigned int j = 0; j < 24; ++j)
        K(i, j) = K(i, j) / std::sqrt(mass[i / 3] * mass[j / 3]);
    dealii::Vector<double> eigenvalues;
    dealii::FullMatrix<double> eigenvectors;
    K.compute_eigenvalues_symmetric(-1e300, 1e300, 0., eigenvalues, eigenvectors);
    return *std::max_element(eigenvalues.begin(), eigenvalues.end());
  }


  double
  estimate(const Nodes &x,
           const Masses &mass,
           const Elasticity &elasticity,
           const CellIntegration integration)
  {
    double positions[8][3], masses[8];
    for (unsigned int a = 0; a < 8; ++a)
      {
        masses[a] = mass[a];
        std::copy(x[a].begin(), x[a].end(), positions[a]);
      }
    return largest_eigenvalue(positions, masses, elasticity, integration);
  }


  // Estimated over true critical step.
  double
  ratio_of_steps(const double estimate, const double exact)
  {
    return std::sqrt(exact / estimate);
  }


  Nodes
  brick(const double a, const double b, const double c)
  {
    Nodes x;
    for (unsigned int v = 0; v < 8; ++v)
      x[v] = {{v & 1 ? a : 0., v & 2 ? b : 0., v & 4 ? c : 0.}};
    return x;
  }


  // Extremes of the ratio of steps over many cells.
  struct Range
  {
    double low = 1e300, high = 0.;

    void
    add(const double value)
    {
      low  = std::min(low, value);
      high = std::max(high, value);
    }
  };


  // ---------------------------------------------------------------------------------------------
  // One cell
  // ---------------------------------------------------------------------------------------------

  // references.md, section 7: n = (1/a, 1/b, 1/c), omega_max^2 =
  // max( lambda_max[(4/rho)(lambda n n^T + 2G diag(n_i^2))], (4G/rho)(n_i^2 + n_j^2) ), rho = 1.
  double
  closed_form(const std::array<double, 3> &edges, const Elasticity &elasticity)
  {
    dealii::SymmetricTensor<2, 3> matrix;
    double shear = 0.;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = i; j < 3; ++j)
        {
          const double n_i = 1. / edges[i], n_j = 1. / edges[j];
          matrix[i][j] = 4. * (elasticity.lambda * n_i * n_j +
                               (i == j ? 2. * elasticity.mu * n_i * n_i : 0.));
          if (i != j)
            shear = std::max(shear, 4. * elasticity.mu * (n_i * n_i + n_j * n_j));
        }
    return std::max(eigenvalues(matrix)[0], shear);
  }


  TEST(ClosedForm, GivesThePublishedNumbers)
  {
    // Cube: dt = (a/c_d) {1, .7746, .7338, .6939, .6159}.
    const std::array<std::array<double, 2>, 5> published = {
      {{{0., 1.}}, {{.25, .7746}}, {{.3, .7338}}, {{.35, .6939}}, {{.45, .6159}}}};
    for (const auto &[nu, dt] : published)
      {
        const auto elasticity = Elasticity::from_young(1., nu);
        const double c_d      = std::sqrt(elasticity.lambda + 2. * elasticity.mu);
        EXPECT_NEAR(2. / std::sqrt(closed_form({{1., 1., 1.}}, elasticity)) * c_d, dt, 0.5e-4);
      }
    EXPECT_NEAR(std::sqrt(closed_form({{1., .5, .25}}, Elasticity::from_young(1., .3))),
                9.60382015,
                0.5e-8);
  }


  TEST(CellEigenvalue, IsTheClosedFormOnBricks)
  {
    Range range;
    for (const auto integration : integrations)
      for (const double nu : {0., .25, .3, .35, .45})
        for (const auto &edges : {std::array<double, 3>{{1., 1., 1.}},
                                  std::array<double, 3>{{1., 2., 4.}},
                                  std::array<double, 3>{{1., .5, .25}},
                                  std::array<double, 3>{{.25, 1., .25}},
                                  std::array<double, 3>{{10., 1., .1}}})
          {
            const auto elasticity = Elasticity::from_young(1., nu);
            const Nodes x         = brick(edges[0], edges[1], edges[2]);
            const Masses mass     = lumped_masses(x, 1.);
            const double exact    = closed_form(edges, elasticity);
            EXPECT_NEAR(exact_eigenvalue(x, mass, elasticity, integration), exact, 1e-10 * exact);

            const double ratio = ratio_of_steps(estimate(x, mass, elasticity, integration), exact);
            range.add(ratio);
            EXPECT_LE(ratio, 1. + rounding) << nu << " " << edges[1] << " " << edges[2];
            EXPECT_GE(ratio, 1. - allowed_loss) << nu << " " << edges[1] << " " << edges[2];
          }
    report("bricks: least ratio of steps", range.low);
    report("bricks: largest ratio of steps", range.high);
  }


  TEST(CellEigenvalue, HoldsForAuxeticMaterials)
  {
    // Shear patterns govern for nu < 0.
    for (const auto integration : integrations)
      for (const double nu : {-.1, -.3, -.6})
        for (const auto &edges :
             {std::array<double, 3>{{1., 1., 1.}}, std::array<double, 3>{{1., .5, .25}}})
          {
            const auto elasticity = Elasticity::from_young(1., nu);
            const Nodes x         = brick(edges[0], edges[1], edges[2]);
            const double exact    = closed_form(edges, elasticity);
            const double ratio    = ratio_of_steps(estimate(x,
                                                         lumped_masses(x, 1.),
                                                         elasticity,
                                                         integration),
                                                exact);
            EXPECT_LE(ratio, 1. + rounding) << nu << " " << edges[1];
            EXPECT_GE(ratio, 1. - allowed_loss) << nu << " " << edges[1];
          }
  }


  Nodes
  mapped(const Nodes &reference, const Tensor<2, 3> &F)
  {
    Nodes x;
    for (unsigned int v = 0; v < 8; ++v)
      for (unsigned int i = 0; i < 3; ++i)
        x[v][i] = F[i][0] * reference[v][0] + F[i][1] * reference[v][1] + F[i][2] * reference[v][2];
    return x;
  }


  void
  expect_close_to_dense(const Nodes &x, const std::string &name, Range &range)
  {
    ASSERT_TRUE(valid(x)) << name;
    const Masses mass = lumped_masses(x, 1.);
    for (const auto integration : integrations)
      for (const double nu : {0., .3, .45})
        {
          const auto elasticity = Elasticity::from_young(1., nu);
          const double ratio    = ratio_of_steps(estimate(x, mass, elasticity, integration),
                                              exact_eigenvalue(x, mass, elasticity, integration));
          range.add(ratio);
          const std::string which = name + ", nu " + std::to_string(nu) +
                                    (integration == CellIntegration::full ? " full" : " mean");
          EXPECT_LE(ratio, 1. + rounding) << which;
          EXPECT_GE(ratio, 1. - allowed_loss) << which;
        }
  }


  TEST(CellEigenvalue, IsThatOfTheDenseMatrixOnSkewedCells)
  {
    Range range;
    for (const double shear : {.25, .5, 1., 2.})
      for (const auto &edges :
           {std::array<double, 3>{{1., 1., 1.}}, std::array<double, 3>{{1., .5, .25}}})
        {
          const Nodes reference = brick(edges[0], edges[1], edges[2]);
          const Tensor<2, 3> plane({{1., shear, 0.}, {0., 1., 0.}, {0., 0., 1.}});
          const Tensor<2, 3> space({{1., shear, .5 * shear}, {0., 1., shear}, {0., 0., 1.}});
          expect_close_to_dense(mapped(reference, plane), "plane " + std::to_string(shear), range);
          expect_close_to_dense(mapped(reference, space), "space " + std::to_string(shear), range);
        }
    report("skewed: least ratio of steps", range.low);
    report("skewed: largest ratio of steps", range.high);
  }


  TEST(CellEigenvalue, IsThatOfTheDenseMatrixOnTaperedCells)
  {
    // The face z = 1 is a factor smaller in one or both directions; a wedge turns it too.
    Range range;
    for (const double taper : {.75, .5, .25, .1})
      for (const bool both : {false, true})
        for (const double angle : {0., .5})
          {
            Nodes x = brick(1., 1., 1.);
            for (unsigned int v = 4; v < 8; ++v)
              {
                const double p = taper * (x[v][0] - .5), q = (both ? taper : 1.) * (x[v][1] - .5);
                x[v][0] = .5 + std::cos(angle) * p - std::sin(angle) * q;
                x[v][1] = .5 + std::sin(angle) * p + std::cos(angle) * q;
              }
            expect_close_to_dense(x, "taper " + std::to_string(taper), range);
          }
    report("tapered: least ratio of steps", range.low);
    report("tapered: largest ratio of steps", range.high);
  }


  TEST(CellEigenvalue, IsThatOfTheDenseMatrixOnDistortedCells)
  {
    std::mt19937 generator(1);
    std::uniform_real_distribution<double> uniform(-1., 1.);
    Range range;
    unsigned int n_cells = 0;
    while (n_cells < 400)
      {
        const double amplitude = 0.35 * std::abs(uniform(generator));
        Nodes x                = brick(1., std::pow(4., uniform(generator)), 1.);
        const double least     = std::min(1., x[2][1]);
        for (auto &node : x)
          for (auto &component : node)
            component += amplitude * least * uniform(generator);
        if (!valid(x))
          continue;
        ++n_cells;
        expect_close_to_dense(x, "random " + std::to_string(n_cells), range);
      }
    report("distorted: least ratio of steps", range.low);
    report("distorted: largest ratio of steps", range.high);
  }


  TEST(CellEigenvalue, IsTheSameInEveryLane)
  {
    const auto elasticity = Elasticity::from_young(1., .3);
    // The same cells in every rotation of the lanes: the same bits. The scalar version agrees to
    // what the bisection resolves (2^-20 of the eigenvalue bounds).
    const auto in_lanes = [&](const unsigned int shift) {
      alignas(lane_alignment) double mass_lanes[8][n_lanes], x_lanes[8][3][n_lanes];
      Lanes masses[8], positions[8][3];
      for (unsigned int k = 0; k < n_lanes; ++k)
        {
          const unsigned int lane = (k + shift) % n_lanes;
          const Nodes x           = brick(1., .5 + k, 2. - .1 * k);
          const Masses mass       = lumped_masses(x, 1. + k);
          for (unsigned int v = 0; v < 8; ++v)
            {
              mass_lanes[v][lane] = mass[v];
              for (unsigned int d = 0; d < 3; ++d)
                x_lanes[v][d][lane] = x[v][d];
            }
        }
      for (unsigned int v = 0; v < 8; ++v)
        {
          masses[v] = Lanes::load_aligned(mass_lanes[v]);
          for (unsigned int d = 0; d < 3; ++d)
            positions[v][d] = Lanes::load_aligned(x_lanes[v][d]);
        }
      return largest_eigenvalue(positions, masses, elasticity, CellIntegration::mean_dilatation);
    };
    const Lanes unshifted = in_lanes(0);
    for (unsigned int shift = 0; shift < n_lanes; ++shift)
      {
        const Lanes shifted = in_lanes(shift);
        for (unsigned int k = 0; k < n_lanes; ++k)
          EXPECT_EQ(shifted.get((k + shift) % n_lanes), unshifted.get(k));
      }
    for (unsigned int k = 0; k < n_lanes; ++k)
      {
        const Nodes x      = brick(1., .5 + k, 2. - .1 * k);
        const double alone = estimate(x,
                                      lumped_masses(x, 1. + k),
                                      elasticity,
                                      CellIntegration::mean_dilatation);
        EXPECT_NEAR(unshifted.get(k), alone, 2e-6 * alone);
      }
  }


  // ---------------------------------------------------------------------------------------------
  // Assembled bodies
  // ---------------------------------------------------------------------------------------------

  Body
  body_with(const MeshParameters::Shape &shape, const CellIntegration integration)
  {
    Body body;
    body.name        = "body";
    body.mesh.shape  = shape;
    body.rotation    = dealii::unit_symmetric_tensor<3>();
    body.material    = "elastic";
    body.integration = integration;
    return body;
  }


  BoxShape
  box(const Tensor<1, 3> &size, const std::array<unsigned int, 3> &cells)
  {
    BoxShape shape;
    shape.size  = size;
    shape.cells = cells;
    return shape;
  }


  Material
  elastic(const double nu)
  {
    Material material;
    material.name    = "elastic";
    material.density = 1.;
    material.law     = Hypoelastic{Elasticity::from_young(1., nu)};
    return material;
  }


  // Largest eigenvalue of M^{-1} K of a whole body by Lanczos' iteration (a power iteration that
  // remembers). K u is the internal force operator itself from the unstressed state, for a
  // displacement so small that it is linear.
  double
  assembled_eigenvalue(const Discretization &discretization, const InternalForces &unstressed)
  {
    constexpr unsigned int max_vectors = 250;
    constexpr double displacement      = 1e-6;
    const unsigned int n               = 3 * discretization.n_nodes;
    std::mt19937 generator(7);
    std::uniform_real_distribution<double> uniform(-1., 1.);

    // y = M^{-1/2} K M^{-1/2} q, the mean of what +q and -q do: without the quadratic term.
    const auto apply = [&](const std::vector<double> &q) {
      double largest = 0.;
      for (unsigned int i = 0; i < n; ++i)
        largest = std::max(largest, std::abs(q[i]) / std::sqrt(discretization.mass[i / 3]));
      std::vector<double> y(n, 0.);
      for (const double scale : {displacement / largest, -displacement / largest})
        {
          NodalVector x(discretization.reference), dx = discretization.make_vector(),
                                                   force = discretization.make_vector();
          for (unsigned int i = 0; i < n; ++i)
            dx.local_element(i) = scale * q[i] / std::sqrt(discretization.mass[i / 3]);
          for (unsigned int i = 0; i < n; ++i)
            x.local_element(i) += dx.local_element(i);
          InternalForces operation(unstressed);
          operation.update(x, dx, force);
          for (unsigned int i = 0; i < n; ++i)
            y[i] -= 0.5 * force.local_element(i) / (scale * std::sqrt(discretization.mass[i / 3]));
        }
      return y;
    };
    const auto dot = [&](const std::vector<double> &a, const std::vector<double> &b) {
      double sum = 0.;
      for (unsigned int i = 0; i < n; ++i)
        sum += a[i] * b[i];
      return sum;
    };

    std::vector<std::vector<double>> basis;
    std::vector<double> diagonal, off_diagonal, q(n);
    for (auto &value : q)
      value = uniform(generator);
    double eigenvalue = 0.;
    while (basis.size() < std::min(max_vectors, n))
      {
        const double norm = std::sqrt(dot(q, q));
        if (!basis.empty())
          {
            if (norm < 1e-9 * eigenvalue)
              break;
            off_diagonal.push_back(norm);
          }
        for (auto &value : q)
          value /= norm;
        basis.push_back(q);
        q = apply(q);
        diagonal.push_back(dot(q, basis.back()));
        for (unsigned int pass = 0; pass < 2; ++pass)
          for (const auto &b : basis)
            {
              const double overlap = dot(q, b);
              for (unsigned int i = 0; i < n; ++i)
                q[i] -= overlap * b[i];
            }

        // Largest Ritz value: Newton's iteration from above on the last pivot would do; bisection
        // by Sturm's count is plainer.
        double low = *std::max_element(diagonal.begin(), diagonal.end()), high = low;
        for (unsigned int i = 0; i < diagonal.size(); ++i)
          high = std::max(high,
                          diagonal[i] + (i > 0 ? off_diagonal[i - 1] : 0.) +
                            (i < off_diagonal.size() ? off_diagonal[i] : 0.));
        const auto all_below = [&](const double bound) {
          double pivot = bound - diagonal[0];
          for (unsigned int i = 1; pivot > 0. && i < diagonal.size(); ++i)
            pivot = bound - diagonal[i] - off_diagonal[i - 1] * off_diagonal[i - 1] / pivot;
          return pivot > 0.;
        };
        while (high - low > 1e-12 * high)
          {
            const double middle              = 0.5 * (low + high);
            (all_below(middle) ? high : low) = middle;
          }
        const double change = std::abs(high - eigenvalue);
        eigenvalue          = high;
        if (basis.size() > 60 && change < 1e-10 * eigenvalue)
          break;
      }
    return eigenvalue;
  }


  struct Steps
  {
    double estimated, exact;
  };


  // Critical steps of a body over h/c_d, both the estimate and the true one of the assembled
  // system.
  Steps
  critical_steps(const MeshParameters::Shape &shape,
                 const double nu,
                 const CellIntegration integration,
                 const double h)
  {
    const Material material = elastic(nu);
    const Discretization discretization({body_with(shape, integration)}, {material}, MPI_COMM_SELF);
    const InternalForces forces(discretization);
    const double unit = h / material.dilatational_wave_speed();
    return {2. / std::sqrt(forces.largest_frequency_squared()) / unit,
            2. / std::sqrt(assembled_eigenvalue(discretization, forces)) / unit};
  }


  TEST(BodyEigenvalue, OfFreeMeshesOfCubesIsTheKnownOne)
  {
    // references.md, section 7: free cube meshes, nu = .3, dt c_d/h to four digits, full
    // integration.
    struct Known
    {
      std::array<unsigned int, 3> cells;
      double dt;
    };
    for (const auto &known : {Known{{{1, 1, 1}}, .7338},
                              Known{{{1, 1, 100}}, .8050},
                              Known{{{2, 2, 2}}, .9277},
                              Known{{{4, 4, 4}}, .9579},
                              Known{{{8, 8, 8}}, .9632}})
      {
        const Tensor<1, 3> size({.1 * known.cells[0], .1 * known.cells[1], .1 * known.cells[2]});
        const auto shape       = box(size, known.cells);
        const Steps full       = critical_steps(shape, .3, CellIntegration::full, .1);
        const Steps mean       = critical_steps(shape, .3, CellIntegration::mean_dilatation, .1);
        const std::string name = std::to_string(known.cells[0]) + " x " +
                                 std::to_string(known.cells[2]);
        report("free cubes " + name + " full", full.exact);
        report("free cubes " + name + " mean dilatation", mean.exact);
        EXPECT_LE(full.estimated, full.exact * (1. + 1e-8)) << name;
        EXPECT_LE(mean.estimated, mean.exact * (1. + 1e-8)) << name;
        EXPECT_NEAR(full.exact, known.dt, 0.5e-4) << name;
        // Averaging the dilatation only takes energy away.
        EXPECT_GE(mean.exact, full.exact * (1. - 1e-8)) << name;
      }
  }


  TEST(BodyEigenvalue, IsNeverAboveTheEstimate)
  {
    CylinderShape cylinder;
    cylinder.radius        = .2;
    cylinder.length        = .4;
    cylinder.cells_across  = 2;
    cylinder.cells_radial  = 2;
    cylinder.cells_axial   = 3;
    cylinder.sector        = CylinderShape::Sector::full;
    cylinder.axial_grading = 2.;
    SphereShape sphere;
    sphere.radius       = 1.;
    sphere.cells_across = 2;
    sphere.cells_radial = 2;
    const std::vector<std::pair<std::string, MeshParameters::Shape>> shapes =
      {{"box", box(Tensor<1, 3>({1., .5, 2.}), {{3, 4, 2}})},
       {"plate", box(Tensor<1, 3>({1., 1., .05}), {{4, 4, 1}})},
       {"cylinder", cylinder},
       {"sphere", sphere}};
    for (const auto &[name, shape] : shapes)
      for (const auto integration : integrations)
        for (const double nu : {0., .3, .45})
          {
            const Steps steps = critical_steps(shape, nu, integration, 1.);
            report(name + " nu " + std::to_string(nu) + " estimated over exact step",
                   steps.estimated / steps.exact);
            EXPECT_LE(steps.estimated, steps.exact * (1. + 1e-8)) << name << " nu " << nu;
          }
  }


  // ---------------------------------------------------------------------------------------------
  // The tracker: a cell that deforms gradually
  // ---------------------------------------------------------------------------------------------

  // Motion of a node from its reference position, 0 <= t <= 1.
  using Motion = std::array<double, 3> (*)(const std::array<double, 3> &, double);


  std::array<double, 3>
  stretch_to_two(const std::array<double, 3> &X, const double t)
  {
    return {{X[0] * (1. + t), X[1], X[2]}};
  }


  std::array<double, 3>
  stretch_to_half(const std::array<double, 3> &X, const double t)
  {
    return {{X[0], X[1] * (1. - .5 * t), X[2]}};
  }


  std::array<double, 3>
  flatten_at_constant_volume(const std::array<double, 3> &X, const double t)
  {
    const double s = 1. - .75 * t;
    return {{X[0] / std::sqrt(s), X[1] / std::sqrt(s), X[2] * s}};
  }


  std::array<double, 3>
  shear_to_one(const std::array<double, 3> &X, const double t)
  {
    return {{X[0] + t * X[1], X[1], X[2]}};
  }


  std::array<double, 3>
  twist(const std::array<double, 3> &X, const double t)
  {
    const double angle = t * X[2];
    return {{std::cos(angle) * X[0] - std::sin(angle) * X[1],
             std::sin(angle) * X[0] + std::cos(angle) * X[1],
             X[2]}};
  }


  std::array<double, 3>
  taper(const std::array<double, 3> &X, const double t)
  {
    const double s = 1. - .7 * t * (X[2] + .5);
    return {{s * X[0], s * X[1], X[2]}};
  }


  TEST(Tracker, FollowsACellThatDeforms)
  {
    constexpr unsigned int n_steps                            = 400;
    const std::vector<std::pair<std::string, Motion>> motions = {{"stretch to 2", stretch_to_two},
                                                                 {"stretch to 1/2",
                                                                  stretch_to_half},
                                                                 {"flatten to 1/4",
                                                                  flatten_at_constant_volume},
                                                                 {"shear to 1", shear_to_one},
                                                                 {"twist by 1 rad", twist},
                                                                 {"taper to .3", taper}};
    for (const auto &[name, motion] : motions)
      for (const auto integration : integrations)
        for (const auto &size : {Tensor<1, 3>({1., 1., 1.}), Tensor<1, 3>({1., .5, 1.})})
          for (const double nu : {0., .3, .45})
            {
              const Material material = elastic(nu);
              const Discretization discretization({body_with(box(size, {{1, 1, 1}}), integration)},
                                                  {material},
                                                  MPI_COMM_SELF);
              InternalForces forces(discretization);
              NodalVector x(discretization.reference), dx = discretization.make_vector(),
                                                       force = discretization.make_vector();
              Nodes reference, current;
              const auto &nodes = discretization.cells[0].nodes;
              for (unsigned int v = 0; v < 8; ++v)
                for (unsigned int d = 0; d < 3; ++d)
                  reference[v][d] = at_node(discretization.reference, nodes[v])[d];
              const Masses mass = lumped_masses(reference, 1.);

              Range range;
              for (unsigned int step = 1; step <= n_steps; ++step)
                {
                  for (unsigned int v = 0; v < 8; ++v)
                    {
                      current[v] = motion(reference[v], double(step) / n_steps);
                      for (unsigned int d = 0; d < 3; ++d)
                        {
                          const unsigned int i = 3 * nodes[v] + d;
                          dx.local_element(i)  = current[v][d] - x.local_element(i);
                          x.local_element(i)   = current[v][d];
                        }
                    }
                  forces.update(x, dx, force);
                  range.add(ratio_of_steps(forces.largest_frequency_squared(),
                                           exact_eigenvalue(current,
                                                            mass,
                                                            material.elasticity(),
                                                            integration)));
                }
              EXPECT_FALSE(forces.fault().occurred());
              EXPECT_GE(range.low, 1. - allowed_loss) << name << " nu " << nu << " " << size[1];
              EXPECT_LE(range.high, 1. + allowed_loss) << name << " nu " << nu << " " << size[1];
              if (size[1] == 1. && integration == CellIntegration::mean_dilatation)
                report(name + " nu " + std::to_string(nu) + ", ratio of steps " +
                         std::to_string(range.low) + " to",
                       range.high);
            }
  }
} // namespace
