#include "physics/rod_lengths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/allocation_count.h"

namespace filum {
namespace rod_lengths_test {

constexpr int kNodes = 41;
constexpr double kEdge = 2e-4;  // [m]

struct Chain {
  RodState s;
  Eigen::VectorXd inverse_mass = Eigen::VectorXd::Constant(kNodes, 1e10);
  Eigen::Matrix4Xd move = Eigen::Matrix4Xd::Zero(4, kNodes);

  Chain() {
    Points x = Points::Zero(3, kNodes);
    for (int i = 0; i < kNodes; ++i) x.col(i) = kEdge * Vec3(0, 0, -i);
    s = RodState::from_nodes(x, kNodes);
  }
  double length_after(int j) const { return (s.x.col(j + 1) - s.x.col(j) + (move.col(j + 1) - move.col(j)).head<3>()).norm(); }
  double largest_stretch() const {
    double most = 0.0;
    for (int j = 0; j + 1 < kNodes; ++j) most = std::max(most, std::abs(length_after(j) / kEdge - 1.0));
    return most;
  }
};

/// A hanging chain that is bent by straight moves, its edges turned by up to `angle`, held at its first node.
Chain swung(double angle) {
  Chain c;
  c.inverse_mass[0] = 0.0;
  for (int i = 1; i < kNodes; ++i) c.move(0, i) = c.move(0, i - 1) + angle * kEdge * std::sin(6.0 * i / kNodes);
  return c;
}

TEST(RodLengths, BendingAlongStraightLinesKeepsTheLengthToFourthOrder) {
  // Left to themselves edges grow by angle^2/2; what remains after one pass is of order angle^4.
  double last = 0.0;
  for (const double angle : {0.04, 0.02, 0.01}) {
    Chain c = swung(angle);
    EXPECT_NEAR(c.largest_stretch(), 0.5 * angle * angle, 0.01 * angle * angle);
    RodLengths lengths(kNodes);
    lengths.keep(c.s, c.s.x, c.inverse_mass, EdgeLength::unchanged, c.move);
    const double left = c.largest_stretch();
    EXPECT_LT(left, 0.1 * angle * angle);
    if (last > 0.0) {
      EXPECT_GT(last / left, 12.0);
    }
    last = left;
    EXPECT_EQ(c.move.col(0), Eigen::Vector4d::Zero()) << "the held node moved";
  }
}

TEST(RodLengths, LongMovesAreLeftAsTheyAre) {
  Chain c = swung(0.05);
  const Eigen::Matrix4Xd before = c.move;
  RodLengths(kNodes).keep(c.s, c.s.x, c.inverse_mass, EdgeLength::unchanged, c.move);
  EXPECT_EQ(c.move, before);
}

TEST(RodLengths, StretchThatIsMeantStays) {
  Chain c;
  for (int i = 0; i < kNodes; ++i) c.move(2, i) = -5e-4 * kEdge * i;
  const Eigen::Matrix4Xd meant = c.move;
  RodLengths lengths(kNodes);
  lengths.keep(c.s, c.s.x, c.inverse_mass, EdgeLength::first_order, c.move);
  EXPECT_LT((c.move - meant).cwiseAbs().maxCoeff(), 1e-12 * kEdge);
  lengths.keep(c.s, c.s.x, c.inverse_mass, EdgeLength::unchanged, c.move);
  EXPECT_LT(c.largest_stretch(), 1e-12);
}

TEST(RodLengths, FreeChainKeepsItsMomentum) {
  Chain c;
  std::mt19937 random(7);
  std::normal_distribution<double> spread(0.0, 0.008 * kEdge);
  for (int i = 0; i < kNodes; ++i) {
    for (int k = 0; k < 4; ++k) c.move(k, i) = spread(random);
    c.inverse_mass[i] = 1e10 * (1.0 + 0.5 * std::sin(i));
  }
  const Eigen::Matrix4Xd before = c.move;
  RodLengths lengths(kNodes);
  lengths.keep(c.s, c.s.x, c.inverse_mass, EdgeLength::first_order, c.move);
  EXPECT_GT((c.move - before).cwiseAbs().maxCoeff(), 1e-5 * kEdge);
  Vec3 momentum = Vec3::Zero();
  for (int i = 0; i < kNodes; ++i) momentum += (c.move.col(i) - before.col(i)).head<3>() / c.inverse_mass[i];
  EXPECT_LT(momentum.norm() * 1e10, 1e-10 * kEdge);
  EXPECT_EQ(c.move.row(3), before.row(3)) << "the twist is not a length";
}

TEST(RodLengths, NodesWithoutAMassAndPartedEdgesAreLeftAlone) {
  Chain c = swung(0.03);
  for (int i = 10; i <= 20; ++i) c.inverse_mass[i] = 0.0;
  c.s.alive[30] = 0;
  const Eigen::Matrix4Xd before = c.move;
  RodLengths lengths(kNodes);
  lengths.keep(c.s, c.s.x, c.inverse_mass, EdgeLength::unchanged, c.move);
  EXPECT_EQ(c.move.middleCols(10, 11), before.middleCols(10, 11));
  EXPECT_TRUE(c.move.allFinite());
  for (int j = 31; j + 1 < kNodes; ++j) EXPECT_NEAR(c.length_after(j) / kEdge, 1.0, 1e-5);
}

TEST(RodLengths, DoesNotAllocate) {
  Chain c = swung(0.03);
  RodLengths lengths(kNodes);
  const long before = allocations;
  lengths.keep(c.s, c.s.x, c.inverse_mass, EdgeLength::unchanged, c.move);
  EXPECT_EQ(allocations, before);
}

}  // namespace rod_lengths_test
}  // namespace filum
