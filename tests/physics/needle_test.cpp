#include "physics/needle.h"

#include <gtest/gtest.h>

#include "tests/allocation_count.h"

namespace filum {
namespace needle_test {

constexpr double kWeight = 9.81;

/// A needle whose middle lies along y between the pads of one tool at the origin, handle up.
struct Held {
  NeedleShape shape;
  NeedleBody body;
  NeedleState state;
  NeedleOptions options;
  explicit Held(double grip, double flat = 0.0) : shape(make(flat)), body(shape, 1) {
    options.gravity.setZero();
    NeedleTool& t = body.tools[0];
    t.pads.half_width = 0.2e-3;
    t.grip_force = grip;
    t.bars_touch = false;
    state.X_WN.p = Vec3(0, 0, 0.5e-3) - shape.point(0.5 * shape.length());
    EXPECT_TRUE(body.take(0, 1e-4, state));
  }
  static NeedleShape make(double flat) {
    NeedleShape n;
    n.flat_width = flat;
    return n;
  }
  /// Loads the needle at arc `a` with a force for a second; returns how far that point has gone.
  double pull(double share, const Vec3& force, double seconds = 0.2) {
    const double a = share * shape.length();
    const Vec3 before = state.X_WN * shape.point(a);
    for (double t = 0; t < seconds; t += options.dt) {
      body.tethers.clear();
      RodTether weight;  // a soft spring far away: nearly a dead load
      weight.arc = a;
      weight.stiffness = 1e-3 * force.norm() * Mat3::Identity();
      weight.anchor = state.X_WN * shape.point(a) + force / (1e-3 * force.norm());
      body.tethers.push_back(weight);
      body.step(state, options);
    }
    return (state.X_WN * shape.point(a) - before).norm();
  }
};

TEST(Needle, FallsAndComesToRestOnTheSheet) {
  NeedleShape shape;
  NeedleBody body(shape, 0);
  NeedleState s;
  NeedleOptions o;
  o.sheet = -1e-3;
  s.X_WN.q = Quat(Eigen::AngleAxisd(0.3, Vec3::UnitX()));
  for (int k = 0; k < 3; ++k) body.step(s, o);
  EXPECT_NEAR(s.v.z(), -kWeight * 3 * o.dt, 1e-9);
  for (int k = 0; k < 1500; ++k) body.step(s, o);
  EXPECT_LT(s.v.norm(), 1e-6);
  EXPECT_NEAR(s.X_WN.p.z(), o.sheet + shape.wire_radius, 2e-6);
  EXPECT_NEAR(std::abs((s.X_WN.q * Vec3::UnitZ()).z()), 1.0, 1e-3) << "lies flat";
}

/// A needle on springs, drawn sideways against a bar by `way` [m] at so much a step.
struct AgainstBar {
  static constexpr double kHand = 200.0;  // [N/m], three springs together
  NeedleShape shape;
  NeedleBody body{shape, 0};
  NeedleState state;
  NeedleOptions options;
  RoundBar bar;
  AgainstBar() {
    options.gravity.setZero();
    const Vec3 middle = shape.point(0.5 * shape.length()), out = middle.normalized();
    bar = {middle + 0.4e-3 * out - 2e-3 * Vec3::UnitZ(), middle + 0.4e-3 * out + 2e-3 * Vec3::UnitZ(), 0.2e-3, 0.2e-3};
    body.bars.push_back(bar);
  }
  Vec3 out() const { return shape.point(0.5 * shape.length()).normalized(); }
  void draw(double way, double a_step, int wait = 200) {
    for (double gone = 0.0; gone < way || wait-- > 0;) {
      gone = std::min(way, gone + a_step);
      body.tethers.clear();
      for (const double share : {0.0, 0.5, 1.0}) {
        RodTether t;
        t.arc = share * shape.length();
        t.anchor = shape.point(t.arc) + gone * out();
        t.stiffness = kHand / 3.0 * Mat3::Identity();
        body.tethers.push_back(t);
      }
      body.step(state, options);
    }
  }
  /// [m], how far the wire's middle has gone.
  double gone() const { return (state.X_WN * shape.point(0.5 * shape.length()) - shape.point(0.5 * shape.length())).dot(out()); }
};

TEST(Needle, PressesOnABarAsItsHandDoes) {
  AgainstBar n;
  const double room = 0.4e-3 - 0.2e-3 - n.shape.wire_radius, way = 0.5e-3;
  n.draw(way, 2e-6);
  const double soft = n.options.bar_stiffness;  // hand and contact in series
  EXPECT_NEAR(n.gone(), room + (way - room) * AgainstBar::kHand / (AgainstBar::kHand + soft), 0.02 * (way - room));
}

TEST(Needle, DoesNotPassABarAtTheSpeedOfHands) {
  for (const double speed : {0.05, 0.2, 0.5}) {
    AgainstBar n;
    n.draw(1.5e-3, speed * n.options.dt);
    EXPECT_LT(n.gone(), 0.4e-3) << speed << ": its axis is 0.4 mm away";
  }
}

TEST(Needle, GripBearsThePullOfTwoPads) {
  const double grip = 0.5, limit = 2.0 * Held::make(0).pad_friction * grip;  // 0.3 N
  Held below(grip), above(grip);
  EXPECT_LT(below.pull(0.5, Vec3(0, 0, 0.95 * limit)), 150e-6);  // elastic
  EXPECT_EQ(below.state.grips[0].held, 1);
  above.pull(0.5, Vec3(0, 0, 1.05 * limit));
  EXPECT_EQ(above.state.grips[0].held, 0) << "drawn out of the pads";
}

TEST(Needle, GripBearsTheTurnOfALineContact) {
  // Turn about the pads' normal by a force at the point of the needle, along the handle: limit mu N w/2.
  const double grip = 0.5;
  Held below(grip, 200e-6), above(grip, 200e-6);  // too flat to roll
  const NeedleShape& n = below.shape;
  const double w = 2.0 * below.state.grips[0].half;
  const double lever = std::abs((n.point(n.length()) - n.point(0.5 * n.length())).y());
  const double limit = n.pad_friction * grip * 0.5 * w / lever;
  auto turn = [&](Held& h, double share) {
    const Vec3 wire = h.state.X_WN.q * n.tangent(0.5 * n.length());
    h.pull(1.0, Vec3(0, 0, share * limit), 0.02);
    return std::acos(std::min(1.0, wire.dot(h.state.X_WN.q * n.tangent(0.5 * n.length()))));
  };
  const double small = turn(below, 0.7), large = turn(above, 1.5);
  EXPECT_LT(small, 0.35);
  EXPECT_GT(large, 3.0 * small) << "it turns between the pads";
}

TEST(Needle, FlattenedBodyResistsRolling) {
  // A force out of the needle's plane at its point rolls the wire about its own axis: a round wire bears 2 mu N r only.
  auto roll = [](double flat, double factor) {
    Held h(0.5, flat);
    const NeedleShape& n = h.shape;
    const double lever = n.point(0.5 * n.length()).x() - n.point(n.length()).x();
    const double limit = 2.0 * n.pad_friction * 0.5 * n.wire_radius / lever;
    h.pull(1.0, Vec3(0, 0, factor * limit), 0.02);
    return std::acos(std::min(1.0, (h.state.X_WN.q * Vec3::UnitX()).x()));
  };
  EXPECT_LT(roll(0.0, 0.5), 0.1);
  EXPECT_GT(roll(0.0, 2.0), 0.3);
  EXPECT_LT(roll(80e-6, 2.0), 0.5 * roll(0.0, 2.0));
}

TEST(Needle, HangsBelowWhatHoldsItsSwage) {
  NeedleShape shape;
  NeedleBody body(shape, 0);
  NeedleState s;
  NeedleOptions o;
  const Vec3 anchor = s.X_WN * shape.point(0.0);
  for (int k = 0; k < 3000; ++k) {
    body.tethers.clear();
    RodTether t;
    t.stiffness = 2e4 * Mat3::Identity();
    t.anchor = anchor;
    body.tethers.push_back(t);
    body.step(s, o);
  }
  const Vec3 hang = s.X_WN.p - s.X_WN * shape.point(0.0);
  EXPECT_LT(hang.head<2>().norm(), 2e-2 * hang.norm());
  EXPECT_LT(hang.z(), 0.0);
  EXPECT_NEAR(body.tethers[0].force.z(), shape.mass() * kWeight, 1e-3 * shape.mass() * kWeight);
}

TEST(Needle, StiffnessSeenAheadIsThatOfTheGrip) {
  Held h(5.0);
  Vec3 point;
  const Mat3 k = h.body.look_ahead(h.state, h.options, 0.5 * h.shape.length(), point);
  EXPECT_NEAR(k(0, 0), 3.0 * h.shape.grip_stiffness, 0.02 * 3.0 * h.shape.grip_stiffness);
  EXPECT_LT((point - Vec3(0, 0, 0.5e-3)).norm(), 10e-6) << "the curved wire is pressed into the pads' plane";
}

TEST(Needle, SeenAheadUnderItsLoadTheSpringGivesThatLoadBack) {
  Held h(5.0);
  const double arc = 0.1 * h.shape.length();  // a lever of half the needle: large turns
  const Vec3 load(2e-3, -1e-3, 3e-3);
  Vec3 rest, loaded;
  const Mat3 k = h.body.look_ahead(h.state, h.options, arc, rest, load);
  RodTether pull;  // the same load as a soft spring from far away
  pull.arc = arc;
  pull.stiffness = 1e-4 * Mat3::Identity();
  pull.anchor = h.state.X_WN * h.shape.point(arc) + load / 1e-4;
  h.body.tethers.assign(1, pull);
  h.body.step(h.state, h.options);
  loaded = h.state.X_WN * h.shape.point(arc);
  EXPECT_LT((k * (loaded - rest) - load).norm(), 1e-2 * load.norm());
}

/// A jaw comes down on the needle in one step, by nearly its own breadth, while the thread holds the swage: from sides and at places where turns about the
/// needle's middle end with 6 to 700 mN left.
TEST(Needle, TurnsAboutAHeldSwageAsFarAsJawsPushIt) {
  const NeedleShape shape;
  for (const int k : {4, 6, 14, 26, 31, 35}) {
    NeedleBody body(shape, 1);
    NeedleState s;
    NeedleOptions o;
    const double angle = 0.35 * k;
    const Vec3 side(std::cos(angle) * std::cos(0.2 * k), std::sin(angle) * std::cos(0.2 * k), std::sin(0.2 * k));
    NeedleTool& jaw = body.tools[0];
    jaw.X_end.p = s.X_WN * shape.point((0.5 + 0.5 * k / 36.0) * shape.length()) + 0.1e-3 * side;
    jaw.X_end.q = Quat::FromTwoVectors(Vec3::UnitX(), side.unitOrthogonal());
    for (int b = 0; b < 3; ++b) {
      jaw.bars.a_T[b] = Vec3(-2e-3, 0, 0);
      jaw.bars.b_T[b] = Vec3(2e-3, 0, 0);
      jaw.bars.r_a[b] = jaw.bars.r_b[b] = 0.7e-3;
    }
    RodTether thread;
    thread.stiffness = 2e4 * Mat3::Identity();
    thread.anchor = s.X_WN * shape.point(0.0);
    body.tethers.assign(1, thread);
    const NeedleSummary summary = body.step(s, o);
    EXPECT_LT(summary.residual, 1e-4) << "side " << k;
    EXPECT_LT((s.X_WN * shape.point(0.0) - thread.anchor).norm(), 20e-6) << "side " << k;
  }
}

TEST(Needle, StepsAllocateNothingAndRepeatExactly) {
  auto run = [](int steps) {
    Held h(0.5);
    h.pull(0.9, Vec3(0.01, 0, 0.02), 0.01);
    const long before = allocations;
    for (int k = 0; k < steps; ++k) h.body.step(h.state, h.options);
    if (FILUM_COUNTS_ALLOCATIONS) {
      EXPECT_EQ(allocations, before);
    }
    return h.state.X_WN;
  };
  const Pose a = run(100), b = run(100);
  EXPECT_EQ(a.p, b.p);
  EXPECT_EQ(a.q.coeffs(), b.q.coeffs());
}

/// A spring K pulls the middle of a free needle against a surface of stiffness k whose anchor is d higher: it comes up by k d / (k + K). Pulled sideways
/// beyond the friction F of the surface it goes on until K bears just F, and a surface that it is above does nothing.
TEST(Needle, ASurfacePushesAndRubsButDoesNotPull) {
  constexpr double kSpring = 100.0, kSurface = 200.0, kFriction = 20e-6, kDepth = 1e-6, kSideways = 1e-6;
  const NeedleShape shape;
  NeedleBody body(shape, 0);
  NeedleOptions o;
  o.gravity.setZero();
  const double middle = 0.5 * shape.length();
  const auto rest = [&](double depth, double sideways) {  // where the middle comes to rest
    NeedleState s;
    const Vec3 start = s.X_WN * shape.point(middle);
    for (int k = 0; k < 200; ++k) {
      body.tethers.clear();
      RodTether spring, surface;
      spring.arc = surface.arc = middle;
      spring.stiffness = kSpring * Mat3::Identity();
      spring.anchor = start + sideways * Vec3::UnitX();
      surface.stiffness = kSurface * Vec3::UnitZ() * Vec3::UnitZ().transpose();
      surface.anchor = start + depth * Vec3::UnitZ();
      surface.along = Vec3::UnitX();
      surface.across = Vec3::UnitY();
      surface.stick = kSurface;
      surface.limit = kFriction;
      body.tethers = {spring, surface};
      body.step(s, o);
    }
    return Vec3(s.X_WN * shape.point(middle) - start);
  };
  EXPECT_NEAR(rest(kDepth, 0.0).z(), kSurface * kDepth / (kSurface + kSpring), 1e-10);
  EXPECT_NEAR(rest(-kDepth, 0.0).z(), 0.0, 1e-10);
  EXPECT_NEAR(rest(kDepth, kSideways).x(), kSideways - kFriction / kSpring, 1e-10);
  EXPECT_NEAR(rest(kDepth, 0.1 * kSideways).x(), kSpring * 0.1 * kSideways / (kSpring + kSurface), 1e-10) << "sticks by the bristle";
}

}  // namespace needle_test
}  // namespace filum
