#include "physics/wall_load.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"

namespace filum {
namespace wall_load_test {

constexpr double kMm = 1e-3;

/// Eight corners of a cube of 0.2 mm, moved a little this way and that.
Points corners(Rng& rng, double size) {
  Points x(3, 8);
  for (int a = 0; a < 8; ++a)
    x.col(a) = 0.1 * kMm * Vec3(a & 1 ? 1 : -1, a & 2 ? 1 : -1, a & 4 ? 1 : -1) + size * Vec3(rng.normal(), rng.normal(), rng.normal());
  return x;
}

WallPlace on_top() {
  WallPlace p;
  for (int a = 0; a < 8; ++a) p.node[static_cast<std::size_t>(a)] = a;
  p.weight << 0, 0, 0, 0, 0.1, 0.2, 0.3, 0.4;
  return p;
}

/// Its forces are minus the slope of its energy at x.
void expect_slope(WallLoad load, const Points& x) {
  load.answer(x);
  Points force = Points::Zero(3, x.cols());
  load.add_to(force);
  constexpr double kStep = 1e-9;
  for (int i = 0; i < x.cols(); ++i)
    for (int c = 0; c < 3; ++c) {
      Points up = x, down = x;
      up(c, i) += kStep;
      down(c, i) -= kStep;
      const double slope = (load.answer(up) - load.answer(down)) / (2.0 * kStep);
      EXPECT_NEAR(force(c, i), -slope, 2e-6 * (1e-3 + force.cwiseAbs().maxCoeff()) + 1e-9) << i << " " << c;
    }
}

TEST(WallLoad, ASpringsForceIsTheSlopeOfItsEnergy) {
  Rng rng(3);
  const Points start = corners(rng, 0.0), x = corners(rng, 5e-6);
  WallSlip slip;
  slip.along = Vec3(1, 2, 2) / 3.0;
  slip.stick = 300.0;
  for (const double most : {1e-5, 1.0}) {  // slips, sticks
    slip.high = most;
    slip.low = -most;
    WallLoad load = WallLoad::spring(on_top(), start, Vec3(1e-3, -2e-3, 5e-4), 50.0 * Mat3::Identity(), slip);
    expect_slope(load, x);
    load.answer(x);
    EXPECT_EQ(load.phase(), most < 1e-3 ? 1 : 2);
  }
}

WallStand standing(double depth) { return {Vec3(0.6, 0, 0.8), depth, 200.0, 0.2, Vec3(8e-6, 20e-6, -6e-6)}; }

TEST(WallLoad, AStopPushesAndRubsBySlopesOfItsEnergy) {
  Rng rng(4);
  const Points start = corners(rng, 0.0);
  for (int k = 0; k < 20; ++k) {
    const Points x = corners(rng, 3e-6);
    for (const double depth : {-8e-6, 4e-6, 40e-6}) expect_slope(WallLoad::stop(on_top(), start, standing(depth)), x);
  }
}

/// A ball above, beside and at a corner of a face that tilts and shifts under it.
TEST(WallLoad, ABallPushesWhereTheFaceIsNearestToIt) {
  Rng rng(5);
  const Points start = corners(rng, 0.0);
  const Triangle face{4, 5, 7};
  int touching = 0, inside = 0, side = 0, corner = 0;
  for (int k = 0; k < 300; ++k) {
    const Points x = corners(rng, 5e-6);
    const Vec3 centre(rng.uniform() * 0.3 * kMm - 0.15 * kMm, rng.uniform() * 0.3 * kMm - 0.15 * kMm, 0.17 * kMm);
    WallLoad load = WallLoad::ball(face, Vec3(0.3, 0.3, 0.4), start, {Vec3::UnitZ(), 5e-6, 200.0, 0.2, Vec3(1e-5, 0, 0)}, centre, 0.1 * kMm);
    expect_slope(load, x);
    load.answer(x);
    if (load.phase() != 2) continue;
    ++touching;
    const auto at_rest = (load.place().weight.head<3>().array() == 0.0).count();
    ++(at_rest == 0 ? inside : at_rest == 1 ? side : corner);
    EXPECT_NEAR(load.felt().trace(), 200.0 * (1.0 + 2.0 * 0.5), 1e-9);
  }
  EXPECT_GT(touching, 60);
  EXPECT_GT(std::min({inside, side, corner}), 5) << inside << " " << side << " " << corner;
}

/// Past the centre the face is pushed back to where it came from, ever harder.
TEST(WallLoad, AFaceThatHasGonePastTheCentreIsPushedBack) {
  Rng rng(6);
  const Points start = corners(rng, 0.0);
  WallLoad load = WallLoad::ball({4, 5, 7}, Vec3(0.3, 0.3, 0.4), start, {Vec3::UnitZ(), 0.0, 200.0, 0.0, Vec3::Zero()}, Vec3(0.02 * kMm, -0.01 * kMm, 0.15 * kMm), 0.05 * kMm);
  double before = 0.0;
  for (const double up : {10e-6, 40e-6, 50e-6, 60e-6, 90e-6}) {
    Points x = start;
    x.row(2).array() += up;
    load.answer(x);
    EXPECT_NEAR(load.force().z(), -200.0 * up, 1e-9);
    EXPECT_LT(load.force().z(), before);
    before = load.force().z();
  }
}

}  // namespace wall_load_test
}  // namespace filum
