#include "physics/rod_travel.h"

#include <gtest/gtest.h>

namespace filum {
namespace rod_travel_test {

Eigen::Matrix4Xd one_node_goes(int n, int node, double by) {
  Eigen::Matrix4Xd move = Eigen::Matrix4Xd::Zero(4, n);
  move(1, node) = by;
  move.row(3).setConstant(1.0);  // twist is not travel
  return move;
}

TEST(RodTravel, AnEdgeGoesAsFarAsItsFasterEnd) {
  RodTravel t(5);
  t.start(5);
  t.look_along(one_node_goes(5, 2, -3e-6));
  EXPECT_EQ(t.stride(0), 0.0);
  EXPECT_EQ(t.stride(1), 3e-6);
  EXPECT_EQ(t.stride(2), 3e-6);
  EXPECT_EQ(t.stride(3), 0.0);
  EXPECT_EQ(t.farthest(), 3e-6);
  t.went(0.5);
  EXPECT_EQ(t.gone(2), 1.5e-6);
  EXPECT_EQ(t.gone(3), 0.0);
}

TEST(RodTravel, WhatTheReachLeavesOfAMoveIsTheLeastOfTheEdges) {
  RodTravel t(4);
  t.reach << 10e-6, 2e-6, 10e-6, 0.0;
  t.start(4);
  t.look_along(one_node_goes(4, 0, 8e-6));
  EXPECT_EQ(t.within_reach(), 1.0) << "edge 1 does not move";
  t.look_along(one_node_goes(4, 2, 8e-6));
  EXPECT_DOUBLE_EQ(t.within_reach(), 0.25);
  t.went(0.125);
  EXPECT_DOUBLE_EQ(t.within_reach(), 0.125);
  t.went(0.2);  // beyond
  EXPECT_EQ(t.within_reach(), 0.0);
  t.start(4);
  EXPECT_DOUBLE_EQ(t.within_reach(), 0.25) << "found anew";
}

}  // namespace rod_travel_test
}  // namespace filum
