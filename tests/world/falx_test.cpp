#include "world/falx.h"

#include <gtest/gtest.h>

#include <numbers>

#include "world/model.h"
#include "world/world.h"

namespace filum {
namespace falx_test {

RigidSurface flat_blade() {
  BladeShape shape;
  return blade_surface(shape, 16, 4);
}

/// The blade hangs tip down, its flat side towards the sheet.
Pose hanging(double y, double z) { return {Vec3(0, y, z), Quat::Identity()}; }

TEST(Falx, ABladeStopsAtTheSheetOnTheSideWhereItWas) {
  const FalxSheet sheet{0.0, -25e-3, 4e-3};
  const RigidSurface blade = flat_blade();
  for (const double side : {1.0, -1.0}) {
    EXPECT_NEAR(beside_falx(sheet, blade, hanging(side * 1e-3, -0.01), hanging(-side * 2e-3, -0.01)).p.y(), side * kFalxClearance, 1e-12);
    EXPECT_EQ(beside_falx(sheet, blade, hanging(side * 2e-3, -0.01), hanging(side * 1e-3, -0.01)).p.y(), side * 1e-3) << "untouched";
    EXPECT_EQ(beside_falx(sheet, blade, hanging(side * 1e-3, 0.01), hanging(-side * 1e-3, 0.01)).p.y(), -side * 1e-3) << "above the sheet";
  }
  // turned about its handle: the border that would reach through is taken back
  Pose turned = hanging(1e-3, -0.01);
  turned.q = Quat(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitZ()));
  const Pose back = beside_falx(sheet, blade, hanging(1e-3, -0.01), turned);
  double least = 1.0;
  for (int k = 0; k < blade.vertices.cols(); ++k)
    if (const Vec3 x = back * Vec3(blade.vertices.col(k)); x.z() < sheet.top) least = std::min(least, x.y());
  EXPECT_NEAR(least, kFalxClearance, 1e-12);
  EXPECT_EQ(beside_falx(FalxSheet{}, blade, hanging(1e-3, -0.01), hanging(-1e-3, -0.01)).p.y(), -1e-3) << "no sheet";
}

struct Pressed {
  LinearFem fem;
  FalxContact falx;
  FemState state;
  std::vector<MovedNode> moved;
  Points loads;

  explicit Pressed(const FalxSheet& sheet) : Pressed(sheet, box_mesh(Vec3(-0.02, -0.03, -0.02), Vec3(0.02, -1e-3, 0.0), 4, 4, 3)) {}
  Pressed(const FalxSheet& sheet, const TetMesh& mesh) : fem(mesh, {FemMaterial{}}, options()), loads(Points::Zero(3, mesh.n_nodes())) {
    std::vector<int> far, near;
    for (int i = 0; i < mesh.n_nodes(); ++i) {
      if (mesh.nodes(1, i) < -0.03 + 1e-9) far.push_back(i);
      if (mesh.nodes(1, i) > -1e-3 - 1e-9) near.push_back(i);
    }
    fem.hold(far);
    falx = FalxContact(sheet, mesh, near, far);
    state = fem.rest();
    moved.reserve(near.size());
  }
  static FemOptions options() {
    FemOptions o;
    o.dt = 5e-3;
    o.mass_damping = 20.0;
    o.stiffness_damping = 10e-3;
    o.solver.relative = 1e-6;
    return o;
  }
  /// Pushes the near face towards the sheet [N, on each node] and returns how far it gets [m].
  double push(double force, int steps) {
    loads.setZero();
    for (int i = 0; i < loads.cols(); ++i)
      if (fem.mesh().nodes(1, i) > -1e-3 - 1e-9) loads(1, i) = force;
    for (int k = 0; k < steps; ++k) {
      moved.clear();
      falx.append(fem, state.u, moved);
      fem.step(state, moved, &loads);
    }
    return (fem.mesh().nodes.row(1) + state.u.row(1)).maxCoeff();
  }
};

TEST(Falx, TissueComesToItAndNoFurtherAndLeavesItFreely) {
  Pressed with(FalxSheet{0.0, -0.03, 0.01}), without(FalxSheet{});
  ASSERT_GT(with.falx.size(), 10u);
  const double free = without.push(12e-3, 400);
  ASSERT_GT(free, 2e-3) << "pushed hard enough to go through";
  EXPECT_LT(with.push(12e-3, 400), free / 20.0);
  EXPECT_FALSE(with.moved.empty());
  // let go, and drawn away: as if the sheet were not there
  with.push(-12e-3, 600);
  without.push(-12e-3, 600);
  EXPECT_TRUE(with.moved.empty());
  EXPECT_LT((with.state.u - without.state.u).norm(), 1e-3 * without.state.u.norm());
}

/// The scene between the hemispheres: a hand that pushes a blade across moves it to the sheet only, and feels it.
TEST(Falx, TheHandFeelsItInTheScene) {
  World world(load_model(FILUM_SOURCE_DIR, "deep-exposure"));
  Inputs in;
  in.tools[0].X_WD = world.model().brain->blade_start[0];
  in.tools[0].valid = true;
  const Vec3 start = in.tools[0].X_WD.p;
  const auto go = [&](const Vec3& to, int steps) {
    const Vec3 from = in.tools[0].X_WD.p;
    for (int k = 1; k <= steps; ++k) {
      in.tools[0].X_WD.p = from + (double(k) / steps) * (to - from);
      world.step(in);
    }
  };
  go(Vec3(0, start.y(), -15e-3), 300);
  EXPECT_EQ(world.observation().tools[0].f_T_W.dot(Vec3::UnitY()), world.observation().brain.blades[0].force_W.y());
  go(Vec3(0, 3e-3, -15e-3), 100);
  EXPECT_NEAR(world.observation().tools[0].X_WT.p.y(), -kFalxClearance, 1e-9);
  EXPECT_NEAR(world.observation().tools[0].f_T_W.y() - world.observation().brain.blades[0].force_W.y(), -kFalxHold * (3e-3 + kFalxClearance), 1e-6);
}

}  // namespace falx_test
}  // namespace filum
