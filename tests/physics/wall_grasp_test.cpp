#include "physics/wall_grasp.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/allocation_count.h"

namespace filum {
namespace wall_grasp_test {

constexpr double kYoung = 300e3, kThick = 0.15e-3, kWidth = 0.3e-3, kLong = 2e-3;  // [Pa], [m]

WallOptions patient() {
  WallOptions o;
  o.tolerance = 1e-7;
  o.max_iterations = 80;
  o.damping = 400.0;
  return o;
}

/// A strip in the plane z = 0, held at y = -2 mm, its free end at y = 0.
VesselMesh strip() {
  CardShape shape;
  shape.width = kWidth;
  shape.depth = kLong;
  shape.thickness = kThick;
  shape.across = 2;
  shape.deep = 16;
  VesselMesh mesh = make_card(shape);
  std::erase_if(mesh.held, [&](int i) { return mesh.nodes(1, i) > -kLong + 1e-6; });
  return mesh;
}

/// Forceps that come along y, jaws above and below, tips 0.5 mm beyond the strip's end.
struct Hand {
  VesselWall wall = VesselWall(strip(), {{"card", kThick, WallLaw::hooke(kYoung, 0.3)}}, patient());
  WallState w = wall.first_state();
  InstrumentParameters parameters;
  InstrumentState state;
  WallGrip grip;
  Vec3 force, torque;

