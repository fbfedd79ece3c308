#include <akmon/contact/search/projection.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "support/report.h"

// Closest point of a bilinear segment (4): plane segments by hand, warped ones against points made
// by going along a known normal, and against a search over a fine grid.

namespace projection_test
{
  using namespace akmon;
  using test::report;
  using Vector  = dealii::Tensor<1, 3>;
  using Feature = Projection::Feature;

  constexpr double edge_tolerance = 1e-3;

  // Corner k at (xi, eta) = (-1,-1), (1,-1), (1,1), (-1,1).
  const Segment square = {
    {Vector({0., 0., 0.}), Vector({2., 0., 0.}), Vector({2., 2., 0.}), Vector({0., 2., 0.})}};


  Vector
  point_of(const Segment &segment, const double xi, const double eta)
  {
    return 0.25 * ((1. - xi) * (1. - eta) * segment[0] + (1. + xi) * (1. - eta) * segment[1] +
                   (1. + xi) * (1. + eta) * segment[2] + (1. - xi) * (1. + eta) * segment[3]);
  }


  // Of d x/d xi and d x/d eta, written out.
  Vector
  normal_of(const Segment &s, const double xi, const double eta)
  {
    const Vector along_xi  = (1. - eta) * (s[1] - s[0]) + (1. + eta) * (s[2] - s[3]);
    const Vector along_eta = (1. - xi) * (s[3] - s[0]) + (1. + xi) * (s[2] - s[1]);
    const Vector normal    = cross_product_3d(along_xi, along_eta);
    return normal / normal.norm();
  }


  // What holds for any projection.
  void
  expect_consistent(const Vector &slave, const Segment &segment, const Projection &projection)
  {
    double sum = 0.;
    Vector closest;
    for (unsigned int k = 0; k < 4; ++k)
      {
        EXPECT_GE(projection.N[k], -1e-15);
        sum += projection.N[k];
        closest += projection.N[k] * segment[k];
      }
    EXPECT_NEAR(sum, 1., 1e-15);
    EXPECT_LE((closest + projection.offset - slave).norm(), 1e-14);
    EXPECT_LE((closest - point_of(segment, projection.xi, projection.eta)).norm(), 1e-14);
  }


  TEST(Projection, FindsTheFootInsideAPlaneSegment)
  {
    for (const double height : {-0.5, 0., 1e-9, 0.7})
      for (const double x : {0.1, 0.8, 1.7})
        for (const double y : {0.3, 1., 1.9})
          {
            const Vector slave({x, y, height});
            const auto projection = project(slave, square, edge_tolerance);
            expect_consistent(slave, square, projection);
            EXPECT_EQ(projection.feature, Feature::face);
            EXPECT_NEAR(projection.xi, x - 1., 1e-15);
            EXPECT_NEAR(projection.eta, y - 1., 1e-15);
            EXPECT_LE((projection.offset - Vector({0., 0., height})).norm(), 1e-15);
          }
  }


  TEST(Projection, FindsTheFootOnEdgesAndVertices)
  {
    struct Case
    {
      Vector slave, closest;
      Feature feature;
      unsigned int where;
    };
    const std::vector<Case> cases =
      {{Vector({0.6, -0.4, 0.3}), Vector({0.6, 0., 0.}), Feature::edge, 0},
       {Vector({2.5, 0.7, -0.1}), Vector({2., 0.7, 0.}), Feature::edge, 1},
       {Vector({1.2, 2.1, 0.}), Vector({1.2, 2., 0.}), Feature::edge, 2},
       {Vector({-3., 1.5, 0.2}), Vector({0., 1.5, 0.}), Feature::edge, 3},
       {Vector({-0.1, -0.2, 0.3}), Vector({0., 0., 0.}), Feature::vertex, 0},
       {Vector({2.1, -0.2, 0.3}), Vector({2., 0., 0.}), Feature::vertex, 1},
       {Vector({9., 9., 9.}), Vector({2., 2., 0.}), Feature::vertex, 2},
       {Vector({-0.1, 2.2, -0.3}), Vector({0., 2., 0.}), Feature::vertex, 3}};
    for (const auto &[slave, closest, feature, where] : cases)
      {
        const auto projection = project(slave, square, edge_tolerance);
        expect_consistent(slave, square, projection);
        EXPECT_LE((slave - projection.offset - closest).norm(), 1e-14) << slave;
        EXPECT_EQ(projection.feature, feature) << slave;
        EXPECT_EQ(projection.where, where) << slave;
      }
  }


