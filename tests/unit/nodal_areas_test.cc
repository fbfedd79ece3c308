#include <akmon/contact/nodal_areas.h>

#include <gtest/gtest.h>

#include "support/two_cubes.h"

// Shares of nodes in the area of the faces around them, by direction.

namespace nodal_areas_test
{
  using namespace akmon;
  using namespace akmon::test;
  using namespace akmon::test::two_cubes;

  TEST(NodalAreas, an_edge_has_no_part_of_the_side_that_is_not_touched)
  {
    BoxShape shape;
    shape.size  = Vector({2., 3., 4.});
    shape.cells = {{2, 1, 1}};
    Body body;
    body.name       = "box";
    body.mesh.shape = shape;
    body.rotation   = dealii::unit_symmetric_tensor<3>();
    body.material   = "stuff";
    const Discretization box({body}, {stuff("stuff", 1.)}, MPI_COMM_SELF);
    const NodalAreas areas(box.n_owned_nodes, box.faces_on(box.boundary_ids("", "", "box")));
    const NodalState state(box);
    double below = 0., aside = 0., slanted = 0.;
    const Vector up({0., 0., 1.}), left({-1., 0., 0.}), half({0., -0.6, 0.8});
    for (unsigned int node = 0; node < box.n_owned_nodes; ++node)
      {
        const auto x      = at_node(state.x, node);
        const double area = areas.facing(state.x, node, up); // of faces that look down
        EXPECT_NEAR(area, x[2] > 0. ? 0. : x[0] == 0. ? 1.5 : 0.75, 1e-14);
        below += area;
        aside += areas.facing(state.x, node, left);
        slanted += areas.facing(state.x, node, half);
      }
    EXPECT_NEAR(below, 6., 1e-13);
    EXPECT_NEAR(aside, 12., 1e-13);
    EXPECT_NEAR(slanted, 0.8 * 6. + 0.6 * 8., 1e-13); // projected
    EXPECT_NEAR(areas.pressure(state.x, 0, Vector({0., 0., 0.})), 0., 0.);
  }
} // namespace nodal_areas_test