  Hand() {
    wall.refit(w);
    Mat3 axes;
    axes << Vec3::UnitZ(), Vec3::UnitX(), Vec3::UnitY();
    state.X_WT = {Vec3(0, -0.5e-3, 0), Quat(axes)};
    state.angle = 0.06;
    state.grip_force = 0.05;
  }
  GrippingTool tool() const { return {parameters, state}; }
  /// Closes until something is held.
  bool close() {
    for (; state.angle > 0.0; state.angle -= 1e-3)
      if (take_wall(wall, w, tool(), {kThick, false}, grip)) return true;
    return false;
  }
  void step() {
    wall.clear_loads();
    pull_wall(wall, w, tool(), grip);
    wall.step(w);
    wall.refit(w);
    force.setZero();
    torque.setZero();
    feel_wall(wall, w, tool(), grip, force, torque);
  }
};

TEST(WallGrasp, JawsThatTouchBothSidesHoldTheWallThroughItsThickness) {
  Hand h;
  const double touch = 2.0 * std::asin(0.5 * kThick / (h.parameters.jaw_length - 0.05e-3));
  ASSERT_TRUE(h.close());
  EXPECT_NEAR(h.state.angle, touch, 2e-3) << "where the tips touch it";
  EXPECT_EQ(h.grip.through, 1);
  EXPECT_NEAR(h.grip.stop, 0.8 * touch, 1e-3);
  EXPECT_GT(h.grip.leave, h.state.angle);
  h.state.angle = h.grip.stop;
  for (int k = 0; k < 100; ++k) h.step();
  EXPECT_LT(h.force.norm(), 1e-5) << "symmetric: the squeeze of one pad is that of the other";
}

TEST(WallGrasp, OpenJawsAndJawsBesideItHoldNothing) {
  Hand h;
  EXPECT_FALSE(take_wall(h.wall, h.w, h.tool(), {kThick, false}, h.grip)) << "still apart";
  h.state.X_WT.p.y() = 0.2e-3;
  EXPECT_FALSE(h.close()) << "beyond its end";
}

TEST(WallGrasp, JawsMoreThan45DegreesObliqueSlipOff) {
  for (const double degrees : {0.0, 20.0, 40.0, 50.0, 60.0}) {
    Hand h;
    h.state.X_WT.q = Quat(Eigen::AngleAxisd(degrees * M_PI / 180.0, Vec3::UnitX())) * h.state.X_WT.q;
    EXPECT_EQ(h.close(), degrees < 45.0) << degrees;
  }
}

/// A strip drawn along itself: F = u / (L/(E A) + 1/(2 n k)), L from the clamp to the places that hold it; what lies between these bounds it.
TEST(WallGrasp, DrawnStripPullsAsARodOfItsStiffness) {
  Hand h;
  ASSERT_TRUE(h.close());
  ASSERT_GE(h.grip.n, 2);
  const double first = h.grip.places[0].z, last = h.grip.places[static_cast<std::size_t>(h.grip.n - 1)].z, u = 50e-6;
  for (int k = 0; k < 400; ++k) {
    h.state.X_WT.p.y() = -0.5e-3 + u * std::min(1.0, k / 100.0);
    h.step();
  }
  const double springs = 1.0 / (2.0 * h.grip.n * 500.0), per_length = 1.0 / (kYoung * kWidth * kThick), free = kLong - 0.5e-3;
  const double stiffest = u / ((free + first) * per_length + springs), softest = u / ((free + last) * per_length + springs);
  EXPECT_LT(-h.force.y(), 1.03 * stiffest) << "its ends cannot narrow: a little stiffer";
  EXPECT_GT(-h.force.y(), softest);
  EXPECT_NEAR(h.grip.pull, h.force.norm(), 1e-12);
  EXPECT_LT(std::abs(h.force.x()) + std::abs(h.force.z()), 0.02 * stiffest);
}

/// Coulomb: two pads of mu N each, then it slides out from between them.
TEST(WallGrasp, SlipsAtTwiceTheFrictionOfAPad) {
  Hand h;
  h.state.grip_force = 2e-3;
  ASSERT_TRUE(h.close());
  double most = 0.0;
  int k = 0;
  for (; k < 3000 && h.grip.n > 0; ++k) {
    h.state.X_WT.p.y() += 0.5e-6;
    h.step();
    most = std::max(most, -h.force.y());
  }
  EXPECT_NEAR(most, 2.0 * 0.3 * 2e-3, 0.03 * 1.2e-3);
  EXPECT_EQ(h.grip.n, 0) << "out after 1.5 mm";
  for (int j = 0; j < 1500; ++j) h.step();
  EXPECT_LT((h.w.x - strip().nodes).cwiseAbs().maxCoeff(), 2e-6) << "back where it was";
}

TEST(WallGrasp, NoGripBearsMoreThanTheTissue) {
  WallGrip grip;
  EXPECT_DOUBLE_EQ(grip_limit(grip, 3.0), 25e-3);
  grip.through = 1;
  EXPECT_DOUBLE_EQ(grip_limit(grip, 3.0), 60e-3);
  EXPECT_DOUBLE_EQ(grip_limit(grip, 0.01), 3e-3);
}

/// Turned about the edge's direction, forceps evert it: the free end goes up, and the strip's moment is felt.
TEST(WallGrasp, TurnedForcepsEvertTheEdge) {
  Hand h;
  ASSERT_TRUE(h.close());
  const Quat from = h.state.X_WT.q;
  for (int k = 0; k < 600; ++k) {
    h.state.X_WT.q = Quat(Eigen::AngleAxisd(0.6 * std::min(1.0, k / 300.0), Vec3::UnitX())) * from;
    h.step();
  }
  ASSERT_GT(h.grip.n, 0);
  EXPECT_GT(h.w.x.row(2).maxCoeff(), 0.2e-3) << "0.5 mm of it turned by 34 degrees";
  EXPECT_LT(h.torque.x(), -1e-9) << "against the turn";
}

/// Tips that touch the outside of a tube take a fold of adventitia where they come within 0.15 mm of each other; of a smooth tube nothing.
TEST(WallGrasp, TipsThatTouchTheOutsideTakeAFoldOfAdventitia) {
  const double thick = 1e-4;
  VesselWall wall(make_tube({}), {{"wall", thick, WallLaw::hooke(kYoung, 0.45)}}, patient());
  WallState w = wall.first_state();
  wall.refit(w);
  const double radius = w.x.topRows<2>().colwise().norm().maxCoeff();
  InstrumentParameters parameters;
  InstrumentState state;
  Mat3 axes;
  axes << Vec3::UnitX(), -Vec3::UnitZ(), Vec3::UnitY();
  state.X_WT.q = Quat(axes);
  const auto held_at = [&](double height, bool adventitia) {  // [m], opening; 0: nothing held
    state.X_WT.p = Vec3(0, radius + parameters.tip_radius + height, 1.5e-3);
    WallGrip grip;
    for (state.angle = 0.06; state.angle > 0.0; state.angle -= 1e-3)
      if (take_wall(wall, w, {parameters, state}, {thick, adventitia}, grip)) {
        EXPECT_EQ(grip.through, 0);
        EXPECT_EQ(grip.n, 1);
        return parameters.jaw_length * state.angle;
      }
    return 0.0;
  };
  EXPECT_NEAR(held_at(-60e-6, true), 0.15e-3, 10e-6);
  EXPECT_EQ(held_at(-60e-6, false), 0.0) << "smooth";
  EXPECT_EQ(held_at(10e-6, true), 0.0) << "above it";
}

TEST(WallGrasp, AllocatesNothing) {
  Hand h;
  ASSERT_TRUE(h.close());
  h.step();
#if FILUM_COUNTS_ALLOCATIONS
  const long before = allocations;
#endif
  WallGrip other;
  take_wall(h.wall, h.w, h.tool(), {kThick, false}, other);
  pull_wall(h.wall, h.w, h.tool(), h.grip);
  feel_wall(h.wall, h.w, h.tool(), h.grip, h.force, h.torque);
#if FILUM_COUNTS_ALLOCATIONS
  EXPECT_EQ(allocations, before);
#endif
}

}  // namespace wall_grasp_test
}  // namespace filum
