#include "world/join_test.h"

#include <gtest/gtest.h>

#include <numeric>

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
  EXPECT_TRUE(r.patent);
  EXPECT_EQ(r.thread_inside, 0.0);
}

TEST(JoinTest, SameStateSameLeak) {
  World w(stumps());
  for (int k = 0; k < 5; ++k) w.step(Inputs{});
  const JoinTestReport a = join_test(*stumps(), w.state()), b = join_test(*stumps(), w.state());
  EXPECT_EQ(a.leak, b.leak);
  EXPECT_EQ(a.flow, b.flow);
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
