// Our tree of boxes beside FCL's (Pan, Chitta & Manocha 2012) in one process: the pairs of triangles that meet are the same, and the
// times of both are printed - refit of 20,000 moving triangles and search against a blade of 200. Nothing is asked of the times here:
// see DECISIONS.md. FCL is for this test only.

#include <fcl/math/bv/utility.h>  // before the model, which needs it
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/detail/traversal/collision/intersect.h>
#include <fcl/narrowphase/detail/traversal/collision/mesh_collision_traversal_node.h>
#include <fcl/narrowphase/detail/traversal/collision_node.h>
#include <gtest/gtest.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <set>

#include "collision/surface_tree.h"

namespace filum {
namespace fcl_compare_test {

using Pair = std::pair<int, int>;  // of the tissue, of the blade
using Pairs = std::set<Pair>;

double processor_ms() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

/// A sheet or a blade: triangles over a grid.
struct Sheet {
  Points nodes;
  std::vector<Triangle> triangles;
};

Sheet grid(const Vec3& origin, const Vec3& along, const Vec3& across, int n, int m) {
  Sheet s;
  s.nodes.resize(3, (n + 1) * (m + 1));
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= m; ++j) s.nodes.col(i * (m + 1) + j) = origin + along * i / n + across * j / m;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      const int a = i * (m + 1) + j, b = a + m + 1;
      s.triangles.push_back({a, b, b + 1});
      s.triangles.push_back({a, b + 1, a + 1});
    }
  return s;
}

/// Tissue whose every node moves at every step, and a blade that dips into it, slides and turns.
struct Motion {
  Sheet tissue = grid(Vec3(-0.06, -0.06, 0), Vec3(0.12, 0, 0), Vec3(0, 0.12, 0), 100, 100);
  Sheet blade = grid(Vec3(-0.005, -0.04, 0), Vec3(0.01, 0, 0), Vec3(0, 0.08, 0), 5, 20);
  Points x = tissue.nodes, y = blade.nodes;

  void step(int k) {
    for (int i = 0; i < x.cols(); ++i) x(2, i) = 1e-3 * std::sin(0.1 * k + 0.01 * i);
    const double t = 0.02 * k;
    const Mat3 turn = (Eigen::AngleAxisd(0.3 * std::sin(t), Vec3::UnitX()) * Eigen::AngleAxisd(0.7 * t, Vec3::UnitZ())).toRotationMatrix();
    y = (turn * blade.nodes).colwise() + Vec3(0.01 * std::sin(0.7 * t), 0.01 * std::cos(t), 4e-3 * std::sin(1.3 * t));
  }
};

bool meet(const Points& x, const Triangle& a, const Points& y, const Triangle& b) {
  return fcl::detail::Intersect<double>::intersect_Triangle(x.col(a[0]), x.col(a[1]), x.col(a[2]), y.col(b[0]), y.col(b[1]), y.col(b[2]));
}

class Ours {
 public:
  explicit Ours(const Motion& m) : tree_(m.tissue.triangles, m.x) { found_.reserve(m.tissue.triangles.size()); }
  void refit(const Motion& m) { tree_.refit(m.x); }
  void search(const Motion& m, Pairs& pairs) {
    for (std::size_t b = 0; b < m.blade.triangles.size(); ++b) {
      const Triangle& t = m.blade.triangles[b];
      found_.clear();
      tree_.overlaps({m.y.col(t[0]).cwiseMin(m.y.col(t[1])).cwiseMin(m.y.col(t[2])), m.y.col(t[0]).cwiseMax(m.y.col(t[1])).cwiseMax(m.y.col(t[2]))}, found_);
      for (const int a : found_)
        if (meet(m.x, m.tissue.triangles[static_cast<std::size_t>(a)], m.y, t)) pairs.emplace(a, static_cast<int>(b));
    }
  }

 private:
  SurfaceTree tree_;
  std::vector<int> found_;
};

