#include <akmon/output/history.h>

#include <deal.II/base/numbers.h>
#include <deal.II/base/tensor.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/run_case.h"

// The two bars turned, shifted and seen from a moving frame: the same motion, to round-off.

namespace two_bars_moved
{
  using namespace akmon::test;
  using Vector = dealii::Tensor<1, 3>;

  constexpr double v0 = 202.2, gap = 0.01, force = 29998.604, pressure = 29998.604;
  constexpr double mass     = 2. * 7.337e-4 * 10.; // of both bars
  constexpr double accuracy = 1e-9;


  // Rodrigues' formula, 35 degrees about (1, 2, 3).
  Vector
  turned(const Vector &x, const double angle = 35.)
  {
    const double t = angle * dealii::numbers::PI / 180.;
    Vector axis({1., 2., 3.});
    axis /= axis.norm();
    return std::cos(t) * x + std::sin(t) * cross_product_3d(axis, x) +
           (1. - std::cos(t)) * (axis * x) * axis;
  }


  Vector
  unturned(const Vector &x)
  {
    return turned(x, -35.);
  }


  Vector
  vector_at(const Table &history, const std::string &name, const std::size_t row)
  {
    return Vector(
      {history[name + "_x"][row], history[name + "_y"][row], history[name + "_z"][row]});
  }


  std::string
  text(const Vector &v)
  {
    return akmon::shortest_text(v[0]) + ", " + akmon::shortest_text(v[1]) + ", " +
           akmon::shortest_text(v[2]);
  }


  struct Frame
  {
    const char *name;
    bool is_turned;
    Vector velocity;
  };


  // For failure messages.
  void
  PrintTo(const Frame &frame, std::ostream *out)
  {
    *out << frame.name;
  }


  class TwoBarsMoved : public testing::TestWithParam<std::tuple<Frame, const char *>>
  {
  protected:
    // The largest deviation of a column-wise comparison, one assertion instead of one per row.
    void
    compare_energy(const char *column)
    {
      double deviation = 0.;
      for (std::size_t i = 0; i < plain.n_rows(); ++i)
        {
          double energy = moved[column][i];
          if (std::string(column) == "kinetic_energy") // total momentum is zero in the plain run
            energy -= 0.5 * mass * frame.velocity.norm_square();
          deviation = std::max(deviation, std::abs(energy - plain[column][i]));
        }
      RecordProperty(column, akmon::shortest_text(deviation / plain["kinetic_energy"][0]));
      EXPECT_LE(deviation, accuracy * plain["kinetic_energy"][0]) << column;
    }


    Vector
    to_plain(const Vector &v) const
    {
      return frame.is_turned ? unturned(v) : v;
    }


    const Frame frame           = std::get<0>(GetParam());
    const std::string gap_model = std::string("Contact/interface/Gap model=") +
                                  std::get<1>(GetParam());
    const Table plain = run_case(shipped("two_bars"), {gap_model});
    const Table moved = run_moved();

  private:
    Table
    run_moved() const
    {
      std::vector<std::string> overrides = {gap_model};
      for (const std::string body : {"left", "right"})
        {
          const Vector v({body == "left" ? v0 : -v0, 0., 0.});
          if (frame.velocity.norm() > 0.)
            overrides.push_back("Bodies/" + body + "/Velocity=" +
                                text((frame.is_turned ? turned(v) : v) + frame.velocity));
        }
      return run_case(shipped(frame.is_turned ? "two_bars_rotated" : "two_bars"), overrides);
    }
  };


  TEST_P(TwoBarsMoved, move_as_the_plain_ones)
  {
    ASSERT_EQ(moved.n_rows(), plain.n_rows());
    EXPECT_EQ(moved["time"], plain["time"]);
    EXPECT_EQ(moved["active_pairs"], plain["active_pairs"]);

    double u = 0., v = 0., f = 0., p = 0., penetration = 0.;
    for (std::size_t i = 0; i < plain.n_rows(); ++i)
      {
        const double t = plain["time"][i];
        for (const std::string probe : {"left_face", "left_middle", "left_end"})
          {
            u = std::max(u,
                         (to_plain(vector_at(moved, probe + ".displacement", i) -
                                   t * frame.velocity) -
                          vector_at(plain, probe + ".displacement", i))
                           .norm());
            v = std::max(v,
                         (to_plain(vector_at(moved, probe + ".velocity", i) - frame.velocity) -
                          vector_at(plain, probe + ".velocity", i))
                           .norm());
          }
        f           = std::max(f,
                     (to_plain(vector_at(moved, "interface.force", i)) -
                      vector_at(plain, "interface.force", i))
                       .norm());
        p           = std::max(p, (vector_at(moved, "momentum", i) - mass * frame.velocity).norm());
        penetration = std::max(penetration, moved["max_penetration_rel"][i]);
      }
    RecordProperty("displacement", akmon::shortest_text(u / gap));
    RecordProperty("velocity", akmon::shortest_text(v / v0));
    RecordProperty("force", akmon::shortest_text(f / force));
    RecordProperty("momentum", akmon::shortest_text(p / (0.5 * mass * v0)));
    RecordProperty("penetration", akmon::shortest_text(penetration));
    EXPECT_LE(u, accuracy * gap);
    EXPECT_LE(v, accuracy * v0);
    EXPECT_LE(f, accuracy * force);
    EXPECT_LE(p, accuracy * 0.5 * mass * v0);
    EXPECT_LE(penetration, 1e-12);

    for (const char *const column :
         {"kinetic_energy", "strain_energy", "impact_dissipation", "external_work"})
      compare_energy(column);
  }


