#include "physics/rod_resolution.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "collision/segment_distance.h"

namespace filum {
namespace rod_resolution_test {

constexpr double kRadius = 12.5e-6;
constexpr int kCapacity = 64;

double total_twist(const RodState& s) {
  double twist = s.theta[s.n - 2] - s.theta[0];
  for (int i = 1; i + 1 < s.n; ++i) twist += s.ref_twist[i];
  return twist;
}

double length(const RodState& s) { return s.rest_length.head(s.n - 1).sum(); }

double energy(const RodState& s) {
  RodGeometry g(kCapacity);
  update_geometry(s, s.x, s.theta, g);
  return elastic_energy(RodMaterial(), s, g);
}

/// A gentle helix of 0.2 mm edges, twisted.
RodState helix(int n, double curvature) {
  Points x(3, n);
  for (int i = 0; i < n; ++i) {
    const double a = 0.2e-3 * i * curvature;
    x.col(i) = Vec3(std::cos(a) / curvature, std::sin(a) / curvature, 0.02e-3 * i);
  }
  RodState s = RodState::from_nodes(x, kCapacity);
  for (int j = 0; j + 1 < n; ++j) s.theta[j] = 0.05 * j;
  return s;
}

double distance_to(const RodState& s, const Vec3& p) {
  double d = 1e9;
  for (int j = 0; j + 1 < s.n; ++j) d = std::min(d, closest_points(s.x.col(j), s.x.col(j + 1), p, p + Vec3(1e-12, 0, 0)).distance);
  return d;
}

TEST(RodResolution, HalvingKeepsLengthShapeTwistAndMomentum) {
  for (int j : {0, 5, 18}) {
    RodState s = helix(20, 300.0);
    for (int i = 0; i < s.n; ++i) s.v.col(i) = Vec3(1, 0.1 * i, 0);
    const RodState before = s;
    halve_edge(s, j);
    ASSERT_EQ(s.n, 21);
    EXPECT_NEAR(length(s), length(before), 1e-15);
    EXPECT_NEAR(total_twist(s), total_twist(before), 1e-12);
    EXPECT_EQ(s.x.leftCols(j + 1), before.x.leftCols(j + 1));
    EXPECT_EQ(s.x.middleCols(j + 2, 19 - j), before.x.middleCols(j + 1, 19 - j));
    EXPECT_NEAR((s.x.col(j + 1) - 0.5 * (before.x.col(j) + before.x.col(j + 1))).norm(), 0.0, 1e-15);
    EXPECT_NEAR((s.v.col(j + 1) - 0.5 * (before.v.col(j) + before.v.col(j + 1))).norm(), 0.0, 1e-15);
  }
}

TEST(RodResolution, RemovingKeepsLengthEndsAndTwist) {
  for (int i : {2, 7, 17}) {
    RodState s = helix(20, 300.0);
    const RodState before = s;
    remove_node(s, i);
    ASSERT_EQ(s.n, 19);
    EXPECT_NEAR(length(s), length(before), 1e-15);
    EXPECT_NEAR(total_twist(s), total_twist(before), 1e-3) << "node " << i;
    EXPECT_EQ(s.x.leftCols(i), before.x.leftCols(i));
    EXPECT_EQ(s.x.middleCols(i, 19 - i), before.x.middleCols(i + 1, 19 - i));
    for (int j = 0; j + 1 < s.n; ++j) {
      const Vec3 t = (s.x.col(j + 1) - s.x.col(j)).normalized();
      EXPECT_NEAR(s.d1.col(j).dot(t), 0.0, 1e-12);
      EXPECT_NEAR(s.d1.col(j).norm(), 1.0, 1e-12);
    }
  }
}

TEST(RodResolution, StretchedTwistedStraightThreadKeepsItsEnergy) {
  Points x = Points::Zero(3, 20);
  for (int i = 0; i < 20; ++i) x(0, i) = 0.2e-3 * i;
  RodState s = RodState::from_nodes(x, kCapacity);
  s.x *= 1.01;
  for (int j = 0; j < 19; ++j) s.theta[j] = 0.03 * j;  // twisted evenly
  const double before = energy(s), stretch_only = [&] {
    RodState untwisted = s;
    untwisted.theta.setZero();
    return energy(untwisted);
  }();
  ASSERT_GT(before, stretch_only);
  remove_node(s, 9);
  EXPECT_NEAR(energy(s), before, 0.15 * (before - stretch_only));  // stretch is exact, twist to the order of the mesh
  s.theta.setZero();
  EXPECT_NEAR(energy(s), stretch_only, 1e-12 * stretch_only);
  halve_edge(s, 4);
  EXPECT_NEAR(energy(s), stretch_only, 1e-12 * stretch_only);
}

TEST(RodResolution, RestCurvatureStaysInTotal) {
  RodState s = helix(20, 300.0);
  std::mt19937 gen(1);
  std::normal_distribution<double> normal;
  for (int i = 1; i < 19; ++i) s.rest_kappa.col(i) << normal(gen), normal(gen), normal(gen), normal(gen);
  const Eigen::Vector4d before = s.rest_kappa.leftCols(20).rowwise().sum();
  remove_node(s, 6);
  EXPECT_NEAR((s.rest_kappa.leftCols(19).rowwise().sum() - before).norm(), 0.0, 1e-12);
  halve_edge(s, 10);
  EXPECT_NEAR((s.rest_kappa.leftCols(20).rowwise().sum() - before).norm(), 0.0, 1e-12);
}

struct Adapting {
  RodContact contact{kCapacity, 500};
  RodObstacles obstacles{50};
  RodMemory memory;
  ResolutionOptions o;
  int adapt(RodState& s) { return adapt_resolution(o, kCapacity, kRadius, contact, obstacles, s, memory); }
};

TEST(RodResolution, JoinsStraightThreadWithoutJumpingMoreThanARadius) {
  RodState s = helix(40, 120.0);
  const RodState before = s;
  Adapting a;
  for (int k = 0; k < 100; ++k) {
    const RodState last = s;
    const int changes = a.adapt(s);
    EXPECT_LE(changes, a.o.most_changes);
    if (changes == 0) break;
    for (int i = 0; i < last.n; ++i) ASSERT_LT(distance_to(s, last.x.col(i)), kRadius);
  }
  EXPECT_LT(s.n, before.n);
  EXPECT_NEAR(length(s), length(before), 1e-15);
  EXPECT_LE(s.rest_length.head(s.n - 1).maxCoeff(), a.o.longest);
}

TEST(RodResolution, HalvesSharpTurnsAndStopsAtItsLimits) {
  Points x(3, 9);
  for (int i = 0; i < 9; ++i) x.col(i) = Vec3(i < 4 ? 0.4e-3 * i : 1.6e-3, i < 4 ? 0 : 0.4e-3 * (i - 4), 0);
  RodState s = RodState::from_nodes(x, kCapacity);
  Adapting a;
  for (int k = 0; k < 200 && a.adapt(s) > 0; ++k) ASSERT_LE(s.n, kCapacity);
  const Eigen::VectorXd edges = s.rest_length.head(s.n - 1);
  EXPECT_LT(edges.minCoeff(), 2.0 * a.o.shortest) << "the corner is fine";
  EXPECT_GE(edges.minCoeff(), a.o.shortest);
  EXPECT_GT(edges.maxCoeff(), 0.4e-3) << "the straights are coarse";
}

TEST(RodResolution, FrictionMemoryFollowsItsEdge) {
  RodState s = helix(20, 300.0);
  Adapting a;
  a.memory.self.push_back({3, 15, Vec3(1e-6, 0, 0), 0.1});
  a.o.most_changes = 1;
  a.o.longest = 1e-9;  // every edge is too long, none may be joined
  a.o.shortest = 1e-9;
  const double arc_i = 0.0 + s.rest_length.head(3).sum(), arc_j = s.rest_length.head(15).sum();
  for (int k = 0; k < 15; ++k) ASSERT_EQ(a.adapt(s), 1);
  const ContactBristle b = a.memory.self[0];
  EXPECT_NEAR(s.rest_length.head(b.i).sum(), arc_i, 1e-12);
  EXPECT_NEAR(s.rest_length.head(b.j).sum(), arc_j, 1e-12);
}

}  // namespace rod_resolution_test
}  // namespace filum