  TEST(Projection, NamesTheEdgeOrVertexWithinTheTolerance)
  {
    // Local coordinates run over [-1,1] for 2 lengths: a distance here is a distance there.
    for (const double tolerance : {1e-3, 0.05, 0.25})
      {
        const double in = 0.9 * tolerance, out = 1.1 * tolerance;
        const auto feature = [&](const double x, const double y, unsigned int &where) {
          const Vector slave({x, y, 0.2});
          const auto projection = project(slave, square, tolerance);
          // The tolerance names; it does not move the point.
          EXPECT_LE((projection.offset - Vector({0., 0., 0.2})).norm(), 1e-14);
          where = projection.where;
          return projection.feature;
        };
        unsigned int where;
        EXPECT_EQ(feature(1., in, where), Feature::edge);
        EXPECT_EQ(where, 0u);
        EXPECT_EQ(feature(2. - in, 1., where), Feature::edge);
        EXPECT_EQ(where, 1u);
        EXPECT_EQ(feature(1., 2. - in, where), Feature::edge);
        EXPECT_EQ(where, 2u);
        EXPECT_EQ(feature(in, 1., where), Feature::edge);
        EXPECT_EQ(where, 3u);
        EXPECT_EQ(feature(1., out, where), Feature::face);
        EXPECT_EQ(feature(2. - out, 1., where), Feature::face);
        EXPECT_EQ(feature(in, in, where), Feature::vertex);
        EXPECT_EQ(where, 0u);
        EXPECT_EQ(feature(2. - in, in, where), Feature::vertex);
        EXPECT_EQ(where, 1u);
        EXPECT_EQ(feature(2. - in, 2. - in, where), Feature::vertex);
        EXPECT_EQ(where, 2u);
        EXPECT_EQ(feature(in, 2. - in, where), Feature::vertex);
        EXPECT_EQ(where, 3u);
        EXPECT_EQ(feature(in, out, where), Feature::edge);
        EXPECT_EQ(where, 3u);
      }
    // A node exactly on a corner or an edge, as in matching meshes, whatever rounding does.
    for (const double shift : {-1e-15, 0., 1e-15})
      {
        EXPECT_EQ(project(Vector({shift, 2. + shift, 0.}), square).feature, Feature::vertex);
        EXPECT_EQ(project(Vector({1., shift, 0.}), square).feature, Feature::edge);
      }
  }


  TEST(Projection, IsTheSameInAnyFrame)
  {
    // A parallelogram far away, small and turned: xi = 0.2, eta = -0.6.
    const Vector u({1e-3, 2e-3, 0.}), v({-1e-3, 1e-3, 2e-3}), origin({10., -20., 30.});
    const Segment segment = {{origin - u - v, origin + u - v, origin + u + v, origin - u + v}};
    Vector normal         = cross_product_3d(u, v);
    normal /= normal.norm();
    const auto projection = project(origin + 0.2 * u - 0.6 * v + 1e-4 * normal, segment);
    EXPECT_NEAR(projection.xi, 0.2, 1e-11);
    EXPECT_NEAR(projection.eta, -0.6, 1e-11);
    EXPECT_LE((projection.offset - 1e-4 * normal).norm(), 1e-14);
    EXPECT_LE((segment_normal(segment, 0.2, -0.6) - normal).norm(), 1e-11);
    EXPECT_LE((area_vector(segment) - 4. * cross_product_3d(u, v)).norm(), 1e-16);
  }


  TEST(SegmentNormal, IsTheCrossProductOfTheTangents)
  {
    // Outward for corners counter-clockwise seen from outside.
    EXPECT_LE((segment_normal(square, 0.3, -0.4) - Vector({0., 0., 1.})).norm(), 1e-16);
    EXPECT_LE((area_vector(square) - Vector({0., 0., 4.})).norm(), 1e-16);

    // The hyperbolic paraboloid z = w x y over [-1,1]^2 has the normal (-w y, -w x, 1).
    const double w       = 0.3;
    const Segment saddle = {
      {Vector({-1., -1., w}), Vector({1., -1., -w}), Vector({1., 1., w}), Vector({-1., 1., -w})}};
    for (const double x : {-1., -0.2, 0.5, 1.})
      for (const double y : {-0.9, 0., 0.7})
        {
          Vector normal({-w * y, -w * x, 1.});
          normal /= normal.norm();
          EXPECT_LE((segment_normal(saddle, x, y) - normal).norm(), 1e-15);
        }
    // Its area vector is that of the diagonals: flat.
    EXPECT_LE((area_vector(saddle) - Vector({0., 0., 4.})).norm(), 1e-15);
  }


  // A square of edge 2 with random corners.
  Segment
  random_segment(std::mt19937 &generator, const double distortion)
  {
    std::uniform_real_distribution<double> uniform(-distortion, distortion);
    Segment segment = square;
    for (auto &corner : segment)
      corner += Vector({uniform(generator), uniform(generator), uniform(generator)});
    return segment;
  }


  TEST(Projection, FindsTheFootOfAKnownNormalOnWarpedSegments)
  {
    std::mt19937 generator(3);
    std::uniform_real_distribution<double> local(-0.95, 0.95), height(-0.5, 0.5);
    double worst = 0.;
    for (unsigned int trial = 0; trial < 2000; ++trial)
      {
        const Segment segment = random_segment(generator, 0.4);
        const double xi = local(generator), eta = local(generator), h = height(generator);
        const Vector normal = normal_of(segment, xi, eta);
        EXPECT_LE((segment_normal(segment, xi, eta) - normal).norm(), 1e-14);

        // Near the surface the foot is unique; further off another point may be closer.
        const Vector slave    = point_of(segment, xi, eta) + h * normal;
        const auto projection = project(slave, segment, edge_tolerance);
        expect_consistent(slave, segment, projection);
        EXPECT_EQ(projection.feature, Feature::face) << trial;
        worst = std::max(worst, (projection.offset - h * normal).norm());
        EXPECT_LE((projection.offset - h * normal).norm(), 1e-10) << trial << " " << h;
      }
    report("largest error of a foot on warped segments", worst);
  }


