#include "physics/instrument_contact.h"

#include <gtest/gtest.h>

#include "tests/allocation_count.h"

namespace filum {
namespace instrument_contact_test {

constexpr double kStep = 2e-3;
constexpr double kApart = 5e-6;  // [m], by which a hard contact may be off: 0.25 N times what it gives way by, over ODE's share of 0.2 a step

const Quat kAlongX(Eigen::AngleAxisd(M_PI_2, Vec3::UnitY()));    // the handle points along +x
const Quat kAlongY(Eigen::AngleAxisd(-M_PI_2, Vec3::UnitX()));   // along +y

struct Bench {
  std::vector<InstrumentParameters> p;
  Instruments instruments;
  std::vector<InstrumentState> states;
  std::vector<InstrumentCommand> commands;
  std::vector<Vec3> force, torque;

  Bench(int n, Surroundings around, InstrumentParameters all = {})
      : p(static_cast<std::size_t>(n), all), instruments(p, std::move(around)), states(p.size()), commands(p.size()), force(p.size(), Vec3::Zero()), torque(force) {}

  void place(std::size_t i, const Pose& X) {
    states[i].X_WT = states[i].X_WD = commands[i].X_WD = X;
    states[i].angle = states[i].grip_command = commands[i].grip_angle = 0.0;
  }
  void step() { instruments.step(states, commands, force, torque, kStep); }
  /// Leads tool i to `p` at `speed` [m/s] and waits.
  void lead(std::size_t i, const Vec3& to, double speed, double wait = 0.5) {
    while ((to - commands[i].X_WD.p).norm() > 1e-9) {
      const Vec3 left = to - commands[i].X_WD.p;
      commands[i].X_WD.p += std::min(1.0, speed * kStep / left.norm()) * left;
      step();
    }
    for (int k = 0; k < static_cast<int>(wait / kStep); ++k) step();
  }
  Vec3 pull(std::size_t i) const { return p[i].coupling_stiffness * (commands[i].X_WD.p - states[i].X_WT.p); }
};

/// Two closed forceps crossing at their jaws, the second above the first; heights of their axes there.
struct Crossed : Bench {
  static constexpr double kTo = 4e-3;  // [m], from the tips to where they cross
  explicit Crossed(InstrumentParameters all = {}) : Bench(2, {}, all) {
    place(0, {Vec3(-kTo, 0, 0), kAlongX});
    place(1, {Vec3(0, -kTo, 3e-3), kAlongY});
  }
  double apart() const {
    InstrumentContact contact(2, {});
    double gap = 1.0;
    contact.find(p, states, 1.0);
    for (const InstrumentTouch& t : contact.touches()) gap = std::min(gap, t.gap);
    return gap;
  }
};

TEST(InstrumentContact, CrossedJawsPressOnEachOtherAsTheirHandsDo) {
  Crossed c;
  c.lead(1, Vec3(0, -Crossed::kTo, 0), 0.02);
  EXPECT_NEAR(c.apart(), 0.0, kApart);
  EXPECT_LT(c.pull(1).z(), -0.05);
  EXPECT_NEAR(c.pull(0).z(), -c.pull(1).z(), 0.01 * c.pull(0).norm());  // action and reaction, each at rest in its hand
  EXPECT_GT(c.states[1].X_WT.p.z(), c.states[0].X_WT.p.z());
  c.lead(1, Vec3(0, -Crossed::kTo, 3e-3), 0.02);
  EXPECT_NEAR(c.pull(0).norm(), 0.0, 1e-4);
}

TEST(InstrumentContact, DoNotPassThroughEachOtherAtTheSpeedOfHands) {
  for (const double speed : {0.05, 0.2, 0.5, 1.0}) {
    Crossed c;
    c.lead(1, Vec3(0, -Crossed::kTo, -5e-3), speed);
    EXPECT_GT(c.states[1].X_WT.p.z(), c.states[0].X_WT.p.z()) << speed;
    EXPECT_NEAR(c.apart(), 0.0, 3 * kApart) << speed;
  }
}

TEST(InstrumentContact, RubOnEachOther) {
  InstrumentParameters straight;  // a bar that tapers is a wedge besides
  straight.base_radius = straight.tip_radius;
  Crossed c(straight);
  c.lead(1, Vec3(0, -Crossed::kTo, 0), 0.02);
  for (int k = 0; k < 100; ++k) {
    c.commands[1].X_WD.p.x() += 0.005 * kStep;
    c.step();
  }
  const double along = -c.pull(0).x(), across = std::abs(c.pull(0).z());  // the first is dragged along
  EXPECT_NEAR(along / across, 0.2, 0.02);
}

TEST(InstrumentContact, StopAtAPostAndAtTheSheet) {
  Surroundings around;
  around.bars = {{Vec3(0, -5e-3, 0), Vec3(0, 5e-3, 0), 0.4e-3, 0.4e-3}};
  around.sheet = -3e-3;
  Bench post(1, around);
  post.place(0, {Vec3(-4e-3, 0, 4e-3), kAlongX});
  post.lead(0, Vec3(-4e-3, 0, -1e-3), 0.5);
  const double jaw = post.p[0].tip_radius + 4e-3 / post.p[0].jaw_length * (post.p[0].base_radius - post.p[0].tip_radius);
  EXPECT_NEAR(post.states[0].X_WT.p.z(), 0.4e-3 + jaw, 0.05e-3);  // the jaw's taper turns it a little
  Bench sheet(1, around);
  sheet.place(0, {Vec3(20e-3, 0, 2e-3), Quat::Identity()});
  sheet.lead(0, Vec3(20e-3, 0, -8e-3), 0.5);
  EXPECT_NEAR(sheet.states[0].X_WT.p.z(), -3e-3, kApart);
  EXPECT_NEAR(sheet.pull(0).z(), -500.0 * 5e-3, 0.01);
  sheet.lead(0, Vec3(20e-3, 0, 2e-3), 0.5);
  EXPECT_NEAR(sheet.states[0].X_WT.p.z(), 2e-3, 1e-6);
}

TEST(InstrumentContact, JawsThatLieAlongABarDoNotRockOnIt) {
  Surroundings around;
  around.bars = {{Vec3(-20e-3, 0, 0), Vec3(60e-3, 0, 0), 1e-3, 1e-3}};
  Bench b(1, around);
  b.place(0, {Vec3(0, 0, 4e-3), kAlongX});
  b.lead(0, Vec3::Zero(), 0.02);
  const Quat rest = b.states[0].X_WT.q;
  double most = 0.0;
  for (int k = 0; k < 200; ++k) {
    b.step();
    most = std::max(most, b.states[0].X_WT.q.angularDistance(rest));
  }
  EXPECT_LT(most, 1e-5);
}

TEST(InstrumentContact, FarApartNothingIsThere) {
  Bench with(2, {}), alone(1, {});
  Instruments free(alone.p);
  with.place(0, {Vec3(-4e-3, 0, 0), kAlongX});
  with.place(1, {Vec3(0, 30e-3, 30e-3), kAlongY});
  alone.place(0, {Vec3(-4e-3, 0, 0), kAlongX});
  for (int k = 0; k < 100; ++k) {
    with.commands[0].X_WD.p.z() += 0.1 * kStep;
    alone.commands[0].X_WD.p = with.commands[0].X_WD.p;
    with.step();
    free.step(alone.states, alone.commands, alone.force, alone.torque, kStep);
  }
  EXPECT_EQ(with.states[0].X_WT.p, alone.states[0].X_WT.p);
  EXPECT_EQ(with.states[0].v, alone.states[0].v);
}

TEST(InstrumentContact, ThreeThatAreThrownTogetherStayWhereHandsAreAndAllocateNothing) {
  Surroundings around;
  around.bars = {{Vec3(0, -5e-3, 0), Vec3(0, 5e-3, 0), 0.4e-3, 0.4e-3}};
  around.sheet = -3e-3;
  Bench b(3, around);
  for (std::size_t i = 0; i < 3; ++i) b.place(i, {Vec3(10e-3 * static_cast<double>(i) - 10e-3, 0, 5e-3), i == 1 ? kAlongY : Quat::Identity()});
  std::uint32_t seed = 7;
  const auto random = [&seed] { return static_cast<double>((seed = 1664525u * seed + 1013904223u) >> 8) / 8388608.0 - 1.0; };
  const long before = allocations;
  for (int k = 0; k < 20000; ++k) {
    if (k % 25 == 0) {
      for (InstrumentCommand& c : b.commands) {
        c.X_WD.p = Vec3(6e-3 * random(), 6e-3 * random(), 4e-3 * random());
        c.X_WD.q = Quat(Eigen::AngleAxisd(M_PI_2 * random(), Vec3(random(), random(), 0.1).normalized()));
        c.grip_angle = 0.4 * random();
      }
    }
    b.step();
    for (const InstrumentState& s : b.states) {
      ASSERT_TRUE(s.X_WT.finite()) << k;
      ASSERT_LT(s.X_WT.p.norm(), 0.1) << k;
      ASSERT_LT(s.v.norm(), 20.0) << k;
    }
  }
  EXPECT_EQ(allocations, before);
}

}  // namespace instrument_contact_test
}  // namespace filum
