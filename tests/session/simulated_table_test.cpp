// A row for each step: replay_test.

#include <gtest/gtest.h>

#include <algorithm>

#include "session/export.h"
#include "tests/session/synthetic.h"
#include "world/world.h"

namespace filum {
namespace simulated_table_test {

constexpr std::size_t kSteps = 12;

World fresh_world() { return World(load_model(FILUM_SOURCE_DIR, "knot-square")); }

/// The columns of a recording's table against what the same world showed as it was recorded.
TEST(SimulatedTable, TellsWhatTheWorldShowed) {
  const synthetic::Folder folder;
  World world = fresh_world();
  std::vector<Observation> seen;
  {
    RecorderOptions options = synthetic::options(folder.file("a"));
    options.meta.n_tools = world.description().n_tools;
    options.meta.dt = world.description().dt;
    Recorder recorder(options);
    for (std::size_t k = 0; k < kSteps; ++k) {
      StepRecord record;
      for (std::size_t i = 0; i < static_cast<std::size_t>(world.description().n_tools); ++i) {
        ToolInput& tool = record.inputs.tools[i];
        tool.X_WD = world.observation().tools[i].X_WT;
        tool.X_WD.p += Vec3(1e-5, 2e-5 * (1.0 + static_cast<double>(i)), -1e-5);
        tool.grip_angle = 0.2 + 0.01 * static_cast<double>(k);
        tool.valid = true;
      }
      world.step(record.inputs);
      record.step = world.observation().step;
      record.state_hash = world.observation().state_hash;
      ASSERT_TRUE(recorder.record_step(record));
      seen.push_back(world.observation());
    }
    ASSERT_TRUE(recorder.close());
  }
  World again = fresh_world();
  const Table table = simulated_table(RecordingReader(folder.file("a")), again);
  const auto column = [&](const std::string& name) -> const std::vector<double>& {
    const auto found = std::find_if(table.columns.begin(), table.columns.end(), [&](const Column& c) { return c.name == name; });
    if (found == table.columns.end()) throw std::runtime_error(name);
    return std::get<std::vector<double>>(found->values);
  };
  ASSERT_EQ(column("time").size(), kSteps);
  for (std::size_t k = 0; k < kSteps; ++k) {
    const Observation& o = seen[k];
    EXPECT_EQ(std::get<std::vector<std::int64_t>>(table.columns[0].values)[k], static_cast<std::int64_t>(o.step));
    EXPECT_EQ(column("time")[k], o.time);
    for (const std::size_t i : {0, 1}) {
      const ToolObservation& tool = o.tools[i];
      const std::string name = "tool" + std::to_string(i);
      for (int axis = 0; axis < 3; ++axis) {
        const std::string suffix = std::string("_") + "xyz"[axis];
        EXPECT_EQ(column(name + "_p" + suffix)[k], tool.X_WT.p[axis]);
        EXPECT_EQ(column(name + "_v" + suffix)[k], tool.v_W[axis]);
        EXPECT_EQ(column(name + "_f" + suffix)[k], tool.f_T_W[axis]);
      }
      EXPECT_EQ(column(name + "_q_w")[k], tool.X_WT.q.w());
      EXPECT_EQ(column(name + "_q_z")[k], tool.X_WT.q.z());
      EXPECT_EQ(column(name + "_grip_angle")[k], tool.grip_angle);
    }
    EXPECT_EQ(column("thread_tension_max")[k], std::max(0.0, *std::max_element(o.tension.begin(), o.tension.begin() + o.n_nodes - 1))) << "of the edges in use";
    EXPECT_EQ(column("min_gap")[k], o.min_gap);
  }
  EXPECT_NE(column("tool0_p_y").front(), column("tool0_p_y").back()) << "something moved";
}

}  // namespace simulated_table_test
}  // namespace filum