  // Distance to the closest point, by a grid that closes in on its best point from several starts.
  double
  distance_by_search(const Vector &slave, const Segment &segment)
  {
    constexpr int n  = 40;
    double best      = 1e300;
    double centre[2] = {0., 0.}, half = 1.;
    for (unsigned int level = 0; level < 14; ++level)
      {
        double next[2] = {centre[0], centre[1]};
        for (int i = 0; i <= n; ++i)
          for (int j = 0; j <= n; ++j)
            {
              const double xi  = std::clamp(centre[0] + half * (2. * i / n - 1.), -1., 1.);
              const double eta = std::clamp(centre[1] + half * (2. * j / n - 1.), -1., 1.);
              const double d   = (slave - point_of(segment, xi, eta)).norm();
              if (d < best)
                {
                  best    = d;
                  next[0] = xi;
                  next[1] = eta;
                }
            }
        centre[0] = next[0];
        centre[1] = next[1];
        half *= 0.2;
      }
    return best;
  }


  TEST(Projection, AgreesWithASearchOverAGrid)
  {
    // As far as contact looks: half a segment (of edge 2) from it, inside and around it.
    std::mt19937 generator(5);
    std::uniform_real_distribution<double> local(-1.6, 1.6), height(-1., 1.);
    for (const double distortion : {0., 0.2, 0.4})
      {
        double worst = 0.;
        for (unsigned int trial = 0; trial < 1500; ++trial)
          {
            const Segment segment = random_segment(generator, distortion);
            const double xi = local(generator), eta = local(generator);
            const Vector slave = point_of(segment, xi, eta) +
                                 height(generator) * normal_of(segment, 0., 0.);
            const auto projection = project(slave, segment, edge_tolerance);
            expect_consistent(slave, segment, projection);
            const double difference = projection.offset.norm() - distance_by_search(slave, segment);
            worst                   = std::max(worst, std::abs(difference));
            EXPECT_LE(std::abs(difference), 1e-8) << "distortion " << distortion << ", trial "
                                                  << trial << ", local " << xi << " " << eta;
          }
        report("distortion " + std::to_string(distortion) + ", largest error of a distance", worst);
      }
  }


  TEST(Projection, OffsetIsPerpendicularToTheFeature)
  {
    std::mt19937 generator(11);
    std::uniform_real_distribution<double> local(-1.8, 1.8), height(-0.5, 0.5);
    unsigned int n_faces = 0, n_edges = 0, n_vertices = 0;
    for (unsigned int trial = 0; trial < 2000; ++trial)
      {
        const Segment segment = random_segment(generator, 0.2);
        const double xi = local(generator), eta = local(generator);
        const Vector slave = point_of(segment, xi, eta) +
                             height(generator) * normal_of(segment, 0., 0.);
        const auto projection = project(slave, segment, 1e-12);
        const Vector &offset  = projection.offset;
        switch (projection.feature)
          {
            case Feature::face:
              {
                ++n_faces;
                const Vector normal = segment_normal(segment, projection.xi, projection.eta);
                EXPECT_LE((offset - (offset * normal) * normal).norm(), 1e-9) << trial;
                break;
              }
            case Feature::edge:
              {
                ++n_edges;
                const Vector edge = segment[(projection.where + 1) % 4] - segment[projection.where];
                EXPECT_LE(std::abs(offset * edge), 1e-13) << trial;
                break;
              }
            case Feature::vertex:
              ++n_vertices;
              for (const unsigned int other :
                   {(projection.where + 1) % 4, (projection.where + 3) % 4})
                EXPECT_LE(offset * (segment[other] - segment[projection.where]), 1e-12) << trial;
          }
      }
    EXPECT_GT(n_faces, 200u);
    EXPECT_GT(n_edges, 200u);
    EXPECT_GT(n_vertices, 200u);
  }


  TEST(Projection, SurvivesDegenerateSegments)
  {
    // A quadrilateral with two corners in one place, and one folded to a line.
    Segment triangle      = square;
    triangle[3]           = triangle[2];
    const auto projection = project(Vector({1.2, 0.5, 0.3}), triangle);
    EXPECT_LE((projection.offset - Vector({0., 0., 0.3})).norm(), 1e-10);
    Segment line       = square;
    line[2]            = line[1];
    line[3]            = line[0];
    const auto on_line = project(Vector({0.7, 0.4, 0.3}), line);
    EXPECT_NEAR(on_line.offset.norm(), 0.5, 1e-14);
  }
} // namespace projection_test
