#include "world/join_test.h"

#include <gtest/gtest.h>

#include <numeric>
#include <string_view>
#include <utility>
#include <vector>

#include "physics/vessel_leak.h"
#include "world/vessel_model.h"
#include "world/world.h"

namespace filum {
namespace join_test_test {

std::shared_ptr<const Model> stumps() {
  static const auto model = load_model(FILUM_SOURCE_DIR, "vessel-stitch");
  return model;
}

TEST(JoinTest, AnOpenCutLeaksAsAnOrificeAllRound) {
  const World w(stumps());
  const JoinTestReport r = join_test(*stumps(), w.state());
  EXPECT_TRUE(r.sound);
  EXPECT_NEAR(std::accumulate(r.flow.begin(), r.flow.end(), 0.0), r.leak, 1e-9 * r.leak);
  for (const double gap : r.gap) EXPECT_NEAR(gap, 0.6e-3, 0.1e-3) << "the clamp's gap; pressure shortens the stumps a little";
  BloodOptions blood;
  EXPECT_NEAR(r.leak, r.area * slit_speed(0.6e-3, stumps()->vessel->thickness, blood), 0.02 * r.leak);
  EXPECT_LT(r.narrowing, 0.2);
  EXPECT_LT(r.through, 0.0) << "what the artery gives runs out of the cut, and collaterals with it";
  EXPECT_FALSE(r.patent) << "an open lumen alone is not flow: nothing goes on beyond an unsewn cut";
  EXPECT_EQ(r.overlap, 0.0) << "plain edges";
  EXPECT_EQ(r.thread_inside, 0.0);
}

TEST(JoinTest, FlowOnwardsIsThatOfTheScenesCirculationAsTheTraineeSeesIt) {
  World w(stumps());
  const JoinTestReport r = join_test(*stumps(), w.state());
  const Circulation& c = stumps()->vessel->circulation;
  Inputs in;
  in.tools[0].valid = true;
  in.tools[0].X_WD = stumps()->instrument_start[0];
  in.tools[0].buttons = 24;  // both clamps
  for (int k = 0; k < 150; ++k) w.step(in);
  EXPECT_NEAR(r.through, w.observation().tissue.blood.through, 0.05 * c.back / c.downstream());
}

TEST(JoinTest, SameStateSameLeak) {
  World w(stumps());
  for (int k = 0; k < 5; ++k) w.step(Inputs{});
  const JoinTestReport a = join_test(*stumps(), w.state()), b = join_test(*stumps(), w.state());
  EXPECT_EQ(a.leak, b.leak);
  EXPECT_EQ(a.flow, b.flow);
}

/// What is measured is a rest: a thread that a live step would leave unbalanced is balanced here.
TEST(JoinTest, ALiveStepsLimitOfIterationsDoesNotCount) {
  auto hurried = std::make_shared<Model>(*stumps());
  hurried->step.max_iterations = 1;
  World w(hurried);
  State s = w.state();
  for (int i = 20; i < 30; ++i) s.thread.x(2, i) += 200e-6 * (i % 2);  // kinks
  w.restore(s);
  w.step(Inputs{});
  int troubles = 0;
  for (int e = 0; e < w.observation().n_events; ++e) troubles += std::string_view(w.observation().events[static_cast<std::size_t>(e)].name) == "solver-trouble";
  ASSERT_GT(troubles, 0) << "one iteration is not enough for the kinks";
  EXPECT_TRUE(join_test(*hurried, s).sound);
}

int first_within(const RodState& t, double y) {
  int i = 0;
  while (t.x(1, i) < y) ++i;
  return i;
}

TEST(JoinTest, ThreadLyingInTheLumenIsMeasured) {
  const World w(stumps());
  State s = w.state();
  double arc = 0.0;  // the thread's first end runs along the axis into the first stump, from far away
  for (int i = 0; i < s.thread.n; ++i) {
    s.thread.x.col(i) = Vec3(0.0, -1.5e-3 + arc, 0.0);
    if (i + 1 < s.thread.n) arc += s.thread.rest_length[i];
  }
  const double longest = s.thread.rest_length.head(s.thread.n - 1).maxCoeff();
  EXPECT_NEAR(thread_in_lumen(*stumps(), s), 1.2e-3 + 2.4e-3, 3.0 * longest) << "1.2 mm of the first stump, all 2.4 mm of the second";
  const double whole = thread_in_lumen(*stumps(), s);
  const int cut = first_within(s.thread, 0.5e-3);
  s.thread.alive[cut] = 0;
  EXPECT_NEAR(thread_in_lumen(*stumps(), s), whole - s.thread.rest_length[cut], 1e-12) << "between two ends there is no thread";
  for (int i = 0; i < s.thread.n; ++i) s.thread.x(2, i) = 0.6e-3;
  EXPECT_EQ(thread_in_lumen(*stumps(), s), 0.0) << "beside the vessel";
}

NeedleTrack bite(double arc, int part, double whole) {
  NeedleTrack t;
  t.n = t.out = 1;
  t.part = part;
  t.knots[0].strand = arc - whole;
  return t;
}

constexpr double kEdge = 0.05e-3;

/// 4.5 mm of thread along the axis from 1.5 mm before the cut: from 0 to 1.2 mm of it lie in the first stump, from 1.8 to 4.2 mm in the second. Beyond `reach` it stands aside.
State threaded(double reach, const std::vector<std::pair<double, int>>& bites) {
  const World w(stumps());
  State s = w.state();
  Points nodes(3, 91);
  for (int i = 0; i < 91; ++i) nodes.col(i) = Vec3(0.0, -1.5e-3 + kEdge * i, kEdge * i > reach ? 2e-3 : 0.0);
  s.thread = RodState::from_nodes(nodes, 91);
  s.thread.rest_length.head(90).setConstant(kEdge);
  for (const auto& [at, part] : bites) s.tissue.tracks.tracks[static_cast<std::size_t>(s.tissue.tracks.n++)] = bite(at, part, 90 * kEdge);
  return s;
}

/// From 0.5 mm before the first bite of each stitch to 0.5 mm behind its second nothing counts: -0.1 to 1.1 mm and 3.1 to 4.5 mm.
TEST(JoinTest, ThreadBetweenTwoStitchesOfOneThreadCounts) {
  const State s = threaded(1.0, {{0.4e-3, 0}, {0.6e-3, 1}, {3.6e-3, 0}, {4.0e-3, 1}});
  EXPECT_NEAR(thread_in_lumen(*stumps(), s), 0.1e-3 + 1.3e-3, 1e-9);
}

/// Nothing from 1.9 mm on counts.
TEST(JoinTest, ATailInTheLumenCounts) {
  const State s = threaded(3.0e-3, {{2.4e-3, 0}, {2.8e-3, 1}});
  EXPECT_NEAR(thread_in_lumen(*stumps(), s), 1.2e-3 + 0.1e-3, 1e-9);
}

/// Each pass in one stitch: one that was pulled out makes none, and across a cut there is none.
TEST(JoinTest, BitesThatMakeNoStitchLeaveOutTheirOwnOnly) {
  State s = threaded(1.0, {{0.4e-3, 0}, {3.6e-3, 1}});
  EXPECT_NEAR(thread_in_lumen(*stumps(), s), 0.1e-3, 1e-9) << "from 4.1 mm on";
  s.tissue.tracks.tracks[1].ended = 1;
  EXPECT_NEAR(thread_in_lumen(*stumps(), s), 0.3e-3 + 2.4e-3, 1e-9) << "all but the first bite's";
  s.tissue.tracks.tracks[1].ended = 0;
  s.thread.alive[30] = 0;  // between the cut edges
  EXPECT_NEAR(thread_in_lumen(*stumps(), s), 0.3e-3 + 1.3e-3 + 0.1e-3, 1e-9) << "two bites of two pieces";
}

TEST(JoinTest, EdgesThatReachPastEachOtherAreMeasured) {
  const VesselModel& vessel = *stumps()->vessel;
  Points x = vessel.mesh.nodes;
  EXPECT_EQ(edge_overlap(vessel, x), 0.0) << "0.6 mm apart";
  const int lip = vessel.mesh.edge_ring[0][5];
  x(1, lip) += 0.8e-3;
  EXPECT_NEAR(edge_overlap(vessel, x), 0.2e-3, 1e-9);
}

}  // namespace join_test_test
}  // namespace filum
