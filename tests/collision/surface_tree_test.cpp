#include "collision/surface_tree.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/rng.h"

namespace filum {
namespace surface_tree_test {

Box box_of(const Triangle& t, const Points& x) {
  Box b{x.col(t[0]), x.col(t[0])};
  for (const int i : t) {
    b.low = b.low.cwiseMin(x.col(i));
    b.high = b.high.cwiseMax(x.col(i));
  }
  return b;
}

bool meet(const Box& a, const Box& b) { return (a.low.array() <= b.high.array()).all() && (b.low.array() <= a.high.array()).all(); }

TEST(SurfaceTree, FindsEveryTriangleAtRestAndAfterRefit) {
  const TetMesh mesh = box_mesh(Vec3::Zero(), Vec3(3, 2, 1), 12, 9, 5);
  Points x = mesh.nodes;
  SurfaceTree tree(surface_triangles(mesh), x);
  std::vector<int> found;
  found.reserve(tree.triangles().size());
  Rng rng(5);
  for (int trial = 0; trial < 200; ++trial) {
    for (int k = 0; k < x.size(); ++k) x.data()[k] += rng.uniform(-0.02, 0.02);
    tree.refit(x);
    const Vec3 p(rng.uniform(-1, 4), rng.uniform(-1, 3), rng.uniform(-1, 2));
    const Box box{p, p + Vec3(rng.uniform(0, 1), rng.uniform(0, 1), rng.uniform(0, 1))};
    found.clear();
    tree.overlaps(box, found);
    EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
    for (std::size_t t = 0; t < tree.triangles().size(); ++t)
      if (meet(box_of(tree.triangles()[t], x), box) && !std::count(found.begin(), found.end(), static_cast<int>(t))) ADD_FAILURE() << t;
  }
}

TEST(SurfaceTree, AFarBoxFindsNothingAndALittleRoomIsNotOverrun) {
  const TetMesh mesh = box_mesh(Vec3::Zero(), Vec3(1, 1, 1), 6, 6, 6);
  const SurfaceTree tree(surface_triangles(mesh), mesh.nodes);
  std::vector<int> found;
  found.reserve(10);
  tree.overlaps({Vec3(5, 5, 5), Vec3(6, 6, 6)}, found);
  EXPECT_TRUE(found.empty());
  tree.overlaps({Vec3(-1, -1, -1), Vec3(2, 2, 2)}, found);
  EXPECT_EQ(found.size(), 10u);
}

}  // namespace surface_tree_test
}  // namespace filum