/// FCL's trees without its public call, which copies both models at each query where boxes are not oriented.
template <class Volume>
class Fcl {
 public:
  explicit Fcl(const Motion& m) {
    build(tissue_, m.tissue.triangles, m.x);
    build(blade_, m.blade.triangles, m.y);
  }
  void refit(const Motion& m) {
    replace(tissue_, m.x);
    replace(blade_, m.y);
  }
  void search(const Motion&, Pairs& pairs) {
    fcl::CollisionRequest<double> request(1000000);
    fcl::CollisionResult<double> result;
    Node node;
    const fcl::Transform3<double> here = fcl::Transform3<double>::Identity();
    if constexpr (std::is_same_v<Volume, fcl::AABB<double>>) {
      fcl::Transform3<double> a = here, b = here;
      ASSERT_TRUE(fcl::detail::initialize(node, tissue_, a, blade_, b, request, result));
    } else {
      ASSERT_TRUE(fcl::detail::initialize(node, tissue_, here, blade_, here, request, result));
    }
    fcl::detail::collide(&node);
    for (std::size_t k = 0; k < result.numContacts(); ++k) pairs.emplace(static_cast<int>(result.getContact(k).b1), static_cast<int>(result.getContact(k).b2));
  }

 private:
  using Node = std::conditional_t<std::is_same_v<Volume, fcl::AABB<double>>, fcl::detail::MeshCollisionTraversalNode<Volume>, fcl::detail::MeshCollisionTraversalNodeOBB<double>>;
  using Model = fcl::BVHModel<Volume>;

  void build(Model& model, const std::vector<Triangle>& triangles, const Points& x) {
    std::vector<fcl::Triangle> list;
    for (const Triangle& t : triangles) list.emplace_back(t[0], t[1], t[2]);
    model.beginModel();
    model.addSubModel(points(x), list);
    model.endModel();
  }
  void replace(Model& model, const Points& x) {
    model.beginReplaceModel();
    model.replaceSubModel(points(x));
    model.endReplaceModel(true, true);  // refit, from the leaves up
  }
  const std::vector<fcl::Vector3<double>>& points(const Points& x) {
    buffer_.resize(static_cast<std::size_t>(x.cols()));
    for (int i = 0; i < x.cols(); ++i) buffer_[static_cast<std::size_t>(i)] = x.col(i);
    return buffer_;
  }

  Model tissue_, blade_;
  std::vector<fcl::Vector3<double>> buffer_;
};

struct Times {
  std::vector<double> refit, search, both;
  void print(const char* name) {
    for (std::vector<double>* v : {&refit, &search, &both}) std::sort(v->begin(), v->end());
    const auto at = [](const std::vector<double>& v, double q) { return v[static_cast<std::size_t>(q * static_cast<double>(v.size() - 1))]; };
    std::printf("%-22s refit %.3f, %.3f  search %.3f, %.3f  both %.3f, %.3f ms (p50, p99, processor time, %zu steps)\n", name, at(refit, 0.5), at(refit, 0.99),
                at(search, 0.5), at(search, 0.99), at(both, 0.5), at(both, 0.99), both.size());
  }
};

template <class Tree>
void run(Tree& tree, const Motion& m, Pairs& pairs, Times& times) {
  pairs.clear();
  const double begin = processor_ms();
  tree.refit(m);
  const double fitted = processor_ms();
  tree.search(m, pairs);
  const double end = processor_ms();
  times.refit.push_back(fitted - begin);
  times.search.push_back(end - fitted);
  times.both.push_back(end - begin);
}

TEST(SurfaceTreeBesideFcl, FindsTheSamePairsOfTriangles) {
  constexpr int kSteps = 300, kOriented = 5;  // oriented boxes are not refitted in time
  Motion m;
  m.step(0);
  Ours ours(m);
  Fcl<fcl::AABB<double>> boxes(m);
  Fcl<fcl::OBB<double>> oriented(m);
  Times of_ours, of_boxes, of_oriented;
  Pairs a, b, c;
  std::size_t met = 0;
  for (int k = 1; k <= kSteps; ++k) {
    m.step(k);
    run(ours, m, a, of_ours);
    run(boxes, m, b, of_boxes);
    ASSERT_EQ(a, b) << "step " << k;
    met += a.size();
    if (k % (kSteps / kOriented) != 0) continue;
    run(oriented, m, c, of_oriented);
    ASSERT_EQ(a, c) << "step " << k;
  }
  EXPECT_GT(met, static_cast<std::size_t>(20 * kSteps));
  std::printf("%zu triangles and %zu, %zu pairs in %d steps, the same from each\n", m.tissue.triangles.size(), m.blade.triangles.size(), met, kSteps);
  of_ours.print("our tree");
  of_boxes.print("FCL, AABB");
  of_oriented.print("FCL, OBB");
}

}  // namespace fcl_compare_test
}  // namespace filum
