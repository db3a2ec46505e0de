#include "world/observe.h"

#include <gtest/gtest.h>

#include "world/scene_file.h"
#include "world/world.h"

namespace filum {
namespace observe_test {

struct Seen {
  std::shared_ptr<const Model> model = load_model(FILUM_SOURCE_DIR, "knot-square", "");
  World world{model};
  State s = world.state();
  RodStepSummary solver;
  Observation o;

  Seen() { size_observation(*model, o); }
  void look() { fill_observation(*model, s, solver, o); }
};

TEST(Observe, ThreadAsItIs) {
  Seen v;
  v.s.step = 250;
  v.s.thread.arc_start = 1e-3;
  v.s.thread.x.col(3) += Vec3(0, 1e-4, 0);
  v.look();
  const RodState& t = v.s.thread;
  EXPECT_EQ(v.o.step, 250u);
  EXPECT_DOUBLE_EQ(v.o.time, 250 * v.model->step.dt);
  ASSERT_EQ(v.o.n_nodes, t.n);
  EXPECT_EQ(v.o.positions.leftCols(t.n), t.x.leftCols(t.n));
  EXPECT_EQ(v.o.radius, v.model->thread.radius);
  double arc = 1e-3;
  for (int i = 0; i + 1 < t.n; arc += t.rest_length[i++]) {
    EXPECT_NEAR(v.o.arc[static_cast<std::size_t>(i)], arc, 1e-12);
    EXPECT_EQ(v.o.tension[static_cast<std::size_t>(i)], edge_tension(v.model->thread, t, i));
  }
  EXPECT_GT(v.o.tension[3], 0.0);
}

TEST(Observe, CutsBreaksAndContacts) {
  Seen v;
  v.look();
  EXPECT_FALSE(v.o.broken);
  EXPECT_EQ(v.o.break_edge, -1);
  EXPECT_EQ(v.o.cut_edge_low, -1);
  const auto arc_of = [&](int edge) { return v.s.thread.rest_length.head(edge).sum() + 0.5 * v.s.thread.rest_length[edge]; };
  v.s.break_arc = arc_of(4);
  v.s.cut_low = arc_of(2);
  v.s.cut_high = arc_of(9);
  for (const int edge : {2, 4, 9}) v.s.thread.alive[edge] = 0;
  v.s.memory.self.push_back({2, 7, Vec3::Zero(), 0.03});
  v.s.memory.self.push_back({2, 8, Vec3::Zero(), 0.01});
  v.look();
  EXPECT_TRUE(v.o.broken);
  EXPECT_EQ(v.o.break_edge, 4);
  EXPECT_EQ(v.o.cut_edge_low, 2);
  EXPECT_EQ(v.o.cut_edge_high, 9);
  ASSERT_EQ(v.o.n_parted, 3);
  EXPECT_EQ(v.o.parted[0], 2);
  EXPECT_EQ(v.o.parted[1], 4);
  EXPECT_EQ(v.o.parted[2], 9);
  EXPECT_EQ(v.o.n_contacts, 2);
  EXPECT_DOUBLE_EQ(v.o.contact[2], 0.04);
  EXPECT_DOUBLE_EQ(v.o.contact[7], 0.03);
  EXPECT_DOUBLE_EQ(v.o.contact[3], 0.0);
}

TEST(Observe, ToolsAsSimulatedAndAsCommanded) {
  Seen v;
  ASSERT_GE(v.s.instruments.size(), 2u);
  InstrumentState& in = v.s.instruments[1];
  in.X_WT.p = Vec3(1, 2, 3);
  in.X_WD.p = Vec3(4, 5, 6);
  in.grip_force = 0.5;
  v.s.force[1] = Vec3(0, 3, 4);
  v.s.thread_pull[1] = 2.0;
  v.s.valid[1] = 1;
  v.s.memory.grasps.push_back({1, v.s.thread.rest_length.head(5).sum() + 1e-6, Vec3::Zero()});
  v.look();
  const ToolObservation& tool = v.o.tools[1];
  EXPECT_EQ(v.o.n_tools, static_cast<int>(v.s.instruments.size()));
  EXPECT_EQ(tool.X_WT.p, Vec3(1, 2, 3));
  EXPECT_EQ(tool.X_WD.p, Vec3(4, 5, 6));
  EXPECT_EQ(tool.grip_force, 0.5);
  EXPECT_EQ(tool.f_T_W, Vec3(0, 3, 4));
  EXPECT_DOUBLE_EQ(tool.thread_force, 2.0);
  EXPECT_TRUE(tool.input_valid);
  EXPECT_EQ(tool.grasped_edge, 5);
  EXPECT_EQ(v.o.tools[0].grasped_edge, -1);
}

}  // namespace observe_test
}  // namespace filum
