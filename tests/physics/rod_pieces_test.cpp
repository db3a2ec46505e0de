#include "physics/rod_pieces.h"

#include <gtest/gtest.h>

#include <cmath>

namespace filum {
namespace rod_pieces_test {

constexpr int kCapacity = 60;

/// An arc of 1 mm edges bent to 20 mm radius, from `start`.
RodState bent(int n, const Vec3& start) {
  Points x(3, n);
  for (int i = 0; i < n; ++i) x.col(i) = start + 20e-3 * Vec3(std::sin(0.05 * i), 1.0 - std::cos(0.05 * i), 0.0);
  return RodState::from_nodes(x, kCapacity);
}

/// Thirty nodes, cut behind nodes 7 and 19: pieces of 8, 12 and 10.
RodState three_pieces() {
  RodState s = bent(30, Vec3::Zero());
  for (int j = 0; j < 29; ++j) s.theta[j] = 0.01 * j * j;
  for (int i = 0; i < 30; ++i) s.v.col(i) = Vec3(0, 0, 1e-3 * i);
  s.alive[7] = s.alive[19] = 0;
  return s;
}

double energy(const RodState& s) {
  RodGeometry g(kCapacity);
  update_geometry(s, s.x, s.theta, g);
  return elastic_energy(RodMaterial(), s, g);
}

/// Elastic energy of a piece, as of a rod by itself.
double energy_of(const RodState& s, const RodPiece& p) {
  RodState part = s;
  RodMemory none;
  if (p.last + 1 < part.n) take_out({p.last + 1, part.n - 1}, part, none);
  if (p.first > 0) take_out({0, p.first - 1}, part, none);
  return energy(part);
}

RodMemory touching() {
  RodMemory m;
  const auto pair = [](int i, int j) { ContactBristle b; b.i = i; b.j = j; return b; };
  m.self = {pair(1, 10), pair(9, 16), pair(9, 25), pair(22, 27)};
  m.obstacle = {pair(2, 5), pair(12, 5), pair(24, 5)};
  return m;
}

TEST(RodPieces, ArePartedByCutEdges) {
  const RodState s = three_pieces();
  const RodPiece middle = piece_from(s, 8), last = piece_to(s, 29);
  EXPECT_EQ(piece_from(s, 0).last, 7);
  EXPECT_EQ(middle.last, 19);
  EXPECT_EQ(last.first, 20);
  EXPECT_EQ(piece_to(s, 19).first, 8);
}

TEST(RodPieces, OneOutOfTheMiddleLeavesTheOthersAsTheyWere) {
  const RodState before = three_pieces();
  RodState s = before;
  RodMemory m = touching();
  const ArcChange c = take_out({8, 19}, s, m);
  ASSERT_EQ(s.n, 18);
  EXPECT_EQ(s.x.leftCols(8), before.x.leftCols(8));
  EXPECT_EQ(s.x.middleCols(8, 10), before.x.middleCols(20, 10));
  EXPECT_EQ(s.v.middleCols(8, 10), before.v.middleCols(20, 10));
  EXPECT_EQ(s.theta.segment(8, 9), before.theta.segment(20, 9));
  EXPECT_EQ(s.alive[7], 0);
  EXPECT_EQ(s.alive.head(7).minCoeff(), 1);
  EXPECT_EQ(s.alive.segment(8, 9).minCoeff(), 1);
  EXPECT_NEAR(c.by, arc_of_node(before, 20) - arc_of_node(before, 8), 1e-15);
  EXPECT_NEAR(c.after(arc_of_node(before, 23)), arc_of_node(s, 11), 1e-15) << "places are named as before";
  EXPECT_EQ(c.after(arc_of_node(before, 5)), arc_of_node(s, 5));
  EXPECT_TRUE(c.gone(arc_of_node(before, 12)));
  ASSERT_EQ(m.self.size(), 1u) << "contacts with the piece are forgotten";
  EXPECT_EQ(m.self[0].i, 10);
  EXPECT_EQ(m.self[0].j, 15);
  ASSERT_EQ(m.obstacle.size(), 2u);
  EXPECT_EQ(m.obstacle[1].i, 12);
  EXPECT_EQ(m.obstacle[1].j, 5) << "of an obstacle's number nothing changes";
}

TEST(RodPieces, TheFirstOneGoesAndArcsStay) {
  const RodState before = three_pieces();
  RodState s = before;
  RodMemory m = touching();
  const ArcChange c = take_out({0, 7}, s, m);
  ASSERT_EQ(s.n, 22);
  EXPECT_EQ(c.by, 0.0);
  EXPECT_NEAR(arc_of_node(s, 0), arc_of_node(before, 8), 1e-15);
  EXPECT_NEAR(arc_of_node(s, 21), arc_of_node(before, 29), 1e-15);
  EXPECT_EQ(arc_of_end(s), arc_of_node(s, 21)) << "what went at the front counts";
  EXPECT_EQ(arc_of_end(RodState{}), 0.0) << "no thread";
  EXPECT_EQ(s.alive[11], 0);
}

TEST(RodPieces, EnergyIsThatOfThePiecesAndTheJoinBearsNothing) {
  RodState s = three_pieces();
  const double first = energy_of(s, {0, 7}), middle = energy_of(s, {8, 19});
  ASSERT_GT(middle, 0.0);
  RodMemory none;
  take_out({20, 29}, s, none);
  const RodState fresh = bent(14, Vec3(5e-3, -9e-3, 7e-3));
  join_on(fresh, s);
  ASSERT_EQ(s.n, 34);
  EXPECT_EQ(s.alive[19], 0);
  EXPECT_EQ(s.x.middleCols(20, 14), fresh.x.leftCols(14));
  EXPECT_NEAR(energy(s), first + middle + energy(fresh), 1e-12 * energy(s));
  take_out({8, 19}, s, none);
  EXPECT_NEAR(energy(s), first + energy(fresh), 1e-12 * energy(s));
  for (int j = 0; j + 1 < s.n; ++j) {
    const Vec3 t = (s.x.col(j + 1) - s.x.col(j)).normalized();
    EXPECT_NEAR(s.d1.col(j).dot(t), 0.0, 1e-12) << "director of edge " << j;
    EXPECT_NEAR(s.d1.col(j).norm(), 1.0, 1e-12);
  }
}

TEST(RodPieces, AStepMovesPiecesAsIfEachWereAlone) {
  RodMaterial m;
  RodStepOptions o;
  o.dt = 2e-3;
  RodState s = three_pieces();
  s.v.setZero();
  RodMemory none;
  take_out({8, 19}, s, none);
  s.rest_length[7] = 1e-9;  // else half of the parted edge's weight and drag hangs on the node behind it
  RodState alone = three_pieces();
  alone.v.setZero();
  take_out({0, 7}, alone, none);
  take_out({0, 11}, alone, none);
  ImplicitRod both(m, {}, kCapacity), one(m, {}, kCapacity);
  RodMemory memory = both.make_memory(), other = one.make_memory();
  for (int k = 0; k < 20; ++k) {
    EXPECT_TRUE(both.step(s, memory, o).sound);
    one.step(alone, other, o);
  }
  for (int i = 0; i < 10; ++i) EXPECT_LT((s.x.col(8 + i) - alone.x.col(i)).norm(), 1e-8) << "node " << i;
  EXPECT_GT((s.x.col(17) - three_pieces().x.col(29)).norm(), 0.2e-3) << "it did move";
}

TEST(RodPieces, AnEmptyRodTakesAPieceAsItIs) {
  RodState s = three_pieces();
  RodMemory none;
  take_out({20, 29}, s, none);
  take_out({8, 19}, s, none);
  take_out({0, 7}, s, none);
  ASSERT_EQ(s.n, 0);
  const RodState fresh = bent(9, Vec3::Zero());
  join_on(fresh, s);
  EXPECT_EQ(s.n, 9);
  EXPECT_EQ(s.arc_start, 0.0);
  EXPECT_EQ(s.x.leftCols(9), fresh.x.leftCols(9));
}

}  // namespace rod_pieces_test
}  // namespace filum