  // Cauchy stress turns as a tensor: sigma = R sigma_plain R^T.
  TEST_P(TwoBarsMoved, carry_the_turned_stress)
  {
    const Vector e[3] = {Vector({1., 0., 0.}), Vector({0., 1., 0.}), Vector({0., 0., 1.})};
    const char *const components[3][3] = {{"xx", "xy", "xz"},
                                          {"xy", "yy", "yz"},
                                          {"xz", "yz", "zz"}};

    double deviation = 0.;
    for (const std::string probe : {"left_face", "left_middle", "left_end"})
      for (std::size_t i = 0; i < plain.n_rows(); ++i)
        for (unsigned int a = 0; a < 3; ++a)
          for (unsigned int b = 0; b <= a; ++b)
            {
              const Vector n = frame.is_turned ? turned(e[a]) : e[a],
                           m = frame.is_turned ? turned(e[b]) : e[b];
              double stress  = 0.;
              for (unsigned int k = 0; k < 3; ++k)
                for (unsigned int l = 0; l < 3; ++l)
                  stress += n[k] * moved[probe + ".stress_" + components[k][l]][i] * m[l];
              deviation = std::max(deviation,
                                   std::abs(stress -
                                            plain[probe + ".stress_" + components[a][b]][i]));
            }
    RecordProperty("stress", akmon::shortest_text(deviation / pressure));
    EXPECT_LE(deviation, accuracy * pressure);
  }


  // The shipped case is what its comment says: R x + (3, -2, 5).
  TEST(TwoBarsRotated, is_the_turned_case)
  {
    const auto plain = akmon::Case::read(shipped("two_bars"), {});
    const auto moved = akmon::Case::read(shipped("two_bars_rotated"), {});
    const Vector shift({3., -2., 5.});
    for (unsigned int b = 0; b < 2; ++b)
      {
        EXPECT_LE((moved.bodies[b].position - turned(plain.bodies[b].position) - shift).norm(),
                  1e-13);
        EXPECT_LE((moved.bodies[b].velocity - turned(plain.bodies[b].velocity)).norm(), 1e-12);
      }
    for (unsigned int p = 0; p < 3; ++p)
      EXPECT_LE((Vector(moved.probes[p].point) - turned(Vector(plain.probes[p].point)) - shift)
                  .norm(),
                1e-13);
  }


  class OverhangingBars : public testing::TestWithParam<std::tuple<const char *, const char *>>
  {
  };


  // Bars that move across each other while they meet: slaves at the rim hang over their partner's
  // edge, and gaps close under friction. Forces at the two ends of such a gap must make no couple.
  // The decoupled solver does without for friction, whose closed solution needs A_ii to be
  // isotropic.
  TEST_P(OverhangingBars, keep_their_angular_momentum)
  {
    const std::string solver = std::get<0>(GetParam()), friction = std::get<1>(GetParam());
    const auto history = run_case(shipped("two_bars"),
                                  {"Contact solver/Type=" + solver,
                                   "Contact/interface/Friction coefficient=" + friction,
                                   "Bodies/left/Box/Cells=4, 2, 2",
                                   "Bodies/right/Box/Cells=4, 2, 2",
                                   "Bodies/left/Velocity=202.2, 6, 8"});
    EXPECT_GT(history["impact_dissipation"].back(), 0.);
    double change = 0.;
    for (std::size_t i = 0; i < history.n_rows(); ++i)
      change = std::max(change,
                        (vector_at(history, "angular_momentum", i) -
                         vector_at(history, "angular_momentum", 0))
                          .norm());
    constexpr double length = 10.;
    RecordProperty("angular_momentum", akmon::shortest_text(change / (mass * v0 * length)));
    EXPECT_LE(change, 1e-14 * mass * v0 * length);
  }


  INSTANTIATE_TEST_SUITE_P(Solvers,
                           OverhangingBars,
                           testing::Values(std::make_tuple("decoupled", "0"),
                                           std::make_tuple("coupled", "0"),
                                           std::make_tuple("coupled", "0.3")));


  INSTANTIATE_TEST_SUITE_P(
    Frames,
    TwoBarsMoved,
    testing::Combine(testing::Values(Frame{"turned", true, Vector()},
                                     Frame{"moving", false, Vector({6., 0., 8.})},
                                     Frame{"turned_and_moving", true, Vector({6., 0., 8.})}),
                     testing::Values("point to segment", "point to point")),
    [](const auto &info) {
      return std::get<0>(info.param).name +
             std::string(std::get<1>(info.param) == std::string("point to point") ?
                           "_point_to_point" :
                           "_point_to_segment");
    });
} // namespace two_bars_moved
