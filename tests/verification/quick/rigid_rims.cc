#include <gtest/gtest.h>

#include <cmath>

#include "support/kept_run.h"
#include "support/rigid_case.h"

// Free rigid bodies on their rims: coins and rings that wobble to rest, cylinders across each
// other, a heap in a container. Nothing gets into anything, as the poses in the history show, and
// what happens keeps momenta and energy.

namespace rigid_rims
{
  using namespace akmon::test;

  constexpr double g = 9.81;

  const RigidPart ground{"ground", "plane", {}, "", ""};

  const std::string turning = " set Velocity = 0.1, 0.2, 0\n set Spin = 0.3, 0.2, 6\n";


  // In a room of five planes.
  std::vector<RigidPart>
  with_room(const std::vector<RigidPart> &inside)
  {
    std::vector<RigidPart> parts =
      {{"ground", "plane", {}, "", ""},
       {"left", "plane", {}, "set Point = -0.8, 0, 0\nset Normal = 1, 0, 0\n", ""},
       {"right", "plane", {}, "set Point = 0.8, 0, 0\nset Normal = -1, 0, 0\n", ""},
       {"front", "plane", {}, "set Point = 0, -0.8, 0\nset Normal = 0, 1, 0\n", ""},
       {"back", "plane", {}, "set Point = 0, 0.8, 0\nset Normal = 0, -1, 0\n", ""}};
    parts.insert(parts.end(), inside.begin(), inside.end());
    return parts;
  }


  std::vector<RigidPart>
  heap()
  {
    return with_room({{"bar",
                       "cylinder",
                       {0.3, 0.8},
                       "set Point = 0.2, 0.1, 0.7\nset Normal = 1, 0.3, 0.2\n",
                       " set Velocity = 0.3, 0.1, -1\n set Spin = 1, 2, 4\n"},
                      {"ring",
                       "torus",
                       {0.4, 0.15},
                       "set Point = -0.1, 0, 1.5\nset Normal = 0.4, 0.2, 1\n",
                       " set Velocity = 0.3, 0.1, -2\n set Spin = -1, 2, 4\n"},
                      {"brick",
                       "box",
                       {0.5, 0.6, 0.4},
                       "set Point = 0.1, 0.1, 2.2\nset Normal = 1, 0.4, 0.2\n",
                       " set Velocity = -0.3, 0.1, -2\n set Spin = -1, -2, 3\n"}});
  }


  // In two steps with friction these are wedged so that no friction forces are found.
  std::vector<RigidPart>
  wedged()
  {
    return with_room(
      {{"brick",
        "box",
        {0.5, 0.6, 0.4},
        "set Point = -0.08558704789522432, -0.14693203833742627, 0.6\n"
        "set Normal = -0.02619172121686475, 0.7359548247121064, 0.18518238849247926\n",
        " set Velocity = 0.2031305586933767, -0.8893103068179034, -0.9464401122864523\n"
        " set Spin = 0.17782274362529815, 5.9513790327829215, -5.616812372401735\n"},
       {"coin",
        "cylinder",
        {0.4, 0.08},
        "set Point = 0.11669174421890255, -0.10083039810454025, 1.7\n"
        "set Normal = -0.8212518905388433, 0.5288734173070981, 0.6309838060433901\n",
        " set Velocity = -0.866708427605549, -0.13491261710175906, -1.893239733713325\n"
        " set Spin = -3.4139471824345864, 3.452192560514525, 3.4643732763195283\n"},
       {"bar",
        "cylinder",
        {0.1, 1.},
        "set Point = -0.07158898837938392, -0.040890955734481545, 2.8\n"
        "set Normal = -0.3181360994084441, 0.01967761713065097, -0.9679506299867996\n",
        " set Velocity = -0.6368929621004, 0.045654466862629306, -0.11923081899025978\n"
        " set Spin = 3.113081131648776, -5.568922871523035, -5.131113867802132\n"}});
  }


  constexpr double in_heaps = 1e-6; // whose motion rounding decides; most are as good as the others

  struct Dropped
  {
    std::string name;
    std::vector<RigidPart> parts;
    double end;
    bool rests;             ///< at the end, with friction
    double allowed = 1e-10; ///< depth over the smaller body's radius
  };

  void
  PrintTo(const Dropped &dropped, std::ostream *const out)
  {
    *out << dropped.name;
  }


  class Rims : public testing::TestWithParam<Dropped>
  {
  };


  TEST_P(Rims, StayOutside)
  {
    for (const double friction : {0.3, 0.})
      {
        const RigidCase rigid(GetParam().parts, friction, GetParam().end, g);
        const Table history = run_case(rigid.file);
        const double depth  = rigid.deepest(history);
        std::cout << "  " << GetParam().name << ", friction " << friction << ": depth " << depth
                  << ", told " << largest_of(history["max_penetration_rel"]) << ", energy error "
                  << largest_of(history["energy_error"]) << ", iterations "
                  << mean_iterations(history) << std::endl;
        EXPECT_LT(depth, GetParam().allowed);
        EXPECT_LT(largest_of(history["max_penetration_rel"]), GetParam().allowed);
        EXPECT_LT(largest_of(history["energy_error"]), 1e-12);
        EXPECT_GT(history["impact_dissipation"].back(), 0.);
        for (const auto &part : GetParam().parts)
          for (const char *const axis : {"x", "y", "z"})
            if (!part.start.empty() && GetParam().rests && friction > 0.)
              {
                EXPECT_NEAR(history[part.name + ".velocity_" + axis].back(), 0., 1e-3);
              }
      }
  }


