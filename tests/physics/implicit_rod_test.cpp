#include "physics/implicit_rod.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/allocation_count.h"

namespace filum {
namespace implicit_rod_test {

Points straight(int n, double spacing) {
  Points x = Points::Zero(3, n);
  for (int i = 0; i < n; ++i) x(0, i) = spacing * i;
  return x;
}

void hold(ImplicitRod& rod, const RodState& s, int i) {
  rod.boundary.held.col(i).head<3>().setConstant(true);
  rod.boundary.target.col(i).head<3>() = s.x.col(i);
}

struct ElasticaRow {
  double gamma, x, drop;  // q L^3 / B, tip over length
};

class Cantilever : public testing::TestWithParam<ElasticaRow> {};

// Planar elastica under its own weight, integrated by Runge-Kutta 4 in 4000 steps.
TEST_P(Cantilever, TipHangsWhereTheElasticaSays) {
  const ElasticaRow row = GetParam();
  constexpr int kEdges = 40;
  RodMaterial m;
  m.drag = 0.0;
  const double weight = m.mass_per_length() * 9.81;
  const double length = std::cbrt(row.gamma * m.EI / weight), h = length / (kEdges + 0.5);
  RodState s = RodState::from_nodes(straight(kEdges + 2, h), kEdges + 2);
  ImplicitRod rod(m, ContactMaterial(), s.n);
  RodMemory memory = rod.make_memory();
  hold(rod, s, 0);  // the clamp is in the middle of the first edge
  hold(rod, s, 1);
  rod.boundary.held(3, 0) = true;
  RodStepOptions o;
  o.dt = 0.05;
  o.force_tolerance = 1e-12;
  o.relative_tolerance = 1e-6;
  for (int k = 0; k < 400; ++k) {
    rod.step(s, memory, o);
    if (k > 10 && s.v.cwiseAbs().maxCoeff() < 1e-7) break;
  }
  ASSERT_LT(s.v.cwiseAbs().maxCoeff(), 1e-7);
  const Vec3 tip = s.x.col(s.n - 1) - Vec3(0.5 * h, 0, 0);
  EXPECT_NEAR(tip.x() / length, row.x, 1.5e-3);
  EXPECT_NEAR(-tip.z() / length, row.drop, 1.5e-3);
  EXPECT_NEAR(tip.y(), 0.0, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(SelfWeight, Cantilever,
                         testing::Values(ElasticaRow{0.1, .99991, .01250}, ElasticaRow{1, .99125, .12347},
                                         ElasticaRow{5, .84666, .49591}, ElasticaRow{20, .44523, .82988}));

TEST(ImplicitRod, FallsFreely) {
  RodMaterial m;
  m.drag = 0.0;
  RodState s = RodState::from_nodes(straight(15, 1e-3), 15);
  ImplicitRod rod(m, ContactMaterial(), 15);
  RodMemory memory = rod.make_memory();
  const RodStepOptions o;
  for (int k = 0; k < 100; ++k) rod.step(s, memory, o);
  for (int i = 0; i < s.n; ++i) EXPECT_NEAR((s.v.col(i) - Vec3(0, 0, -0.981)).norm(), 0.0, 1e-5);
}

struct Tumbling {
  RodMaterial m;
  RodState s = RodState::from_nodes(straight(15, 1e-3), 15);
  ImplicitRod rod{m, ContactMaterial(), 15};
  RodMemory memory = rod.make_memory();
  RodStepOptions o;

  Tumbling() {
    std::mt19937 gen(3);
    std::normal_distribution<double> n;
    for (int i = 0; i < 15; ++i) s.v.col(i) = Vec3(0.2, 0, 0) + 0.03 * Vec3(0, std::sin(0.7 * i), std::cos(0.4 * i)) + 0.003 * Vec3(n(gen), n(gen), n(gen));
    rod.material.drag = 0.0;
    o.gravity.setZero();
    o.max_iterations = 50;
    o.force_tolerance = 1e-16;
    o.relative_tolerance = 1e-11;
  }
  double mass(int i) const { return m.mass_per_length() * 1e-3 * (i == 0 || i == 14 ? 0.5 : 1.0); }
  Vec3 momentum() const {
    Vec3 p = Vec3::Zero();
    for (int i = 0; i < 15; ++i) p += mass(i) * s.v.col(i);
    return p;
  }
  Vec3 angular_momentum() const {
    Vec3 l = Vec3::Zero();
    for (int i = 0; i < 15; ++i) l += mass(i) * Vec3(s.x.col(i)).cross(Vec3(s.v.col(i)));
    return l;
  }
};

TEST(ImplicitRod, KeepsItsMomentum) {
  Tumbling t;
  const Vec3 before = t.momentum();
  for (int k = 0; k < 300; ++k) t.rod.step(t.s, t.memory, t.o);
  EXPECT_LT((t.momentum() - before).norm(), 1e-6 * before.norm());
}

TEST(ImplicitRod, MidpointRuleKeepsAngularMomentumToo) {
  Tumbling t;
  t.o.dt = 2e-5;
  const Vec3 p = t.momentum(), l = t.angular_momentum();
  for (int k = 0; k < 500; ++k) t.rod.midpoint_step(t.s, t.memory, t.o);
  EXPECT_LT((t.momentum() - p).norm(), 1e-6 * p.norm());
  EXPECT_LT((t.angular_momentum() - l).norm(), 1e-3 * l.norm());
}

TEST(ImplicitRod, NotANumberLeavesTheStateAsItWas) {
  Tumbling t;
  t.s.v.setZero();
  const Points before = t.s.x;
  t.rod.boundary.load(0, 3) = std::nan("");
  const RodStepSummary r = t.rod.step(t.s, t.memory, t.o);
  EXPECT_FALSE(r.sound);
  EXPECT_EQ(t.s.x, before);
  EXPECT_TRUE(t.s.v.allFinite());
}

/// Two strands of 17 nodes crossing at right angles, one above the other, held at their four ends. The edge between them
/// is parted.
struct CrossedStrands {
  static constexpr int kNodes = 17;
  RodMaterial m;
  RodState s;
  ImplicitRod rod{m, ContactMaterial(), 2 * kNodes};
  RodMemory memory = rod.make_memory();
  RodStepOptions o;
  int step = 0;

  CrossedStrands() {
    Points x(3, 2 * kNodes);
    for (int i = 0; i < kNodes; ++i) {
      const double u = 0.25e-3 * (i - 8);
      x.col(i) = Vec3(u, 0, 40e-6);
      x.col(kNodes + i) = Vec3(0, u, -40e-6);
    }
    s = RodState::from_nodes(x, 2 * kNodes);
    s.alive[kNodes - 1] = 0;
    o.max_iterations = 8;  // as in the scenes: most of these steps do not converge, and must not cross all the same
    for (int i : {0, kNodes - 1, kNodes, 2 * kNodes - 1}) hold(rod, s, i);
  }

  /// The upper strand is thrown down and up by 0.8 mm fifty times a second, each of its ends somewhat out of time: up to ten
  /// diameters a step.
  void advance() {
    const double t = o.dt * ++step;
    const double turn = 2.0 * std::numbers::pi * 50.0 * t;
    rod.boundary.target(2, 0) = 40e-6 - 0.8e-3 * std::sin(turn);
    rod.boundary.target(2, kNodes - 1) = 40e-6 - 0.8e-3 * std::sin(1.03 * turn);
    rod.boundary.target(2, kNodes) = -40e-6 + 0.3e-3 * std::sin(0.57 * turn);
    rod.step(s, memory, o);
  }

  /// Sum of the signs of all crossings of the two strands seen along z: unchanged by any motion in which they do not pass
  /// through each other, as the ends stay where they are in the picture.
  int crossing_number() const {
    int sum = 0;
    for (int i = 0; i + 1 < kNodes; ++i)
      for (int j = kNodes; j + 1 < 2 * kNodes; ++j) sum += crossing(i, j);
    return sum;
  }
  int crossing(int i, int j) const {
    const Vec3 u = s.x.col(i + 1) - s.x.col(i), v = s.x.col(j + 1) - s.x.col(j), w = s.x.col(j) - s.x.col(i);
    const double det = u.x() * v.y() - u.y() * v.x();
    const double a = (w.x() * v.y() - w.y() * v.x()) / det, b = (w.x() * u.y() - w.y() * u.x()) / det;
    if (!(a >= 0.0 && a < 1.0 && b >= 0.0 && b < 1.0)) return 0;
    const double above = s.x(2, i) + a * u.z() - s.x(2, j) - b * v.z();
    return (above > 0.0) == (det > 0.0) ? 1 : -1;
  }
};

// A million steps of this are run by `filum bench`.
TEST(ImplicitRod, StrandsNeverPassThroughEachOther) {
  CrossedStrands c;
  const int before = c.crossing_number();
  ASSERT_EQ(std::abs(before), 1);
  int touching = 0;
  for (int k = 0; k < 20000; ++k) {
    c.advance();
    ASSERT_TRUE(c.s.x.allFinite());
    ASSERT_EQ(c.crossing_number(), before) << "step " << k;
    touching += c.rod.contact().n_touching(c.m.radius) > 0 ? 1 : 0;
  }
  EXPECT_GT(touching, 5000) << "they must have been driven against each other";
}

TEST(ImplicitRod, StrandsWithoutContactDoPass) {  // what the test above would see
  CrossedStrands c;
  c.rod.self_contact = false;
  const int before = c.crossing_number();
  bool passed = false;
  for (int k = 0; k < 200; ++k) {
    c.advance();
    passed = passed || c.crossing_number() != before;
  }
  EXPECT_TRUE(passed);
}

// More near pairs than there is room for: the search must shorten its reach, and the moves with it, not leave pairs out.
TEST(ImplicitRod, CrowdedStrandsDoNotPassEither) {
  constexpr int kEach = 60;
  Points x(3, 2 * kEach);
  for (int i = 0; i < kEach; ++i) {
    const double u = 10e-6 * (i - 0.5 * kEach + 0.3);
    x.col(i) = Vec3(u, 0, 60e-6);
    x.col(kEach + i) = Vec3(0, u, 0);
  }
  RodMaterial m;
  RodState s = RodState::from_nodes(x, 2 * kEach);
  s.alive[kEach - 1] = 0;
  s.v.leftCols(kEach).row(2).setConstant(-0.3);  // 600 um, ten times the gap, in the first step
  ImplicitRod rod(m, ContactMaterial(), 2 * kEach);
  RodMemory memory = rod.make_memory();
  RodStepOptions o;
  o.max_iterations = 8;
  RodContact all(2 * kEach, 100000);
  all.travel.reach.setConstant(16.0 * m.radius);
  all.find_pairs(s, s.x, m.radius);
  ASSERT_GT(all.pairs().size(), 16u * 2u * kEach) << "or the test shows nothing";
  for (int k = 0; k < 50; ++k) {
    const RodStepSummary summary = rod.step(s, memory, o);
    EXPECT_FALSE(summary.crowded);
    double above = 1.0;  // [m], of the upper strand where it crosses the lower one
    for (int i = 0; i < kEach; ++i) above = std::min(above, s.x(2, i) - s.x.block(2, kEach, 1, kEach).minCoeff());
    ASSERT_GT(above, 0.0) << "step " << k;
  }
}

TEST(ImplicitRod, StepAllocatesNothing) {
  if (!FILUM_COUNTS_ALLOCATIONS) GTEST_SKIP() << "allocations cannot be counted under a sanitizer";
  CrossedStrands c;
  for (int k = 0; k < 100; ++k) c.advance();
  const long before = allocations;
  for (int k = 0; k < 2000; ++k) c.advance();
  EXPECT_EQ(allocations, before);
  const Points copy = c.s.x;
  EXPECT_GT(allocations, before) << "the counter works";
}

TEST(LateTolerance, IsStrictAtFirstAndGrowsUpToItsLimit) {
  RodStepOptions o;
  o.force_tolerance = 1e-10;
  o.relative_tolerance = 1e-3;
  o.strict_iterations = 6;
  EXPECT_DOUBLE_EQ(late_tolerance(o, 5, 10e-3), 10e-6);
  EXPECT_NEAR(late_tolerance(o, 6, 10e-3), 16e-6, 1e-12);
  EXPECT_NEAR(late_tolerance(o, 7, 10e-3), 25.6e-6, 1e-12);
  EXPECT_NEAR(late_tolerance(o, 19, 2e-3), 60e-6, 1e-12) << "3 % of the largest force";
  EXPECT_NEAR(late_tolerance(o, 19, 10e-3), 100e-6, 1e-12);
  EXPECT_NEAR(late_tolerance(o, 19, 0.5), 500e-6, 1e-12) << "never stricter than at first";
  EXPECT_DOUBLE_EQ(late_tolerance(o, 19, 0.0), 3e-6);
  EXPECT_DOUBLE_EQ(late_tolerance(o, 5, 0.0), 1e-10) << "a free thread falls as it did";
  EXPECT_DOUBLE_EQ(late_tolerance(RodStepOptions(), 19, 10e-3), 10e-6) << "not in closed-form problems";
}

}  // namespace implicit_rod_test
}  // namespace filum
