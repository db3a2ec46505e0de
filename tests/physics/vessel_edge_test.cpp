#include "physics/vessel_edge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "physics/vessel_clamp.h"
#include "physics/vessel_leak.h"

using namespace filum;

namespace vessel_edge_test {

constexpr double kPi = std::numbers::pi, kInner = 0.35e-3, kWall = 0.1e-3, kLength = 3e-3;
constexpr int kAround = 48;
const double kSide = std::cos(kPi / kAround);  // from a corner's line to a side of the polygon

VesselMesh tube() {
  TubeShape shape;
  shape.around = kAround;
  shape.along = 30;  // rings a wall's thickness apart
  return make_tube(shape);
}

/// The last `length` of the wall, at the places that `turns` says, given new radius and height: `where` takes how far behind the hinge and how far from the inner surface.
template <class Where, class Turns>
Points bent(const VesselMesh& mesh, double length, Where where, Turns turns) {
  Points x = mesh.nodes;
  for (int i = 0; i < x.cols(); ++i) {
    const double past = x(2, i) - (kLength - length), r = x.col(i).head<2>().norm();
    if (past <= 0.0 || !turns(std::atan2(x(1, i), x(0, i)))) continue;
    const std::array<double, 2> to = where(past, r - kInner);
    x.col(i).head<2>() *= to[0] / r;
    x(2, i) = kLength - length + to[1];
  }
  return x;
}
bool all_round(double) { return true; }

/// About the outer corner, so that the outer surface faces the cut; the inner one is crumpled in the corner.
std::array<double, 2> square(double past, double height) {
  const double r = kInner + kWall - past;
  return {height < 0.5 * kWall ? std::min(kInner, r) : r, height - kWall};
}

TEST(VesselEdge, PlainAndEvertedEdgesAreNotRolledIn) {
  const VesselMesh mesh = tube();
  EXPECT_EQ(edge_roll(mesh, mesh.nodes, 0), 0.0);
  const auto outward = [](double past, double height) { return std::array<double, 2>{kInner + past, kWall - height}; };
  EXPECT_EQ(edge_roll(mesh, bent(mesh, 2.5 * kWall, outward, all_round), 0), 0.0);
}

TEST(VesselEdge, BentInSquarelyItIsTheLengthLessOneWall) {
  const VesselMesh mesh = tube();
  for (const double walls : {1.5, 2.5, 3.5}) EXPECT_NEAR(edge_roll(mesh, bent(mesh, walls * kWall, square, all_round), 0), (walls - 1.0) * kWall * kSide, 1e-9);
}

TEST(VesselEdge, FoldedBackOntoTheIntimaItIsOneWall) {
  const VesselMesh mesh = tube();
  const auto back = [](double past, double height) { return std::array<double, 2>{kInner - height, -past}; };
  EXPECT_NEAR(edge_roll(mesh, bent(mesh, 2.5 * kWall, back, all_round), 0), kWall * kSide, 1e-9);
}

/// Eleven of 48 places: the rim's middle moves away from them by the mean of what they moved, which the outermost of them feel least.
TEST(VesselEdge, OnePartOfTheEdgeIsFound) {
  const VesselMesh mesh = tube();
  const double step = 2.0 * kPi / kAround, in = 2.5 * kWall, r = kInner + kWall - in;
  const Points x = bent(mesh, in, square, [&](double angle) { return std::abs(angle) < 5.5 * step; });
  double shift = 0.0;
  for (int k = -5; k <= 5; ++k) shift += in * std::cos(k * step) / kAround;
  const double depth = kInner - std::hypot(r * std::cos(5.0 * step) + shift, r * std::sin(5.0 * step));
  EXPECT_NEAR(edge_roll(mesh, x, 0), depth, kInner * (1.0 - kSide));
  EXPECT_GT(depth, kWall);
}

TEST(VesselEdge, SectionsDrawnInFlatOrAslantCountNothing) {
  const VesselMesh mesh = tube();
  Points x = mesh.nodes;
  x.row(1) *= 0.3;
  EXPECT_EQ(edge_roll(mesh, x, 0), 0.0) << "flat all along";
  x = mesh.nodes;
  for (int i = 0; i < x.cols(); ++i) x.col(i).head<2>() *= 1.0 - 0.2 * std::max(0.0, x(2, i) / kLength - 0.5);
  EXPECT_EQ(edge_roll(mesh, x, 0), 0.0) << "drawn in by a tenth at the edge";
  x = mesh.nodes;
  for (int i = 0; i < x.cols(); ++i) x(0, i) += 0.5 * std::max(0.0, x(2, i) - 2e-3);
  EXPECT_EQ(edge_roll(mesh, x, 0), 0.0) << "drawn aside by half a millimetre";
}

TEST(VesselEdge, OpeningsInTheSide) {
  TubeShape vessel, stump;
  vessel.around = 20;
  vessel.along = 24;
  DoubleClamp clamp;
  clamp.side = SideHold{0.25 * kPi, 2.2e-3, 0.45e-3};
  const VesselMesh mesh = make_end_to_side(vessel, {}, stump, clamp);
  EXPECT_EQ(edge_roll(mesh, mesh.nodes, 0), 0.0);
  EXPECT_EQ(edge_roll(mesh, mesh.nodes, 1), 0.0) << "bevelled";
  Points x = mesh.nodes;
  const int lip = outer_of(mesh, mesh.edge_ring[0][0]);
  const double height = x(1, lip);
  x(1, lip) = 0.2e-3;  // pressed in from above
  EXPECT_GT(height, 0.4e-3);
  EXPECT_NEAR(edge_roll(mesh, x, 0), 0.35e-3 - 0.2e-3, 0.02e-3) << "a polygon of 20 sides";
}

}  // namespace vessel_edge_test
