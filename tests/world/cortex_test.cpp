#include "world/cortex.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "base/error.h"

namespace filum {
namespace cortex_test {

CortexShape fissured() {
  CortexShape s;
  s.fissure_depth = 24e-3;
  s.fissure_gap = 3e-3;
  return s;
}

TEST(Cortex, IsAMeshWithoutBadElements) {
  for (const CortexShape& shape : {CortexShape(), fissured()}) {
    const Cortex c = make_cortex(shape, "cortex");
    EXPECT_NO_THROW(check_mesh(c.mesh, "cortex"));
    EXPECT_GT(mesh_quality(c.mesh).worst_shape, 0.05);
    EXPECT_TRUE(std::is_sorted(c.surface_nodes.begin(), c.surface_nodes.end()));
  }
}

TEST(Cortex, LipsOfTheFissureAreApartAndItsWallsCanBeTouched) {
  const CortexShape shape = fissured();
  const Cortex open = make_cortex(shape, "cortex"), closed = make_cortex(CortexShape(), "cortex");
  EXPECT_GT(open.mesh.n_nodes(), closed.mesh.n_nodes());
  EXPECT_GT(open.surface.size(), closed.surface.size() + 200);
  // the middle of the fissure is empty: no element holds the point half way down
  const Vec3 p(0, 0, -8e-3);
  int nearest = 0;
  for (int i = 0; i < open.mesh.n_nodes(); ++i)
    if ((open.mesh.nodes.col(i) - p).norm() < (open.mesh.nodes.col(nearest) - p).norm()) nearest = i;
  EXPECT_GT(std::abs(open.mesh.nodes(1, nearest)), 0.3e-3);
}

TEST(Cortex, AnOpenSideLeansOverTheBoneAndCanBeTouched) {
  CortexShape shape;
  shape.open_side = true;
  shape.lean = 6e-3;
  const Cortex c = make_cortex(shape, "cortex"), closed = make_cortex(CortexShape(), "cortex");
  EXPECT_NO_THROW(check_mesh(c.mesh, "cortex"));
  EXPECT_GT(c.surface.size(), closed.surface.size() + 100);
  EXPECT_LT(c.held.size(), closed.held.size());
  EXPECT_NEAR(c.mesh.nodes.row(1).minCoeff(), -6e-3, 1e-3);
  EXPECT_LT(c.bone_y, c.mesh.nodes.row(1).minCoeff());
  for (const int i : c.held) EXPECT_TRUE(c.mesh.nodes(2, i) > -0.999 * shape.size.z() || c.mesh.nodes(1, i) > -1e-9);  // upright below
  shape.fissure_depth = 10e-3;
  EXPECT_THROW(make_cortex(shape, "cortex"), InputError);
}

TEST(Cortex, HeldNodesAreTheBorderOnly) {
  const Cortex c = make_cortex(fissured(), "cortex");
  const std::set<int> held(c.held.begin(), c.held.end());
  for (const Triangle& t : c.surface) EXPECT_FALSE(held.count(t[0]) && held.count(t[1]) && held.count(t[2]));
}

TEST(Cortex, ImpossibleSizesAreRefused) {
  CortexShape s;
  s.size.x() = -1.0;
  EXPECT_THROW(make_cortex(s, "cortex"), InputError);
  s = {};
  s.cells = {20, 15, 8};
  EXPECT_THROW(make_cortex(s, "cortex"), InputError);
  s.cells = {100, 100, 100};
  EXPECT_THROW(make_cortex(s, "cortex"), InputError);
  s = fissured();
  s.fissure_depth = 39e-3;
  EXPECT_THROW(make_cortex(s, "cortex"), InputError);
}

}  // namespace cortex_test
}  // namespace filum
