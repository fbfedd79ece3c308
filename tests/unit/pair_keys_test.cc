#include <akmon/contact/contact.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "support/two_cubes.h"

// Keys of pairs: what is found in different ways never has the same one, however many bodies there
// are, and pairs come in the order of their keys, which is how a step finds those of the last one.

namespace pair_keys_test
{
  using namespace akmon;
  using namespace akmon::test;
  using namespace akmon::test::two_cubes;

  using Kind = ContactPair::Kind;

  TEST(PairKeys, KindsAreToldApart)
  {
    std::set<ContactPair::Key> keys;
    for (const auto kind :
         {Kind::node_to_face, Kind::rigid_touch, Kind::rigid_feature, Kind::edges})
      for (const bool reversed : {false, true})
        {
          ContactPair pair{};
          pair.kind     = kind;
          pair.reversed = reversed && kind != Kind::edges;
          keys.insert(pair.key());
        }
    EXPECT_EQ(keys.size(), 7u);
  }


  // A free rigid cube that may hit all before it.
  Obstacle
  box(const unsigned int number, const double size, const Vector &place)
  {
    Obstacle obstacle;
    obstacle.name            = "box " + std::to_string(number);
    obstacle.slaves          = {"ground:z+"};
    obstacle.shape           = std::make_shared<BlockShape>(Vector({size, size, size}), 0.);
    obstacle.start.place     = place;
    obstacle.edge_angle      = 0.3;
    obstacle.motion          = Obstacle::Motion::free;
    obstacle.free.properties = obstacle.shape->mass_properties(1.);
    for (unsigned int i = 0; i < number; ++i)
      obstacle.obstacles.push_back("box " + std::to_string(i));
    return obstacle;
  }


  // The last of many boxes that may all meet stands on a face with its corners and edges, beside
  // another one: its touches have numbers up to that of all pairs of boxes.
  TEST(PairKeys, RiseAmongManyRigidBodies)
  {
    constexpr unsigned int n = 80;
    constexpr double size = 0.2, gap = 1e-4;

    std::vector<Obstacle> obstacles;
    for (unsigned int i = 0; i < n; ++i)
      {
        const Vector far({10. + i, 0., 0.}), on_face({0., 0., 0.5 + 0.5 * size + gap});
        const Vector beside = on_face + Vector({size + gap, 0.01, 0.});
        obstacles.push_back(box(i, size, i + 1 == n ? on_face : i + 2 == n ? beside : far));
      }
    const SpaceTimeFunction no_gravity;
    std::vector<RigidBody> bodies;
    for (const auto &obstacle : obstacles)
      bodies.emplace_back(obstacle, no_gravity);
    const Discretization discretization({cube("ground", Vector(), "light")},
                                        {stuff("light", 8.)},
                                        MPI_COMM_SELF);
    NodalState state(discretization);
    const std::vector<PrescribedMotion> no_motions;
    const EssentialConditions conditions(discretization, no_motions);
    const ContactSolver solver;
    const std::vector<SurfaceContact> no_contacts;
    Contact contact(discretization, solver, no_contacts, bodies, conditions);
    contact.search(state);

    const auto &pairs    = contact.get_pairs();
    const auto number_of = [&](const Kind kind) {
      return std::count_if(pairs.begin(), pairs.end(), [&](const ContactPair &pair) {
        return pair.interface == n - 1 && pair.kind == kind;
      });
    };
    EXPECT_GE(number_of(Kind::rigid_touch), 4);
    EXPECT_GE(number_of(Kind::rigid_feature), 4);
    for (std::size_t i = 1; i < pairs.size(); ++i)
      EXPECT_LT(pairs[i - 1].key(), pairs[i].key()) << i;
  }
} // namespace pair_keys_test