  INSTANTIATE_TEST_SUITE_P(
    Cases,
    Rims,
    testing::Values(Dropped{"coin",
                            {ground,
                             {"coin",
                              "cylinder",
                              {0.5, 0.1},
                              "set Point = 0, 0, 0.4\nset Normal = 0.4, 0.1, 1\n",
                              turning}},
                            2.,
                            true},
                    Dropped{"ring",
                            {ground,
                             {"ring",
                              "torus",
                              {0.4, 0.1},
                              "set Point = 0, 0, 0.4\nset Normal = 0.4, 0.1, 1\n",
                              turning}},
                            2.,
                            true},
                    Dropped{"crossed",
                            {{"stand", "cylinder", {0.3, 0.6}, "", ""},
                             {"bar",
                              "cylinder",
                              {0.2, 1.},
                              "set Point = 0.28, 0.05, 0.6\nset Normal = 1, 0.3, 0.2\n",
                              " set Spin = 1, 0.2, 3\n"}},
                            1.,
                            false},
                    Dropped{"heap", heap(), 2., true, in_heaps},
                    Dropped{"wedged", wedged(), 2., true, in_heaps}),
    [](const auto &info) { return info.param.name; });


  // Without gravity three bodies collide: all momenta stay.
  TEST(Rims, KeepMomenta)
  {
    const std::vector<RigidPart> parts = {{"coin",
                                           "cylinder",
                                           {0.4, 0.08},
                                           "set Normal = 0.3, 0.2, 1\n",
                                           " set Velocity = 0, 0, 1\n set Spin = 1, 2, 0\n"},
                                          {"ring",
                                           "torus",
                                           {0.4, 0.15},
                                           "set Point = 0.1, 0, 1\nset Normal = 1, 0.2, 0.3\n",
                                           " set Spin = 0, 2, -1\n"},
                                          {"bar",
                                           "cylinder",
                                           {0.1, 1.},
                                           "set Point = 0, 0.1, 2\nset Normal = 0.5, 1, 0.3\n",
                                           " set Velocity = 0, 0, -1\n set Spin = -1, 0, 3\n"}};
    for (const double friction : {0.3, 0.})
      {
        const RigidCase rigid(parts, friction, 2., 0.);
        const Table history = run_case(rigid.file);
        std::cout << "  friction " << friction << ": depth " << rigid.deepest(history)
                  << ", change of momentum " << change_of_momentum(history) << ", angular "
                  << change_of_momentum(history, "angular_momentum_") << std::endl;
        EXPECT_GT(history["impact_dissipation"].back(), 1.);
        EXPECT_LT(rigid.deepest(history), 1e-8);
        EXPECT_LT(change_of_momentum(history), 1e-11);
        EXPECT_LT(change_of_momentum(history, "angular_momentum_"), 1e-10);
        EXPECT_LT(largest_of(history["energy_error"]), 1e-12);
      }
  }


  // In a heap gravity and the forces of the walls are what momentum changes by, and any number of
  // ranks gives the same.
  TEST(Rims, HeapOnRanks)
  {
    const RigidCase rigid(heap(), 0.3, 0.6, g);
    const Table history  = run_case_on_ranks(rigid.file, 1),
                on_three = run_case_on_ranks(rigid.file, 3);
    ASSERT_EQ(on_three.n_rows(), history.n_rows());
    for (const char *const body : {"bar", "ring", "brick"})
      for (const char *const quantity : {".displacement_", ".rotation_", ".velocity_", ".spin_"})
        for (const char *const axis : {"x", "y", "z"})
          EXPECT_EQ(on_three[body + std::string(quantity) + axis],
                    history[body + std::string(quantity) + axis]);

    const double cell = 1e-3, bar = 1e3 * M_PI * 0.09 * 0.8,
                 ring = 1e3 * 2. * M_PI * M_PI * 0.4 * 0.15 * 0.15, brick = 120.;
    for (std::size_t i = 2; i < history.n_rows(); ++i)
      for (const char *const axis : {"x", "y", "z"})
        {
          const auto force = [&](const std::size_t row) {
            double sum = axis[0] == 'z' ? -(cell + bar + ring + brick) * g : 0.;
            for (const char *const wall : {"ground", "left", "right", "front", "back"})
              sum += history[wall + std::string(".force_") + axis][row];
            return sum;
          };
          const auto &momentum = history[std::string("momentum_") + axis];
          EXPECT_NEAR(momentum[i] - momentum[i - 1], 0.5e-3 * (force(i) + force(i - 1)), 1e-9);
        }
  }
} // namespace rigid_rims
