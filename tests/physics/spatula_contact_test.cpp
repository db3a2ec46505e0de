#include "physics/spatula_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

namespace filum {
namespace spatula_contact_test {

/// Block of 60 x 60 x 30 mm held below, and a square blade that presses on it from above.
struct Press {
  FemOptions options = [] {
    FemOptions o;
    o.dt = 5e-3;
    o.mass_damping = 40.0;
    o.stiffness_damping = 5e-3;
    o.solver.relative = 1e-6;
    return o;
  }();
  LinearFem fem;
  RigidSurface surface;
  SpatulaContact contact;
  FemState state;
  Points seen;
  std::vector<BladeContact> contacts;
  std::vector<int> candidates;
  std::array<MovingBlade, 1> blades;
  FemSummary summary;

  explicit Press(double side = 20e-3, SpatulaParameters parameters = {})
      : fem(box_mesh(Vec3(-30e-3, -30e-3, -30e-3), Vec3(30e-3, 30e-3, 0), 12, 12, 5), {{}}, options), contact(parameters) {
    std::vector<int> held;
    for (int i = 0; i < fem.mesh().n_nodes(); ++i) {
      if (fem.mesh().nodes(2, i) < -29.9e-3) held.push_back(i);
      if (fem.mesh().nodes(2, i) > -1e-6) candidates.push_back(i);
    }
    fem.hold(held);
    BladeShape shape;
    shape.width = shape.tip_width = shape.length = side;
    shape.taper = 0.0;
    surface = blade_surface(shape, 4, 4);
    state = fem.rest();
    seen = state.u;
    contacts.reserve(candidates.size());
    blades[0].surface = &surface;
    blades[0].X_now = at(Vec3(0, 0, 1e-3));
  }
  /// Flat of the blade level, its middle at p.
  Pose at(const Vec3& p) const {
    Pose X;
    X.q = Quat(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitX()));  // y up, z towards -y
    X.p = p - X.q * Vec3(0, 0, 0.5 * surface.high.z());
    return X;
  }
  void step(const Vec3& middle) {
    blades[0].X_before = blades[0].X_now;
    blades[0].X_now = at(middle);
    contact.update(fem, state.u, seen, blades, candidates, contacts);
    seen = state.u;
    summary = fem.step(state, contact.moved());
    contact.read(fem, state.u, blades, contacts);
  }
  void go(const Vec3& from, const Vec3& to, int steps) {
    for (int k = 1; k <= steps; ++k) step(from + (to - from) * (double(k) / steps));
  }
};

TEST(SpatulaContact, PressingGivesAnUpwardForceAndReleasingNone) {
  Press p;
  p.go(Vec3(0, 0, 1e-3), Vec3(0, 0, -3e-3), 100);
  EXPECT_GT(p.blades[0].force.z(), 0.05);
  EXPECT_LT(p.blades[0].force.head<2>().norm(), 0.05 * p.blades[0].force.z());
  for (const BladeContact& c : p.contacts) EXPECT_GE(c.normal_force, 0.0);
  p.go(Vec3(0, 0, -3e-3), Vec3(0, 0, 2e-3), 100);
  EXPECT_TRUE(p.contacts.empty());
  EXPECT_EQ(p.blades[0].force.norm(), 0.0);
  p.go(Vec3(0, 0, 2e-3), Vec3(0, 0, 2e-3), 200);
  EXPECT_LT(p.state.u.cwiseAbs().maxCoeff(), 2e-4);  // back at rest
}

TEST(SpatulaContact, NodesUnderTheBladeLieOnIt) {
  Press p(22e-3);
  p.go(Vec3(0, 0, 1e-3), Vec3(0, 0, -3e-3), 100);
  p.go(Vec3(0, 0, -3e-3), Vec3(0, 0, -3e-3), 50);
  int under = 0;
  for (const BladeContact& c : p.contacts) {
    if (c.share < 1.0) continue;
    ++under;
    EXPECT_NEAR(p.state.u(2, c.node), -3e-3, 5e-5);
  }
  EXPECT_EQ(under, 25);  // nodes 5 mm apart under 22 x 22 mm
}

TEST(SpatulaContact, ABladeThatJumpsThroughTheSurfaceInOneStepStillTakesItAlong) {
  Press p;
  p.step(Vec3(0, 0, 1e-3));
  p.step(Vec3(0, 0, -4e-3));  // 1 m/s
  EXPECT_GE(p.contacts.size(), 25u);
  EXPECT_TRUE(p.summary.sound);
}

TEST(SpatulaContact, ANodeSlidingOffTheBladeLeavesWithoutAJump) {
  SpatulaParameters smooth, abrupt;
  smooth.reach = 6e-3;
  smooth.friction = abrupt.friction = 0.0;
  abrupt.partial = false;
  const auto largest_jump = [](const SpatulaParameters& parameters) {
    Press p(20e-3, parameters);
    p.go(Vec3(0, 0, 1e-3), Vec3(0, 0, -2e-3), 60);
    p.go(Vec3(0, 0, -2e-3), Vec3(0, 0, -2e-3), 60);
    double before = p.blades[0].force.z(), jump = 0.0;
    for (int k = 1; k <= 400; ++k) {
      p.step(Vec3(k * 12.5e-6, 0, -2e-3));
      jump = std::max(jump, std::abs(p.blades[0].force.z() - before));
      before = p.blades[0].force.z();
    }
    return jump;
  };
  EXPECT_LT(largest_jump(smooth), 0.25 * largest_jump(abrupt));
}

TEST(SpatulaContact, ABladeThatIsLiftedTakesNoTissueUpBesideItsBorder) {
  SpatulaParameters wide;
  wide.reach = 6e-3;
  Press p(20e-3, wide);
  p.contact.set_surface(p.fem.mesh(), surface_triangles(p.fem.mesh()));
  p.go(Vec3(0, 0, 1e-3), Vec3(0, 0, -4e-3), 50);
  p.go(Vec3(0, 0, -4e-3), Vec3(0, 0, 8e-3), 60);
  EXPECT_TRUE(p.contacts.empty());
  EXPECT_EQ(p.blades[0].force.norm(), 0.0);
}

TEST(SpatulaContact, FrictionFollowsCoulomb) {
  for (const double mu : {0.0, 0.2}) {
    SpatulaParameters parameters;
    parameters.friction = mu;
    Press p(20e-3, parameters);
    p.go(Vec3(0, 0, 1e-3), Vec3(0, 0, -2e-3), 60);
    p.go(Vec3(0, 0, -2e-3), Vec3(8e-3, 0, -2e-3), 300);
    double normal = 0.0;
    for (const BladeContact& c : p.contacts) {
      normal += c.normal_force;
      EXPECT_LE(c.friction.norm(), 1.25 * mu * c.normal_force + 1e-5);
    }
    EXPECT_NEAR(-p.blades[0].force.x(), mu * normal, 0.15 * mu * normal + 2e-3);
  }
}

TEST(SpatulaContact, ForceAndTorqueAreThoseOfTheNodes) {
  Press p;
  p.go(Vec3(0, 0, 1e-3), Vec3(5e-3, 0, -3e-3), 100);
  Vec3 sum = Vec3::Zero();
  for (const MovedNode& m : p.contact.moved()) sum -= m.force;
  EXPECT_LT((sum - p.blades[0].force).norm(), 0.05 * sum.norm());
  EXPECT_GT(p.blades[0].torque.norm(), 1e-4);
}

TEST(SpatulaContact, PivotForceHasTheSameMomentAndPush) {
  const Vec3 tip(0, 0, 0), pivot(0.02, 0, 0.1), force(0.3, -0.2, 0.5), torque(0.01, 0.02, -0.004);
  const PivotForce f = pivot_force(tip, pivot, force, torque);
  const Vec3 along = (tip - pivot).normalized(), moment = torque + (tip - pivot).cross(force);
  EXPECT_LT(f.push.cross(along).norm(), 1e-12);
  EXPECT_NEAR(f.push.dot(along), force.dot(along), 1e-12);
  EXPECT_NEAR(f.turn.dot(along), 0.0, 1e-12);
  EXPECT_LT(((tip - pivot).cross(f.turn) - (moment - along * along.dot(moment))).norm(), 1e-12);
}

TEST(SpatulaContact, ABladeAtTenMetresASecondOrAMetreDeepNeverGivesNaN) {
  Press p;
  for (int k = 0; k < 40; ++k) p.step(Vec3(0, 0, 0.05 - 0.05 * k));  // 10 m/s, 2 m deep in the end
  EXPECT_TRUE(p.state.u.allFinite());
  EXPECT_TRUE(p.blades[0].force.allFinite());
  p.go(Vec3(0, 0, -1.95), Vec3(0, 0, 0.1), 50);
  EXPECT_TRUE(p.state.u.allFinite());
}

}  // namespace spatula_contact_test
}  // namespace filum
