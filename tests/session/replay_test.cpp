#include "session/replay.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "base/error.h"
#include "session/export.h"
#include "session/recorder.h"
#include "tests/session/synthetic.h"
#include "world/world.h"

namespace filum {
namespace replay_test {

constexpr std::uint64_t kSteps = 200;
constexpr std::uint64_t kHashEvery = 20;

World fresh_world() {
  return World(load_model(FILUM_SOURCE_DIR, "knot-square"));
}

/// Both tools drift and open and close: enough to touch every part of the state.
Inputs moving_inputs(const World& world, std::uint64_t step) {
  Inputs inputs;
  const double t = static_cast<double>(step) * world.description().dt;
  for (int i = 0; i < world.description().n_tools; ++i) {
    const std::size_t at = static_cast<std::size_t>(i);
    ToolInput& tool = inputs.tools[at];
    tool.X_WD = world.observation().tools[at].X_WT;
    tool.X_WD.p += Vec3(1e-5 * std::sin(9.0 * t), 2e-5 * std::cos(7.0 * t + i), 1e-5);
    tool.grip_angle = 0.2 + 0.1 * std::sin(5.0 * t);
    tool.valid = true;
  }
  return inputs;
}

/// What may be changed before a record is stored, to plant a difference.
using Change = std::function<void(StepRecord&, std::vector<std::pair<std::string, std::uint64_t>>&)>;

void record_session(const std::string& file, const Change& change = {}, std::uint64_t steps = kSteps) {
  World world = fresh_world();
  RecorderOptions options = synthetic::options(file);
  options.meta.n_tools = world.description().n_tools;
  options.meta.dt = world.description().dt;
  Recorder recorder(options);
  for (std::uint64_t i = 1; i <= steps; ++i) {
    StepRecord record;
    record.inputs = moving_inputs(world, i);
    world.step(record.inputs);
    record.step = world.observation().step;
    record.state_hash = world.observation().state_hash;
    std::vector<std::pair<std::string, std::uint64_t>> hashes;
    if (record.step % kHashEvery == 0) hashes = world.array_hashes();
    if (change) change(record, hashes);
    ASSERT_TRUE(recorder.record_step(record));
    for (const auto& [name, hash] : hashes)
      ASSERT_TRUE(recorder.record_array_hash({record.step, std::string_view(name), hash}));
  }
  ASSERT_TRUE(recorder.close());
}

ReplayResult replay_file(const std::string& file, bool to_the_end = false) {
  World world = fresh_world();
  return replay(RecordingReader(file), world, {}, to_the_end);
}

TEST(Replay, IsBitEqualOnTheSameBuild) {
  const synthetic::Folder folder;
  record_session(folder.file("a"));
  const ReplayResult result = replay_file(folder.file("a"));
  EXPECT_TRUE(result.identical);
  EXPECT_EQ(result.steps, kSteps);
  EXPECT_FALSE(result.first_difference.has_value());
}

TEST(Replay, AnotherInputIsNoticedAndTheFirstArrayNamed) {
  const synthetic::Folder folder;
  record_session(folder.file("a"), [](StepRecord& record, auto&) {
    if (record.step == 50) record.inputs.tools[0].X_WD.p.x() += 1e-4;
  });
  const ReplayResult result = replay_file(folder.file("a"));
  EXPECT_FALSE(result.identical);
  ASSERT_TRUE(result.first_difference.has_value());
  EXPECT_EQ(result.first_difference->step, 50u);
  EXPECT_NE(result.first_difference->array, "state");
}

TEST(Replay, NamesExactlyTheArrayThatDiffers) {
  const synthetic::Folder folder;
  std::vector<std::string> names;
  for (const auto& [name, hash] : fresh_world().array_hashes()) names.push_back(name);
  ASSERT_GE(names.size(), 2u);
  for (const std::string& planted : names) {
    const std::string file = folder.file("differs in " + planted);
    const auto plant = [&](StepRecord& record, auto& hashes) {
      if (record.step != 40) return;
      record.state_hash ^= 1;
      for (auto& [name, hash] : hashes)
        if (name == planted) hash ^= 1;
    };
    record_session(file, plant, 40);
    const ReplayResult result = replay_file(file);
    ASSERT_TRUE(result.first_difference.has_value()) << planted;
    EXPECT_EQ(result.first_difference->step, 40u);
    EXPECT_EQ(result.first_difference->array, planted);
    EXPECT_EQ(result.steps, 40u);
  }
}

TEST(Replay, GoesToTheEndWhenAsked) {
  const synthetic::Folder folder;
  record_session(folder.file("a"),
                 [](StepRecord& record, auto&) { record.state_hash ^= record.step == 10 ? 1 : 0; });
  World world = fresh_world();
  std::uint64_t seen = 0;
  replay(
      RecordingReader(folder.file("a")), world, [&](const StepRecord&, const Observation&) { ++seen; }, true);
  EXPECT_EQ(seen, kSteps);
}

TEST(Replay, AGapInTheStepsIsAnInputError) {
  const synthetic::Folder folder;
  record_session(folder.file("a"), [](StepRecord& record, auto&) {
    if (record.step > 100) ++record.step;
  });
  EXPECT_THROW(replay_file(folder.file("a")), InputError);
}

TEST(Replay, StopsAtADamagedBlockOfStepsAndSaysSo) {
  const synthetic::Folder folder;
  record_session(folder.file("a"), {}, 600);
  std::string bytes;
  {
    std::ifstream in(folder.file("a"), std::ios::binary);
    bytes.assign(std::istreambuf_iterator<char>(in), {});
  }
  StepRecord last;
  for (auto steps = RecordingReader(folder.file("a")).steps(); steps.next(last);) {}
  const std::size_t at = bytes.find(std::string(reinterpret_cast<const char*>(&last.state_hash), sizeof last.state_hash));
  ASSERT_NE(at, std::string::npos);
  bytes[at] = static_cast<char>(bytes[at] ^ 1);
  std::ofstream(folder.file("b"), std::ios::binary) << bytes;
  const ReplayResult result = replay_file(folder.file("b"));
  EXPECT_FALSE(result.identical);
  EXPECT_FALSE(result.first_difference.has_value());
  EXPECT_GT(result.steps, 0u);
  EXPECT_LT(result.steps, 600u);
  EXPECT_EQ(result.damage.find("steps block "), 0u) << result.damage;
}

TEST(Replay, SimulatedTableHasARowForEveryStep) {
  const synthetic::Folder folder;
  record_session(folder.file("a"));
  World world = fresh_world();
  const Table table = simulated_table(RecordingReader(folder.file("a")), world);
  EXPECT_EQ(table.name, "simulated");
  EXPECT_NEAR(table.rate * world.description().dt, 1.0, 1e-12);
  for (const Column& column : table.columns)
    EXPECT_EQ(std::visit([](const auto& values) { return values.size(); }, column.values), kSteps)
        << column.name;
  EXPECT_NE(table.columns.back().unit, "");
}

}  // namespace replay_test
}  // namespace filum
